#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/pipeline/configuration.h>
#include <submap_slam/pipeline/landmark_pipeline.h>
#include <submap_slam/pipeline/pipeline.h>
#include <submap_slam/rawlog/landmark_log.h>

#include <memory>

#include "commands.h"
#include "summary.h"
#include "symbol_tables.h"
#include "terminal_reporter.h"

namespace submap_slam {
namespace {

struct JoinOptions {
  RunOptions run;
  std::string submap_file, folder, edits_file;
  bool unknown_association = false;
};

/** Lets the landmark joiner ignore the ids, unless the configuration says already how. */
void ignoreIds(Configuration& config) {
  for (const auto& parameter : config.table.parameters())
    if (parameter.section == config.joining.landmark_joiner && parameter.key == "association" &&
        parameter.value() == "known") {
      config.table.set(parameter.section, parameter.key, "jcbb");
      return;
    }
}

RunSummary joinGrids(const JoinOptions& options, const Configuration& config, Reporter& reporter) {
  const Edits edits = options.edits_file.empty() ? Edits{} : readEdits(options.edits_file);
  return joinFile(options.submap_file, options.folder, options.run.overwrite, config, reporter, edits);
}

RunSummary joinLandmarks(const JoinOptions& options, const Configuration& config, Reporter& reporter) {
  if (!options.edits_file.empty())
    throw ConfigError("--edits: is for grid submaps; the file holds landmark submaps");
  return joinLandmarkFile(options.submap_file, options.folder, options.run.overwrite, config, reporter);
}

int runJoin(const JoinOptions& options) {
  const auto config = loadConfiguration(options.run.configuration);
  giveBackSymbolTables();
  const bool landmarks = holdsLandmarkSubmaps(options.submap_file);
  if (options.unknown_association && !landmarks)
    throw InputError(
        fmt::format("{}: --unknown-association: expected a file of landmark submaps", options.submap_file));
  if (options.unknown_association) ignoreIds(*config);
  const auto limit = limitThreads(options.run.threads);
  TerminalReporter reporter(options.run.quiet);
  const RunSummary summary = (landmarks ? joinLandmarks : joinGrids)(options, *config, reporter);
  reporter.note((landmarks ? landmarkSummary : mapSummary)(summary, options.folder));
  return exitCodeOf(summary);
}

}  // namespace

void addJoinCommand(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<JoinOptions>();
  CLI::App* command = app.add_subcommand("join", "Joins a file of submaps and writes all results");
  command
      ->add_option("submaps", options->submap_file,
                   "Submaps that `build` or `map` wrote, or landmark submaps as rawlog or text (also .gz)")
      ->required()
      ->type_name("SUBMAPS");
  command->add_option("-o,--output", options->folder, "Folder for the results; must be new or empty")
      ->required()
      ->type_name("OUTDIR");
  command->add_flag("--unknown-association", options->unknown_association,
                    "Landmark submaps: match by position, ignore the ids of the file");
  addConfigurationOptions(*command, options->run.configuration);
  addRunOptions(*command, options->run);
  addMemoryOption(*command, options->run.configuration);
  addEditsOption(*command, options->edits_file);
  command->footer(
      "Example: submap-slam join intel_submaps.rawlog -o intel --set joining.chain=grid_gauss_newton");
  command->callback([options, &exit_code] { exit_code = runJoin(*options); });
}

}  // namespace submap_slam
