#include "experiment.h"

#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/core/ini_file.h>
#include <submap_slam/core/parameters.h>
#include <submap_slam/pipeline/configuration.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "common_options.h"
#include "simulation_files.h"

namespace submap_slam {
namespace fs = std::filesystem;
namespace {

const std::string kDataPrefix = "data ", kSettingPrefix = "setting ", kSimulationPrefix = "simulation.",
                  kPlotPrefix = "plot ";

/** Section [experiment]: lists of words. */
struct Lists {
  std::string title, data, settings, seeds = "1", columns;
  bool worst = false;
};

void describe(ParameterTable& table, Lists& lists) {
  table.section("experiment", "A table: data × settings, each figure as mean over the seeds");
  table.add("title", lists.title, "Heading of the table");
  table.add("data", lists.data, "Names of the sections [data NAME] to use, separated by commas");
  table.add("settings", lists.settings, "Names of the sections [setting NAME] to use");
  table.add("seeds", lists.seeds, "Seeds of simulation and mapping; one cell for each");
  table.add("columns", lists.columns, "Figures to tabulate");
  table.add("worst", lists.worst, "Show the greatest value over the seeds too");
}

std::vector<std::string> wordsOf(std::string text) {
  std::replace(text.begin(), text.end(), ',', ' ');
  std::istringstream words(text);
  return {std::istream_iterator<std::string>(words), {}};
}

std::vector<std::string> listOf(const char* key, const std::string& text) {
  auto words = wordsOf(text);
  if (words.empty()) throw ConfigError(fmt::format("[experiment] {}: is empty", key));
  return words;
}

bool startsWith(const std::string& text, const std::string& prefix) {
  return text.compare(0, prefix.size(), prefix) == 0;
}

/** A ConfigError that says in which line already. */
struct LineError : ConfigError {
  using ConfigError::ConfigError;
};

/** The lines of an experiment file. */
class ExperimentFile {
 public:
  explicit ExperimentFile(const std::string& name) : name_(name), entries_(readIni(name)) {}

  const std::vector<IniEntry>& entries() const { return entries_; }

  /** The lines with a key in a section. */
  std::vector<IniEntry> keysOf(const std::string& section) const {
    std::vector<IniEntry> keys;
    std::copy_if(entries_.begin(), entries_.end(), std::back_inserter(keys),
                 [&](const IniEntry& e) { return e.section == section && !e.key.empty(); });
    return keys;
  }

  /** The heading of a section that a list of [experiment] names; throws ConfigError if there is none. */
  const IniEntry& headingOf(const std::string& section, const std::string& list) const {
    const auto heading = std::find_if(entries_.begin(), entries_.end(),
                                      [&](const IniEntry& e) { return e.section == section; });
    if (heading == entries_.end())
      throw ConfigError(fmt::format("[experiment] {}: there is no section [{}]", list, section));
    return *heading;
  }

  /** Calls `read`, whose ConfigErrors get file and line of the entry. */
  template <class Read>
  void at(const IniEntry& entry, Read read) const {
    try {
      read();
    } catch (const ConfigError& e) {
      throw LineError(fmt::format("{}:{}: {}", name_, entry.line, e.what()));
    }
  }

 private:
  std::string name_;
  std::vector<IniEntry> entries_;
};

/** A line of [setting NAME], or of the simulation in [data NAME], as "section.key=value". */
std::string assignmentOf(const IniEntry& entry) { return fmt::format("{}={}", entry.key, entry.value); }

/** Names become folders. */
void requireName(const std::string& name) {
  const auto allowed = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; };
  if (!std::all_of(name.begin(), name.end(), allowed))
    throw ConfigError(fmt::format("[experiment]: '{}' must consist of letters, digits, - and _", name));
}

std::string existingFile(const std::string& name, const fs::path& folder) {
  const fs::path file = folder / name;
  if (!fs::is_regular_file(file)) throw InputError(fmt::format("{}: no such file", file.string()));
  return file.string();
}

double numberOf(const IniEntry& entry) {
  double value = 0;
  const char* const end = entry.value.data() + entry.value.size();
  const auto [rest, error] = std::from_chars(entry.value.data(), end, value);
  if (error != std::errc() || rest != end || !std::isfinite(value))
    throw ConfigError(fmt::format("[{}] {} = {}: is no number", entry.section, entry.key, entry.value));
  return value;
}

/** A parameter of the pipeline in [data NAME]. */
bool isFact(const IniEntry& entry) {
  return entry.key.find('.') != std::string::npos && !startsWith(entry.key, kSimulationPrefix);
}

void setData(ExperimentData& data, const IniEntry& entry, const fs::path& folder) {
  const std::string& key = entry.key;
  if (key == "world") {
    data.world = entry.value;
  } else if (key == "log") {
    data.log = existingFile(entry.value, folder);
  } else if (key == "truth") {
    data.truth = existingFile(entry.value, folder);
  } else if (key == "relations") {
    data.relations = existingFile(entry.value, folder);
  } else if (key == "landmarks") {
    data.landmarks = existingFile(entry.value, folder);
  } else if (key == "gps") {
    data.gps = existingFile(entry.value, folder);
  } else if (key == "antenna_x" || key == "antenna_y") {
    (key.back() == 'x' ? data.antenna.x : data.antenna.y) = numberOf(entry);
  } else if (startsWith(key, kSimulationPrefix)) {
    data.simulation.push_back(assignmentOf(entry));
  } else if (isFact(entry)) {
    data.settings.push_back(assignmentOf(entry));
  } else {
    throw ConfigError(
        fmt::format("unknown key [{}] {}; expected world, simulation.KEY, log, truth, relations, landmarks, "
                    "gps, antenna_x, antenna_y or SECTION.KEY",
                    entry.section, key));
  }
}

/** Throws ConfigError for an unknown world and for settings that the simulation would refuse. */
void checkSimulation(const ExperimentFile& file, const std::vector<IniEntry>& keys,
                     const std::string& world) {
  for (const auto& entry : keys)
    if (entry.key == "world") file.at(entry, [&] { loadScenario(world, "", {}); });
  for (const auto& entry : keys)
    if (startsWith(entry.key, kSimulationPrefix))
      file.at(entry, [&] { loadScenario(world, "", {assignmentOf(entry)}); });
}

/** Keys of [setting NAME] that are no parameters of the pipeline. */
bool isOwnKey(const std::string& key) { return key == "baseline" || key == "vary" || key == "varied"; }

/** Throws ConfigError or PluginError for what the pipeline would refuse. */
void checkSettings(const ExperimentFile& file, const IniEntry& heading, const std::vector<IniEntry>& keys) {
  ConfigurationOptions options;  // plugins first: they bring parameters themselves
  for (const auto& entry : keys)
    if (entry.key == "plugins.load") options.settings.push_back(assignmentOf(entry));
  const auto config = loadConfiguration(options);
  for (const auto& entry : keys)
    if (!isOwnKey(entry.key)) file.at(entry, [&] { config->table.set(assignmentOf(entry)); });
  file.at(heading, [&] { config->joinerChain(); });
}

ExperimentData readData(const ExperimentFile& file, const std::string& name, const fs::path& folder) {
  requireName(name);
  const std::string section = kDataPrefix + name;
  const IniEntry& heading = file.headingOf(section, "data");
  ExperimentData data;
  data.name = name;
  const auto keys = file.keysOf(section);
  for (const auto& entry : keys) file.at(entry, [&] { setData(data, entry, folder); });
  file.at(heading, [&] {
    if (data.world.empty() == data.log.empty())
      throw ConfigError(fmt::format("[{}]: needs either a world or a log", section));
  });
  if (!data.world.empty()) checkSimulation(file, keys, data.world);
  std::vector<IniEntry> facts;
  std::copy_if(keys.begin(), keys.end(), std::back_inserter(facts), isFact);
  checkSettings(file, heading, facts);
  return data;
}

double parseShare(const IniEntry& entry) {
  double share = 0;
  ParameterTable table;
  table.section(entry.section, "");
  table.add(entry.key, share, "", {0, 1}, "");
  table.set(entry.section, entry.key, entry.value);
  return share;
}

void setSetting(ExperimentSetting& setting, const IniEntry& entry) {
  if (entry.key == "vary") {
    setting.variation.share = parseShare(entry);
  } else if (entry.key == "varied") {
    setting.variation.keys = wordsOf(entry.value);
  } else if (entry.key != "baseline") {
    setting.settings.push_back(assignmentOf(entry));
  } else {
    setting.baseline = entry.value;
    if (!setting.baseline.empty() && setting.baseline != "odometry" && setting.baseline != "truth")
      throw ConfigError(
          fmt::format("[{}] baseline = '{}': expected odometry or truth", entry.section, setting.baseline));
  }
}

/** Throws ConfigError for a variation of keys that cannot be varied. */
void checkVariation(const ExperimentFile& file, const IniEntry& heading, const std::vector<IniEntry>& keys,
                    const ExperimentSetting& setting) {
  ConfigurationOptions options;
  for (const auto& entry : keys)
    if (!isOwnKey(entry.key)) options.settings.push_back(assignmentOf(entry));
  const auto config = loadConfiguration(options);
  file.at(heading, [&] { vary(config->table, setting.variation, 0); });
}

ExperimentSetting readSetting(const ExperimentFile& file, const std::string& name) {
  requireName(name);
  const std::string section = kSettingPrefix + name;
  const IniEntry& heading = file.headingOf(section, "settings");
  ExperimentSetting setting;
  setting.name = name;
  const auto keys = file.keysOf(section);
  for (const auto& entry : keys) file.at(entry, [&] { setSetting(setting, entry); });
  checkSettings(file, heading, keys);
  checkVariation(file, heading, keys, setting);
  return setting;
}

ExperimentColumn readColumn(const std::string& key, const std::string& where) {
  std::vector<std::string> known;
  for (const auto& column : experimentColumns()) {
    if (column.key == key) return column;
    known.push_back(column.key);
  }
  throw ConfigError(
      fmt::format("{}: unknown column '{}'; expected some of {}", where, key, fmt::join(known, ", ")));
}

void requireChoice(const IniEntry& entry, const std::vector<std::string>& choices) {
  if (std::find(choices.begin(), choices.end(), entry.value) == choices.end())
    throw ConfigError(fmt::format("[{}] {} = '{}': expected {}", entry.section, entry.key, entry.value,
                                  fmt::join(choices, " or ")));
}

void setPlot(ExperimentPlot& plot, const IniEntry& entry) {
  if (entry.key == "title") {
    plot.title = entry.value;
  } else if (entry.key == "x") {
    requireChoice(entry, {"setting", "data", "seed"});
    plot.x = entry.value;
  } else if (entry.key == "y") {
    plot.y = readColumn(entry.value, fmt::format("[{}] y", entry.section));
  } else if (entry.key == "kind") {
    requireChoice(entry, {"bars", "lines"});
    plot.kind = entry.value;
  } else {
    throw ConfigError(
        fmt::format("unknown key [{}] {}; expected title, x, y or kind", entry.section, entry.key));
  }
}

ExperimentPlot readPlot(const ExperimentFile& file, const IniEntry& heading) {
  ExperimentPlot plot;
  plot.name = heading.section.substr(kPlotPrefix.size());
  for (const auto& entry : file.keysOf(heading.section)) file.at(entry, [&] { setPlot(plot, entry); });
  file.at(heading, [&] {
    if (plot.y.key.empty()) throw ConfigError(fmt::format("[{}]: needs y", heading.section));
  });
  if (plot.title.empty()) plot.title = plot.y.label;
  return plot;
}

std::vector<ExperimentPlot> readPlots(const ExperimentFile& file,
                                      const std::vector<ExperimentColumn>& columns) {
  std::vector<ExperimentPlot> plots;
  for (const auto& entry : file.entries())
    if (entry.key.empty() && startsWith(entry.section, kPlotPrefix)) plots.push_back(readPlot(file, entry));
  if (!plots.empty()) return plots;
  for (const auto& column : columns) {
    ExperimentPlot plot;
    plot.name = column.key;
    plot.title = column.label;
    plot.y = column;
    plots.push_back(plot);
  }
  return plots;
}

Lists readLists(const ExperimentFile& file, const std::vector<std::string>& overrides) {
  Lists lists;
  ParameterTable table;
  describe(table, lists);
  for (const auto& entry : file.keysOf("experiment"))
    file.at(entry, [&] { table.set("experiment", entry.key, entry.value); });
  for (const auto& setting : overrides) table.set(setting);
  return lists;
}

void refuseUnknownSection(const IniEntry& entry) {
  const std::string& section = entry.section;
  if (section != "experiment" && !startsWith(section, kDataPrefix) && !startsWith(section, kSettingPrefix) &&
      !startsWith(section, kPlotPrefix))
    throw ConfigError(fmt::format(
        "unknown section [{}]; expected [experiment], [data NAME], [setting NAME] or [plot NAME]", section));
}

Experiment readExperiment(const ExperimentFile& file, const std::vector<std::string>& overrides,
                          const fs::path& data_folder) {
  for (const auto& entry : file.entries()) file.at(entry, [&] { refuseUnknownSection(entry); });
  const Lists lists = readLists(file, overrides);
  Experiment experiment;
  experiment.title = lists.title;
  experiment.worst = lists.worst;
  for (const auto& name : listOf("data", lists.data))
    experiment.data.push_back(readData(file, name, data_folder));
  for (const auto& name : listOf("settings", lists.settings))
    experiment.settings.push_back(readSetting(file, name));
  for (const auto& seed : listOf("seeds", lists.seeds))
    experiment.seeds.push_back(parseSeed(seed, "[experiment] seeds"));
  for (const auto& key : listOf("columns", lists.columns))
    experiment.columns.push_back(readColumn(key, "[experiment] columns"));
  experiment.plots = readPlots(file, experiment.columns);
  return experiment;
}

}  // namespace

const std::vector<ExperimentColumn>& experimentColumns() {
  static const std::vector<ExperimentColumn> kColumns = {
      {"mae_m", "MAE, m", 4},
      {"mae_rad", "MAE, rad", 4},
      {"rmse_m", "RMSE, m", 4},
      {"rmse_rad", "RMSE, rad", 4},
      {"ate_m", "ATE, m", 4},
      {"ate_deg", "ATE, deg", 3},
      {"ape_mean_m", "APE mean, m", 4},
      {"ape_rmse_m", "APE RMSE, m", 4},
      {"ape_std_m", "APE std, m", 4},
      {"rpe_mean_m", "RPE mean, m", 5},
      {"rpe_rmse_m", "RPE RMSE, m", 5},
      {"rpe_std_m", "RPE std, m", 5},
      {"rpe_rmse_deg", "RPE RMSE, deg", 4},
      {"auc", "AUC", 4},
      {"precision", "precision", 4},
      {"recall", "recall", 4},
      {"accuracy", "accuracy", 4},
      {"coverage", "coverage", 4},
      {"final_m", "final position, m", 3},
      {"ci_frames", "CI of poses", 3},
      {"nees_frames", "NEES of poses", 3},
      {"landmark_rmse_m", "landmarks RMSE, m", 3},
      {"ci_landmarks", "CI of landmarks", 3},
      {"nees_landmarks", "NEES of landmarks", 3},
      {"landmarks", "landmarks", 1},
      {"landmarks_compared", "landmarks compared", 1},
      {"gps_rmse_m", "GPS RMSE, m", 3},
      {"gps_median_m", "GPS median, m", 3},
      {"relations_m", "relations, m", 4},
      {"relations_deg", "relations, deg", 3},
      {"relations_rmse_m", "relations RMSE, m", 4},
      {"relations_std_m", "relations std, m", 4},
      {"local_relations_m", "local relations, m", 4},
      {"local_relations_deg", "local relations, deg", 3},
      {"constraints_accepted", "loops accepted", 1},
      {"constraints_contradicted", "loops contradicted", 1},
      {"scans", "scans", 0},
      {"submaps", "submaps", 1},
      {"key_nodes", "nodes", 0},
      {"nodes_per_submap", "nodes/submap", 1},
      {"match_score_mean", "match score", 4},
      {"match_score_min", "least score", 4},
      {"match_score_max", "greatest score", 4},
      {"stage_1", "map after stage 1", 3},
      {"stage_2", "stage 2", 3},
      {"stage_3", "stage 3", 3},
      {"stage_4", "stage 4", 3},
      {"stage_5", "stage 5", 3},
      {"build_wall_s", "submaps, s", 2},
      {"join_wall_s", "joining, s", 2},
      {"wall_s", "total, s", 2},
      {"build_cpu_s", "submaps, CPU s", 2},
      {"join_cpu_s", "joining, CPU s", 2},
      {"cpu_s", "total, CPU s", 2},
      {"join_iterations", "iterations", 1},
      {"iteration_s", "per iteration, s", 4},
      {"objective", "objective", 1},
      {"peak_memory_mb", "memory, MB", 0},
  };
  return kColumns;
}

Experiment loadExperiment(const std::string& file, const std::vector<std::string>& overrides,
                          const std::string& data_folder) {
  const ExperimentFile description(file);
  const fs::path folder = data_folder.empty() ? fs::path(file).parent_path() : fs::path(data_folder);
  try {
    return readExperiment(description, overrides, folder);
  } catch (const LineError&) {
    throw;
  } catch (const ConfigError& e) {
    throw ConfigError(fmt::format("{}: {}", file, e.what()));
  }
}

std::string effectiveDescription(const std::string& file, const std::vector<std::string>& overrides) {
  std::vector<std::string> lines;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  const auto entries = readIni(file);
  std::string added;
  for (const auto& override : overrides) {  // experiment.KEY=VALUE, as loadExperiment() has checked
    const std::string key =
        override.substr(override.find('.') + 1, override.find('=') - override.find('.') - 1);
    const std::string line = fmt::format("{} = {}", key, override.substr(override.find('=') + 1));
    const auto there = std::find_if(entries.begin(), entries.end(), [&](const IniEntry& e) {
      return e.section == "experiment" && e.key == key;
    });
    if (there == entries.end())
      added += "\n" + line;
    else
      lines[there->line - 1] = line;
  }
  const auto heading = std::find_if(entries.begin(), entries.end(),
                                    [](const IniEntry& e) { return e.section == "experiment"; });
  if (heading == entries.end())
    lines.insert(lines.begin(), "[experiment]" + added);
  else
    lines[heading->line - 1] += added;
  return fmt::format("{}\n", fmt::join(lines, "\n"));
}

}  // namespace submap_slam
