#include <fmt/format.h>
#include <submap_slam/pipeline/configuration.h>
#include <submap_slam/pipeline/run_files.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <memory>

#include <submap_slam/pipeline/submap_budget.h>
#include "commands.h"
#include "overlap.h"
#include "terminal_reporter.h"

namespace submap_slam {
namespace {

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

int runInfo(const std::string& file) {
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
  if (read.damage.empty()) return kSuccess;
  TerminalReporter(true).warning(read.damage);
  return kDamagedLog;
}

}  // namespace

void addInfoCommand(CLI::App& app, int& exit_code) {
  auto file = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("info", "Lists the submaps of a file");
  command->add_option("submaps", *file, "Submaps that `build` or `map` wrote")
      ->required()
      ->type_name("SUBMAPS.rawlog");
  command->footer(
      "Overlap: share of the cells that another submap saw too, in the chain of end poses.\n"
      "Example: submap-slam info intel/submaps.rawlog");
  command->callback([file, &exit_code] { exit_code = runInfo(*file); });
}

}  // namespace submap_slam
