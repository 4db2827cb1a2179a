#include <fmt/format.h>
#include <submap_slam/pipeline/configuration.h>
#include <submap_slam/rawlog/rawlog_reader.h>

#include <memory>

#include "commands.h"

namespace submap_slam {
namespace {

struct CheckOptions {
  ConfigurationOptions configuration;
  std::vector<std::string> files;
};

int runCheck(CheckOptions& options) {
  const std::string log = takeLog(options.files, options.configuration);
  const auto config = loadConfiguration(options.configuration);
  const LogReport report = checkLog(log, config->reader);
  fmt::print("{}", report.asText());
  return report.hasErrors() ? kDamagedLog : kSuccess;
}

}  // namespace

void addCheckCommand(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* command = app.add_subcommand("check", "Says what a rawlog holds and what is wrong with it");
  addLogPositional(*command, options->files);
  addConfigurationOptions(*command, options->configuration);
  addLogOptions(*command, options->configuration);
  command->footer(
      "The exit code is 3 if data are lost or unusable.\nExample: submap-slam check intel.rawlog");
  command->callback([options, &exit_code] { exit_code = runCheck(*options); });
}

}  // namespace submap_slam
