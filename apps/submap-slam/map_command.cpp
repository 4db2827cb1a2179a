#include <fmt/format.h>
#include <submap_slam/pipeline/configuration.h>
#include <submap_slam/pipeline/pipeline.h>

#include <memory>

#include <submap_slam/pipeline/landmark_pipeline.h>
#include "commands.h"
#include "summary.h"
#include "symbol_tables.h"
#include "terminal_reporter.h"
#include "viewer_process.h"

namespace submap_slam {
namespace {

struct MapOptions {
  RunOptions run;
  std::vector<std::string> files;
  std::string folder, edits_file;
  bool view = false;
};

int runMap(MapOptions& options) {
  const std::string log = takeLog(options.files, options.run.configuration);
  const auto config = loadConfiguration(options.run.configuration);
  giveBackSymbolTables();
  const Edits edits = options.edits_file.empty() ? Edits{} : readEdits(options.edits_file);
  const auto limit = limitThreads(options.run.threads);
  TerminalReporter reporter(options.run.quiet);
  if (options.view) startViewer(options.folder);

  const RunSummary summary = mapRawlog(log, options.folder, options.run.overwrite, *config, reporter, edits);
  const bool landmarks_alone = summary.metrics.contains("landmarks");
  reporter.note((landmarks_alone ? landmarkSummary : mapSummary)(summary, options.folder));
  return exitCodeOf(summary);
}

}  // namespace

void addMapCommand(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<MapOptions>();
  CLI::App* command =
      app.add_subcommand("map", "Makes a map from a rawlog: builds submaps, joins them, writes all results");
  addLogPositional(*command, options->files);
  command->add_option("-o,--output", options->folder, "Folder for the results; must be new or empty")
      ->required()
      ->type_name("OUTDIR");
  addConfigurationOptions(*command, options->run.configuration);
  addLogOptions(*command, options->run.configuration);
  addRunOptions(*command, options->run);
  addMemoryOption(*command, options->run.configuration);
  addEditsOption(*command, options->edits_file);
  command
      ->add_flag_callback(
          "--incremental",
          [options] { options->run.configuration.settings.emplace_back("joining.incremental=true"); },
          "Join while submaps are being built: map.png, trajectory.tum, graph.g2o and constraints.csv are "
          "always "
          "those of the submaps so far, updates.csv tells what each update took; as --set "
          "joining.incremental=true")
      ->group("Run");
  command
      ->add_flag_callback(
          "--view",
          [options] {
            options->view = true;
            options->run.configuration.settings.emplace_back("joining.incremental=true");
          },
          "Watch in submap-viewer how the map grows; as --incremental otherwise")
      ->group("Run");
  command->footer(
      "A run that was stopped goes on when the same command is given again.\n"
      "Example: submap-slam map intel.rawlog -o intel --set submaps.max_distance=15");
  command->callback([options, &exit_code] { exit_code = runMap(*options); });
}

}  // namespace submap_slam
