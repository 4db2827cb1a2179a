#include <fmt/format.h>
#include <submap_slam/pipeline/configuration.h>

#include <iostream>
#include <memory>

#include "commands.h"

namespace submap_slam {
namespace {

struct ParametersOptions {
  ConfigurationOptions configuration;
  bool ini = false;
};

int runParameters(const ParametersOptions& options) {
  const Configuration defaults(options.configuration.plugins);
  if (options.ini) {
    defaults.table.writeIni(std::cout);
  } else {
    defaults.table.writeReference(std::cout);
  }
  return kSuccess;
}

}  // namespace

void addParametersCommand(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ParametersOptions>();
  CLI::App* command = app.add_subcommand("parameters", "Prints the reference of all ini keys in Markdown");
  addPluginOption(*command, options->configuration);
  command->add_flag("--ini", options->ini, "Print an ini file with the defaults instead");
  command->footer("Example: submap-slam parameters --ini > my.ini");
  command->callback([options, &exit_code] { exit_code = runParameters(*options); });
}

void listJoiners(const std::vector<std::string>& plugin_files) {
  const Configuration config(plugin_files);
  if (config.joiners.empty()) fmt::print("no joiners: no plugin was found\n");
  for (const auto& joiner : config.joiners) fmt::print("{:24} {}\n", joiner->name(), joiner->description());
}

}  // namespace submap_slam
