#include "experiment_settings.h"

#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/core/parameters.h>

namespace submap_slam {
namespace {

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

/** Keys of [setting NAME] that are no parameters of the pipeline. */
bool isOwnKey(const std::string& key) { return key == "baseline" || key == "vary" || key == "varied"; }

}  // namespace

std::unique_ptr<Configuration> configurationWith(const ExperimentFile& file, const IniEntry& heading,
                                                 const std::vector<IniEntry>& keys) {
  ConfigurationOptions options;  // plugins first: they bring parameters themselves
  for (const auto& entry : keys)
    if (entry.key == "plugins.load") options.settings.push_back(assignmentOf(entry));
  auto config = loadConfiguration(options);
  for (const auto& entry : keys)
    if (!isOwnKey(entry.key)) file.at(entry, [&] { config->table.set(assignmentOf(entry)); });
  file.at(heading, [&] { config->joinerChain(); });
  return config;
}

ExperimentSetting readSetting(const ExperimentFile& file, const std::string& name) {
  requireName(name);
  const std::string section = kSettingPrefix + name;
  const IniEntry& heading = file.headingOf(section, "settings");
  ExperimentSetting setting;
  setting.name = name;
  const auto keys = file.keysOf(section);
  for (const auto& entry : keys) file.at(entry, [&] { setSetting(setting, entry); });
  const auto config = configurationWith(file, heading, keys);
  file.at(heading, [&] { vary(config->table, setting.variation, 0); });  // throws for what cannot be varied
  return setting;
}

}  // namespace submap_slam
