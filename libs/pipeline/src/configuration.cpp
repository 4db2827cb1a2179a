#include <submap_slam/pipeline/configuration.h>

#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/core/ini_file.h>
#include <submap_slam/core/plugins.h>
#include <submap_slam/core/version.h>
#include <submap_slam/pipeline/installation.h>
#include <submap_slam/rawlog/resume_state.h>

#include <algorithm>
#include <iterator>
#include <sstream>

#include <submap_slam/pipeline/submap_budget.h>

namespace submap_slam {
namespace {

/** The words of a list separated by commas or blanks. */
std::vector<std::string> splitList(std::string text) {
  std::replace(text.begin(), text.end(), ',', ' ');
  std::istringstream words(text);
  return {std::istream_iterator<std::string>(words), {}};
}

/** The parameters that the submaps depend on. */
void describeSubmapParameters(ParameterTable& table, Configuration& config) {
  describe(table, config.reader);
  table.section("mapping", "Which submaps are built from a log");
  table.add(
      "maps", config.maps,
      "Occupancy grids, landmarks, or both in the same submaps; auto: grids where the log has laser scans, "
      "else landmarks",
      {"auto", "grid", "landmarks", "grid, landmarks"});
  describe(table, config.stretches);
  describe(table, config.mapper);
  describe(table, config.detector);
  describe(table, config.landmark_mapper);
  table.section("run", "The run as a whole");
  table.add("seed", config.seed, "Seed of all random streams; equal seeds give equal results");
}

void describeJoiningParameters(ParameterTable& table, Configuration& config) {
  table.section("joining", "How submaps become one map");
  table.add("chain", config.joining.chain,
            "Names of the joiners that run one after the other, separated by commas; empty: only the chain "
            "of end poses");
  table.add(
      "incremental", config.joining.incremental,
      "map joins while submaps are being built, so that there is a map at every moment; the final result "
      "is the same");
  table.add(
      "update_growth", config.joining.update_growth, "", {1, 1e6},
      "Then the next map is made when there are about so many times the submaps of the last one; 1: after "
      "every submap");
  table.add(
      "map", config.joining.map,
      "Where a joiner leaves the making of the global map to the program: from the scans that the "
      "submaps keep (where they keep none, or were made with other beams, as the other), or by fusing the "
      "submaps' evidence",
      {"scans", "submaps"});
  table.add(
      "map_resolution", config.joining.map_resolution, "m", {0, 10},
      "Cell size of the global map where a joiner leaves its making to the program; 0: that of the submaps, "
      "doubled until the map has at most 20 million cells");
  table.add("landmark_joiner", config.joining.landmark_joiner, "Name of the joiner of landmark submaps");
  table.add("memory", config.joining.memory, "MB", {kLeastMemory_MB, 1e9},
            "About how much memory the program may take while it joins. What is left beside the map and the "
            "joiners' own data keeps submaps; those that do not fit wait in a temporary file in OUT, "
            "uncompressed, until they are needed; the result is the same");
  describe(table, config.node_refinement);
  table.section("output", "What a run writes beside its map");
  table.add("report", config.output.report,
            "Write report.html, a page with the map and all that is known about how it was made");
  table.section("plugins", "Shared libraries with joiners");
  table.add("load", config.plugins, "Plugin files to load besides the installed ones, separated by commas");
  for (const auto& joiner : config.joiners) joiner->describe(table);
}

/** The plugins of a run must be loaded before the parameters can be read, as they bring parameters
 * themselves. */
std::vector<std::string> pluginFiles(const std::string& ini_file, const ConfigurationOptions& options) {
  std::string list;
  if (!ini_file.empty())
    for (const auto& entry : readIni(ini_file))
      if (entry.section == "plugins" && entry.key == "load") list = entry.value;
  const std::string key = "plugins.load=";
  for (const auto& setting : options.settings)
    if (setting.compare(0, key.size(), key) == 0) list = setting.substr(key.size());
  std::vector<std::string> files = splitList(list);
  files.insert(files.end(), options.plugins.begin(), options.plugins.end());
  return files;
}

/** The joiner of a form of submaps by its name, checked. `key` is the one of [joining] that names it. */
template <class Form>
std::shared_ptr<Form> joinerNamed(const std::vector<std::shared_ptr<Joiner>>& joiners, const char* key,
                                  const std::string& name) {
  std::vector<std::string> names;
  for (const auto& joiner : joiners) {
    auto of_form = std::dynamic_pointer_cast<Form>(joiner);
    if (!of_form) continue;
    names.push_back(joiner->name());
    if (joiner->name() != name) continue;
    joiner->validate();
    return of_form;
  }
  throw PluginError(fmt::format("[joining] {}: no plugin offers the joiner '{}'; available: {}", key, name,
                                names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
}

}  // namespace

Configuration::Configuration(const std::vector<std::string>& plugin_files) {
  for (const auto& folder : pluginFolders()) loadPluginFolder(folder);
  for (const auto& file : plugin_files) loadPlugin(file);
  plugins = fmt::format("{}", fmt::join(plugin_files, ","));
  joiners = availableJoiners();
  describeSubmapParameters(table, *this);
  submap_parameters_ = table.parameters().size();
  describeJoiningParameters(table, *this);
}

JoinerChain Configuration::joinerChain() const {
  JoinerChain chain;
  for (const auto& name : splitList(joining.chain))
    chain.push_back(joinerNamed<SubmapJoiner>(joiners, "chain", name));
  return chain;
}

std::shared_ptr<LandmarkJoiner> Configuration::landmarkJoiner() const {
  return joinerNamed<LandmarkJoiner>(joiners, "landmark_joiner", joining.landmark_joiner);
}

std::string Configuration::submapFingerprint() const {
  std::string text = version();
  for (std::size_t i = 0; i < submap_parameters_; ++i) {
    const Parameter& p = table.parameters()[i];
    text += fmt::format("\n{}.{}={}", p.section, p.key, p.value());
  }
  return textHash(text);
}

std::unique_ptr<Configuration> loadConfiguration(const ConfigurationOptions& options) {
  const std::string ini_file =
      options.config_file.empty() ? defaultIniFile().value_or("") : options.config_file;
  const auto plugin_files = pluginFiles(ini_file, options);
  auto config = std::make_unique<Configuration>(plugin_files);

  if (!ini_file.empty()) config->table.loadIni(ini_file);
  for (const auto& setting : options.settings) config->table.set(setting);
  config->plugins = fmt::format("{}", fmt::join(plugin_files, ","));

  if (options.seed) config->seed = *options.seed;
  if (!options.from.empty()) config->table.set("reader", "from", options.from);
  if (!options.to.empty()) config->table.set("reader", "to", options.to);
  if (!options.sensor_labels.empty()) config->table.set("reader", "sensor_labels", options.sensor_labels);
  return config;
}

}  // namespace submap_slam
