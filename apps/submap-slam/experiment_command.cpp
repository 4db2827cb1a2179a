#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/output/output_directory.h>
#include <submap_slam/output/replace_file.h>
#include <submap_slam/output/text_file.h>
#include <submap_slam/report/web_page.h>

#include <filesystem>
#include <memory>

#include "commands.h"
#include "experiment_cells.h"
#include "experiment_page.h"
#include "experiment_table.h"
#include "terminal_reporter.h"

namespace submap_slam {
namespace fs = std::filesystem;
namespace {

constexpr const char* kExperimentFile = "experiment.ini";
constexpr const char* kPageFile = "experiment.html";

struct ExperimentOptions {
  std::string file, data_folder;
  std::vector<std::string> settings;
  ExperimentRun run;
  bool list = false, quiet = false;
};

/** The folder, new or of an earlier run of an experiment, and the description in it, with which the table can
 * be made again. */
void openExperimentFolder(const ExperimentOptions& options, const std::string& description) {
  const fs::path& folder = options.run.folder;
  const fs::path record = folder / kExperimentFile;
  const OutputDirectory out(folder, fs::exists(record));
  replaceFile(record.string(), [&](const std::string& file) { writeText(file, description); });
}

/** Tables and page of what is complete; returns how many cells are not. */
std::size_t writeResults(const Experiment& experiment, const fs::path& folder,
                         const std::string& description) {
  const auto rows = readRows(experiment, folder);
  writeTables(experiment, rows, folder);
  writeText((folder / kPageFile).string(), webPage(experimentPage(experiment, rows, description)));
  std::size_t missing = 0;
  for (const auto& row : rows) missing += row.cells.size() - row.complete();
  return missing;
}

int runExperiment(ExperimentOptions& options) {
  const Experiment experiment = loadExperiment(options.file, options.settings, options.data_folder);
  fs::path& folder = options.run.folder;
  if (folder.empty()) folder = fs::path(options.file).stem();
  if (options.list) {
    fmt::print("{}", listCells(experiment, options.run));
    return kSuccess;
  }
  const std::string description = effectiveDescription(options.file, options.settings);
  openExperimentFolder(options, description);
  TerminalReporter reporter(options.quiet);
  const bool finished = runCells(experiment, options.run, reporter);
  const std::size_t missing = writeResults(experiment, folder, description);
  const std::string table = (folder / "table.md").string();
  if (!finished) {
    reporter.note(
        fmt::format("stopped; {} has what is complete; give the same command again to go on", table));
    return kInterrupted;
  }
  if (missing > 0) {
    reporter.warning(fmt::format("{} cells failed; {} says why", missing, table));
    return kFailure;
  }
  reporter.note(fmt::format("table: {}, page with plots: {}", table, (folder / kPageFile).string()));
  return kSuccess;
}

std::string columnList() {
  std::string list;
  for (const auto& column : experimentColumns()) list += (list.empty() ? "" : ", ") + column.key;
  return list;
}

}  // namespace

void addExperimentCommand(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ExperimentOptions>();
  CLI::App* command =
      app.add_subcommand("experiment", "Runs data sets, settings and seeds of an ini file into one table");
  command->add_option("experiment", options->file, "What to run; docs/experiments.md explains the file")
      ->required()
      ->type_name("FILE.ini");
  command
      ->add_option("-o,--output", options->run.folder,
                   "Folder for cells, tables and page (default: name of the ini file without .ini)")
      ->type_name("OUT");
  command
      ->add_option("--data", options->data_folder,
                   "Folder of the recordings that the ini file names (default: its own)")
      ->type_name("FOLDER");
  command
      ->add_option("--set", options->settings, "Overrides a key of [experiment]; may be given several times")
      ->allow_extra_args(false)
      ->type_name("experiment.KEY=VALUE");
  command->add_option("--jobs", options->run.jobs, "Cells that run at the same time; 1 if times matter")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str()
      ->type_name("N");
  command
      ->add_option("--threads", options->run.threads,
                   "Threads of each cell (default: all, shared by the jobs)")
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  command->add_flag(
      "--any-build", options->run.any_build,
      "Keep complete cells that another build of the same version made (default: run them anew)");
  command->add_flag("--list", options->list, "Only list the cells and which are complete");
  command->add_flag("-q,--quiet", options->quiet, "No progress and no summary");
  command->footer(
      "An experiment that was stopped goes on when the same command is given again: complete cells are "
      "kept.\n"
      "Columns: " +
      columnList() +
      "\nExample: submap-slam experiment ini/experiments/grid_joining/table2_poses.ini -o table2 --jobs 2");
  command->callback([options, &exit_code] { exit_code = runExperiment(*options); });
}

}  // namespace submap_slam
