#include <submap_slam/pipeline/configuration.h>
#include <submap_slam/pipeline/pipeline.h>

#include <memory>

#include "commands.h"
#include "summary.h"
#include "terminal_reporter.h"

namespace submap_slam {
namespace {

struct BuildOptions {
  RunOptions run;
  std::vector<std::string> files;
  std::string submap_file;
};

int runBuild(BuildOptions& options) {
  const std::string log = takeLog(options.files, options.run.configuration);
  const auto config = loadConfiguration(options.run.configuration);
  const auto limit = limitThreads(options.run.threads);
  TerminalReporter reporter(options.run.quiet);

  const RunSummary summary = buildRawlog(log, options.submap_file, options.run.overwrite, *config, reporter);
  reporter.note(buildSummary(summary, options.submap_file));
  return exitCodeOf(summary);
}

}  // namespace

void addBuildCommand(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<BuildOptions>();
  CLI::App* command =
      app.add_subcommand("build", "Builds the submaps of a rawlog into a file (itself a rawlog)");
  addLogPositional(*command, options->files);
  command->add_option("-o,--output", options->submap_file, "File for the submaps")
      ->required()
      ->type_name("SUBMAPS.rawlog");
  addConfigurationOptions(*command, options->run.configuration);
  addLogOptions(*command, options->run.configuration);
  addRunOptions(*command, options->run);
  command->footer(
      "A run that was stopped goes on when the same command is given again.\n"
      "Example: submap-slam build intel.rawlog -o intel_submaps.rawlog");
  command->callback([options, &exit_code] { exit_code = runBuild(*options); });
}

}  // namespace submap_slam
