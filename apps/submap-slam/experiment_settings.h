#pragma once

#include <submap_slam/pipeline/configuration.h>

#include <memory>
#include <string>
#include <vector>

#include "experiment_file.h"
#include "parameter_variation.h"

namespace submap_slam {

/** Section [setting NAME]: how the data are mapped. */
struct ExperimentSetting {
  std::string name;
  std::string baseline;               ///< empty: the pipeline of `map`; else whose poses are taken instead
  std::vector<std::string> settings;  ///< "section.key=value"
  ParameterVariation variation;       ///< on top of the settings, another one for each seed
};

/** How the headings of settings begin. */
constexpr const char* kSettingPrefix = "setting ";

/** The configuration with the lines of a section. Throws ConfigError or PluginError for what the pipeline
 * would refuse. */
std::unique_ptr<Configuration> configurationWith(const ExperimentFile& file, const IniEntry& heading,
                                                 const std::vector<IniEntry>& keys);

/** Reads and checks the section of a setting. */
ExperimentSetting readSetting(const ExperimentFile& file, const std::string& name);

}  // namespace submap_slam
