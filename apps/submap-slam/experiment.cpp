#include "experiment.h"

#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/core/parameters.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "common_options.h"
#include "experiment_file.h"
#include "simulation_files.h"

namespace submap_slam {
namespace fs = std::filesystem;
namespace {

const std::string kDataPrefix = "data ", kSimulationPrefix = "simulation.";

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

std::vector<std::string> listOf(const char* key, const std::string& text) {
  auto words = wordsOf(text);
  if (words.empty()) throw ConfigError(fmt::format("[experiment] {}: is empty", key));
  return words;
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
    if (!data.landmarks.empty() && data.truth.empty())
      throw ConfigError(
          fmt::format("[{}]: landmarks needs truth, which tells where the map begins", section));
  });
  if (!data.world.empty()) checkSimulation(file, keys, data.world);
  std::vector<IniEntry> facts;
  std::copy_if(keys.begin(), keys.end(), std::back_inserter(facts), isFact);
  configurationWith(file, heading, facts);
  return data;
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
    experiment.columns.push_back(experimentColumn(key, "[experiment] columns"));
  experiment.plots = readPlots(file, experiment.columns, experiment.seeds);
  return experiment;
}

}  // namespace

Experiment loadExperiment(const std::string& file, const std::vector<std::string>& overrides,
                          const std::string& data_folder) {
  const ExperimentFile description(file);
  const fs::path folder = data_folder.empty() ? fs::path(file).parent_path() : fs::path(data_folder);
  try {
    return readExperiment(description, overrides, folder);
  } catch (const ExperimentLineError&) {
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
