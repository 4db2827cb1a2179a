#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/pipeline/configuration.h>
#include <submap_slam/pipeline/run_files.h>
#include <submap_slam/rawlog/landmark_log.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include <submap_slam/pipeline/submap_budget.h>
#include "commands.h"
#include "landmark_info.h"
#include "overlap.h"
#include "terminal_reporter.h"

namespace submap_slam {
namespace {

struct InfoOptions {
  std::string submaps, text_file;
  bool overwrite = false;
};

struct Totals {
  double path_m = 0;
  std::size_t nodes = 0, keys = 0, cells = 0;
};

std::string endPoseSigma(const GridSubmap& submap) {
  if (!submap.has_successor) return "-";
  const auto& cov = submap.end_pose.cov;
  const double radians_to_degrees = 180 / M_PI;
  return fmt::format("{:.3f} m {:.2f}°", std::sqrt(cov(0, 0) + cov(1, 1)),
                     std::sqrt(cov(2, 2)) * radians_to_degrees);
}

void printSubmap(const GridSubmap& submap, const EvidenceSummary& grid, double overlap) {
  const std::string size =
      fmt::format("{:.1f} x {:.1f}", grid.columns * grid.resolution, grid.rows * grid.resolution);
  fmt::print("{:>4} {:>8.1f} {:>6} {:>5} {:>9} {:>13} {:>6.0f} % {:>16}  {}\n", submap.id,
             submap.pathLength(), submap.nodes.size(), submap.keyNodes(), grid.observed_cells, size,
             100 * overlap, endPoseSigma(submap), submap.statistics.closed_because);
}

int exitCode(const std::string& damage) {
  if (damage.empty()) return kSuccess;
  TerminalReporter(true).warning(damage);
  return kDamagedLog;
}

int describeGrids(const std::string& file) {
  namespace fs = std::filesystem;
  const fs::path on_disk = "/var/tmp";  // where /tmp may be memory
  const fs::path folder = fs::is_directory(on_disk) ? on_disk : fs::temp_directory_path();
  const auto store =
      SubmapStore::create(submapBudget(JoiningParams{}.memory), (folder / "submap-slam").string());
  const RecoveredSubmaps read = readUsableSubmaps(file, store);
  const GridSubmaps& submaps = read.submaps;
  const auto overlaps = overlapShares(submaps, chainSubmaps(submaps).frames);

  Totals totals;
  fmt::print("{:>4} {:>8} {:>6} {:>5} {:>9} {:>13} {:>8} {:>16}  {}\n", "id", "path m", "nodes", "keys",
             "cells", "size m", "overlap", "end pose sigma", "closed because");
  for (std::size_t i = 0; i < submaps.size(); ++i) {
    const GridSubmap& submap = *submaps[i];
    const EvidenceSummary evidence = submap.evidenceSummary();
    printSubmap(submap, evidence, overlaps[i]);
    totals.path_m += submap.pathLength();
    totals.nodes += submap.nodes.size();
    totals.keys += submap.keyNodes();
    totals.cells += evidence.observed_cells;
  }
  fmt::print("{} submaps, {:.1f} m, {} nodes, {} key nodes, {} observed cells\n", submaps.size(),
             totals.path_m, totals.nodes, totals.keys, totals.cells);
  return exitCode(read.damage);
}

/** Text cannot tell that ids say nothing beyond a submap. */
void exportText(const LandmarkSubmaps& submaps, const std::string& file) {
  writeLandmarkText(file, submaps);
  std::string note = "written: " + file;
  const auto known = [](const auto& submap) { return submap->ids_known; };
  if (!std::all_of(submaps.begin(), submaps.end(), known))
    note += "; which features are the same is not known: join it with --unknown-association";
  TerminalReporter(false).note(note);
}

int describeLandmarks(const InfoOptions& options) {
  const RecoveredLandmarkSubmaps read = recoverLandmarkSubmaps(options.submaps);
  if (options.text_file.empty())
    printLandmarkSubmaps(read.submaps);
  else
    exportText(read.submaps, options.text_file);
  return exitCode(read.damage);
}

int runInfo(const InfoOptions& options) {
  const bool text = !options.text_file.empty();
  if (holdsLandmarkSubmaps(options.submaps)) {
    if (text && !options.overwrite && std::filesystem::exists(options.text_file))
      throw ConfigError(fmt::format("{}: exists; use --overwrite to replace it", options.text_file));
    return describeLandmarks(options);
  }
  if (text) throw InputError(fmt::format("{}: --text: expected a file of landmark submaps", options.submaps));
  return describeGrids(options.submaps);
}

}  // namespace

void addInfoCommand(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<InfoOptions>();
  CLI::App* command = app.add_subcommand("info", "Lists the submaps of a file");
  command
      ->add_option("submaps", options->submaps,
                   "Submaps that `build` or `map` wrote, or landmark submaps as rawlog or text (also .gz)")
      ->required()
      ->type_name("SUBMAPS");
  command
      ->add_option("--text", options->text_file,
                   "Instead of the list: writes landmark submaps as text, packed if the name ends in .gz")
      ->type_name("FILE");
  command->add_flag("--overwrite", options->overwrite, "Replace the text file if it exists");
  command->footer(
      "Overlap: share of the cells that another submap saw too, in the chain of end poses.\n"
      "Example: submap-slam info intel/submaps.rawlog\n"
      "         submap-slam info park/landmark_submaps.rawlog --text park.txt.gz");
  command->callback([options, &exit_code] { exit_code = runInfo(*options); });
}

}  // namespace submap_slam
