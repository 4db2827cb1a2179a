#include "experiment.h"

#include <fmt/format.h>
#include <mrpt/config/CConfigFile.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/core/parameters.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <iterator>
#include <sstream>

#include "configuration.h"
#include "simulation_files.h"

namespace submap_slam {
namespace fs = std::filesystem;
namespace {

using mrpt::config::CConfigFile;

const std::string kDataPrefix = "data ", kSettingPrefix = "setting ";

/** Section [experiment]: lists of words. */
struct Lists {
  std::string title, data, settings, seeds = "1", columns;
};

void describe(ParameterTable& table, Lists& lists) {
  table.section("experiment", "A table: data × settings, each figure as mean over the seeds");
  table.add("title", lists.title, "Heading of the table");
  table.add("data", lists.data, "Names of the sections [data NAME] to use, separated by commas");
  table.add("settings", lists.settings, "Names of the sections [setting NAME] to use");
  table.add("seeds", lists.seeds, "Seeds of simulation and mapping; one cell for each");
  table.add("columns", lists.columns, "Figures to tabulate");
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

std::vector<std::string> keysOf(const CConfigFile& ini, const std::string& section) {
  std::vector<std::string> keys;
  ini.getAllKeys(section, keys);
  return keys;
}

void requireSection(const CConfigFile& ini, const std::string& key, const std::string& section) {
  if (!ini.sectionExists(section))
    throw ConfigError(fmt::format("[experiment] {}: there is no section [{}]", key, section));
}

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

ExperimentData readData(const CConfigFile& ini, const std::string& name, const fs::path& folder) {
  requireName(name);
  const std::string section = kDataPrefix + name;
  requireSection(ini, "data", section);
  ExperimentData data;
  data.name = name;
  for (const auto& key : keysOf(ini, section)) {
    const std::string value = ini.read_string(section, key, "");
    if (key == "world") {
      data.world = value;
    } else if (key == "log" || key == "truth" || key == "relations") {
      (key == "log" ? data.log : key == "truth" ? data.truth : data.relations) = existingFile(value, folder);
    } else if (startsWith(key, "simulation.")) {
      data.simulation.push_back(fmt::format("{}={}", key, value));
    } else {
      throw ConfigError(fmt::format(
          "unknown key [{}] {}; expected world, simulation.KEY, log, truth or relations", section, key));
    }
  }
  if (data.world.empty() == data.log.empty())
    throw ConfigError(fmt::format("[{}]: needs either a world or a log", section));
  if (!data.world.empty()) loadScenario(data.world, "", data.simulation);  // throws for what is wrong
  return data;
}

ExperimentSetting readSetting(const CConfigFile& ini, const std::string& name) {
  requireName(name);
  const std::string section = kSettingPrefix + name;
  requireSection(ini, "settings", section);
  ExperimentSetting setting;
  setting.name = name;
  for (const auto& key : keysOf(ini, section)) {
    const std::string value = ini.read_string(section, key, "");
    if (key == "baseline") {
      setting.baseline = value;
    } else {
      setting.settings.push_back(fmt::format("{}={}", key, value));
    }
  }
  if (!setting.baseline.empty() && setting.baseline != "odometry" && setting.baseline != "truth")
    throw ConfigError(
        fmt::format("[{}] baseline = '{}': expected odometry or truth", section, setting.baseline));
  ConfigurationOptions options;
  options.settings = setting.settings;
  loadConfiguration(options)->joinerChain();  // throws for what is wrong
  return setting;
}

ExperimentColumn readColumn(const std::string& key) {
  std::vector<std::string> known;
  for (const auto& column : experimentColumns()) {
    if (column.key == key) return column;
    known.push_back(column.key);
  }
  throw ConfigError(fmt::format("[experiment] columns: unknown column '{}'; expected some of {}", key,
                                fmt::join(known, ", ")));
}

uint64_t readSeed(const std::string& text) {
  uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (error != std::errc() || end != text.data() + text.size())
    throw ConfigError(fmt::format("[experiment] seeds: '{}' is not a whole number", text));
  return seed;
}

Lists readLists(const CConfigFile& ini, const std::vector<std::string>& overrides) {
  Lists lists;
  ParameterTable table;
  describe(table, lists);
  for (const auto& key : keysOf(ini, "experiment"))
    table.set("experiment", key, ini.read_string("experiment", key, ""));
  for (const auto& setting : overrides) table.set(setting);
  return lists;
}

void refuseUnknownSections(const CConfigFile& ini) {
  std::vector<std::string> sections;
  ini.getAllSections(sections);
  for (const auto& section : sections)
    if (section != "experiment" && !startsWith(section, kDataPrefix) && !startsWith(section, kSettingPrefix))
      throw ConfigError(
          fmt::format("unknown section [{}]; expected [experiment], [data NAME] or [setting NAME]", section));
}

Experiment readExperiment(const CConfigFile& ini, const std::vector<std::string>& overrides,
                          const fs::path& data_folder) {
  refuseUnknownSections(ini);
  const Lists lists = readLists(ini, overrides);
  Experiment experiment;
  experiment.title = lists.title;
  for (const auto& name : listOf("data", lists.data))
    experiment.data.push_back(readData(ini, name, data_folder));
  for (const auto& name : listOf("settings", lists.settings))
    experiment.settings.push_back(readSetting(ini, name));
  for (const auto& seed : listOf("seeds", lists.seeds)) experiment.seeds.push_back(readSeed(seed));
  for (const auto& key : listOf("columns", lists.columns)) experiment.columns.push_back(readColumn(key));
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
      {"auc", "AUC", 4},
      {"precision", "precision", 4},
      {"recall", "recall", 4},
      {"accuracy", "accuracy", 4},
      {"coverage", "coverage", 4},
      {"relations_m", "relations, m", 4},
      {"relations_deg", "relations, deg", 3},
      {"local_relations_m", "local relations, m", 4},
      {"local_relations_deg", "local relations, deg", 3},
      {"scans", "scans", 0},
      {"submaps", "submaps", 1},
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
  if (!fs::is_regular_file(file)) throw InputError(fmt::format("{}: no such ini file", file));
  const fs::path folder = data_folder.empty() ? fs::path(file).parent_path() : fs::path(data_folder);
  try {
    return readExperiment(CConfigFile(file), overrides, folder);
  } catch (const ConfigError& e) {
    throw ConfigError(fmt::format("{}: {}", file, e.what()));
  }
}

}  // namespace submap_slam
