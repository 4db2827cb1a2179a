#include "experiment_cells.h"

#include <fmt/format.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/serialization/CArchive.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/core/version.h>
#include <submap_slam/output/json_file.h>
#include <submap_slam/output/replace_file.h>
#include <submap_slam/output/trajectory_file.h>
#include <submap_slam/rawlog/resume_state.h>
#include <tbb/info.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cell_scores.h"
#include "child_processes.h"
#include "pipeline.h"
#include "results.h"
#include "simulation_files.h"
#include "stop_signal.h"

namespace submap_slam {
namespace fs = std::filesystem;
namespace {

constexpr const char* kResultFile = "result.json";

/** One combination of data, setting and seed. */
struct Cell {
  const ExperimentData& data;
  const ExperimentSetting& setting;
  uint64_t seed;
  fs::path folder;
  std::string log, truth;  ///< files

  std::string name() const { return fmt::format("{}, {}, seed {}", data.name, setting.name, seed); }
};

// Simulated data

/** Named by all that they depend on, so that an older simulation is never taken for a new one. */
SimulationFiles simulationFiles(const fs::path& folder, const ExperimentData& data, uint64_t seed) {
  const Scenario scenario = loadScenario(data.world, "", data.simulation);
  const std::string hash = textHash(version() + scenarioIni(scenario));
  return SimulationFiles((folder / "data" / fmt::format("{}-{}-{}", data.world, hash, seed)).string());
}

std::vector<ChildTask> simulationTasks(const Experiment& experiment, const fs::path& folder) {
  std::vector<ChildTask> tasks;
  for (const auto& data : experiment.data) {
    if (data.world.empty()) continue;
    for (const uint64_t seed : experiment.seeds) {
      const SimulationFiles files = simulationFiles(folder, data, seed);
      if (fs::exists(files.log)) continue;
      const auto simulate = [&data, seed, files] {
        writeSimulation(loadScenario(data.world, "", data.simulation), seed, RawlogForm::kObservations,
                        files);
      };
      tasks.push_back({fmt::format("simulating {}, seed {}", data.name, seed), folder / "data", simulate});
    }
  }
  return tasks;
}

// One cell

std::unique_ptr<Configuration> configurationOf(const Cell& cell) {
  ConfigurationOptions options;
  options.settings = cell.setting.settings;
  options.seed = cell.seed;
  auto config = loadConfiguration(options);
  vary(config->table, cell.setting.variation, cell.seed);
  return config;
}

/** Everything that a result depends on; files of recordings by name and size. */
std::string fingerprint(const Cell& cell) {
  std::ostringstream text;
  text << version() << '\n' << cell.setting.baseline << '\n';
  configurationOf(cell)->table.writeIni(text);
  for (const auto& file : {cell.log, cell.truth, cell.data.relations})
    text << fs::path(file).filename().string() << ' ' << (fs::exists(file) ? fs::file_size(file) : 0) << '\n';
  return textHash(text.str());
}

/** The poses and the map that are to be judged. */
struct Estimate {
  TimedTrajectory trajectory;
  mrpt::maps::COccupancyGridMap2D map;
};

mrpt::maps::COccupancyGridMap2D readGridMap(const std::string& file) {
  mrpt::io::CFileGZInputStream in(file);
  auto archive = mrpt::serialization::archiveFrom(in);
  mrpt::maps::COccupancyGridMap2D map;
  archive >> map;
  return map;
}

Estimate runPipeline(const Cell& cell, const Configuration& config, Metrics& figures) {
  Reporter reporter(true);
  const RunSummary summary = mapRawlog(cell.log, cell.folder.string(), true, config, reporter);
  if (summary.interrupted) throw Interrupted();
  figures = summary.metrics;
  const double iterations = figures["join_iterations"].get<double>();
  if (iterations > 0) figures["iteration_s"] = figures["join_wall_s"].get<double>() / iterations;
  const OutputDirectory out(cell.folder, true);
  return {readTum(out.file("trajectory.tum")), readGridMap(out.file("map.gridmap.gz"))};
}

/** Poses from elsewhere, and the map that the scans make there. */
Estimate runBaseline(const Cell& cell, const Configuration& config, const std::vector<Frame>& frames) {
  const OutputDirectory out(cell.folder, true);
  writeRunRecord(out, config, {});
  Estimate estimate;
  if (cell.setting.baseline == "truth") {
    if (cell.truth.empty()) throw InputError("the data have no truth");
    estimate.trajectory = readTum(cell.truth);
  } else {
    const Trajectory odometry = odometryOf(frames);
    if (odometry.empty()) throw InputError("the log has no odometry");
    writeTum(out.file("trajectory.tum"), odometry);
    estimate.trajectory = TimedTrajectory(odometry);
  }
  estimate.map = mapFromPoses(frames, estimate.trajectory, {}, config.mapper);
  return estimate;
}

void runCell(const Cell& cell, int threads) {
  const auto config = configurationOf(cell);
  const auto limit = limitThreads(threads);
  Metrics figures;
  Estimate estimate;
  std::vector<Frame> frames;
  if (cell.setting.baseline.empty()) {
    estimate = runPipeline(cell, *config, figures);
    if (!cell.truth.empty()) frames = readFrames(cell.log, config->reader);
  } else {
    frames = readFrames(cell.log, config->reader);
    estimate = runBaseline(cell, *config, frames);
  }
  if (!cell.truth.empty()) {
    const TimedTrajectory truth = readTum(cell.truth);
    addPoseScores(figures, estimate.trajectory, truth);
    addMapScores(figures, estimate.map, estimate.trajectory, truth, frames, config->mapper);
  }
  if (!cell.data.relations.empty()) addRelationScores(figures, estimate.trajectory, cell.data.relations);

  figures["version"] = version();
  figures["seed"] = cell.seed;
  figures["fingerprint"] = fingerprint(cell);
  replaceFile((cell.folder / kResultFile).string(),
              [&figures](const std::string& file) { writeJson(file, figures); });
}

nlohmann::json readResult(const fs::path& folder) {
  std::ifstream in(folder / kResultFile);
  return nlohmann::json::parse(in, nullptr, false);
}

bool isComplete(const Cell& cell) {
  const auto result = readResult(cell.folder);
  return result.is_object() && result.value("fingerprint", "") == fingerprint(cell);
}

std::vector<Cell> cellsOf(const Experiment& experiment, const fs::path& folder) {
  std::vector<Cell> cells;
  for (const auto& data : experiment.data)
    for (const auto& setting : experiment.settings)
      for (const uint64_t seed : experiment.seeds) {
        Cell cell{data, setting, seed, cellFolder(folder, data, setting, seed), data.log, data.truth};
        if (!data.world.empty()) {
          const SimulationFiles files = simulationFiles(folder, data, seed);
          cell.log = files.log;
          cell.truth = files.truth;
        }
        cells.push_back(cell);
      }
  return cells;
}

}  // namespace

fs::path cellFolder(const fs::path& experiment_folder, const ExperimentData& data,
                    const ExperimentSetting& setting, uint64_t seed) {
  return experiment_folder / "cells" / data.name / setting.name / std::to_string(seed);
}

std::string listCells(const Experiment& experiment, const fs::path& folder) {
  std::string list;
  for (const Cell& cell : cellsOf(experiment, folder))
    list += fmt::format("{}: {}\n", cell.name(), isComplete(cell) ? "complete" : "to do");
  return list;
}

bool runCells(const Experiment& experiment, const ExperimentRun& run, Reporter& reporter) {
  fs::create_directories(run.folder / "data");
  if (!runInChildProcesses(simulationTasks(experiment, run.folder), run.jobs, reporter)) return false;

  const int threads =
      run.threads > 0 ? run.threads : std::max(1, tbb::info::default_concurrency() / run.jobs);
  std::vector<ChildTask> tasks;
  for (const Cell& cell : cellsOf(experiment, run.folder)) {
    if (isComplete(cell)) continue;
    fs::remove(cell.folder / kResultFile);
    tasks.push_back({cell.name(), cell.folder, [cell, threads] { runCell(cell, threads); }});
  }
  return runInChildProcesses(tasks, run.jobs, reporter);
}

CellResult readCell(const fs::path& folder) {
  CellResult cell;
  std::ifstream error(folder / kErrorFile);
  std::getline(error, cell.error);
  const auto result = readResult(folder);
  if (!result.is_object()) return cell;
  for (const auto& [key, value] : result.items())
    if (value.is_number()) cell.figures[key] = value.get<double>();
  return cell;
}

}  // namespace submap_slam
