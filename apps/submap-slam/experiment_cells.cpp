#include "experiment_cells.h"

#include <fmt/format.h>
#include <mrpt/system/os.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/core/version.h>
#include <submap_slam/output/json_file.h>
#include <submap_slam/output/replace_file.h>
#include <submap_slam/output/text_file.h>
#include <submap_slam/output/trajectory_file.h>
#include <submap_slam/pipeline/landmark_pipeline.h>
#include <submap_slam/pipeline/map_forms.h>
#include <submap_slam/pipeline/pipeline.h>
#include <submap_slam/pipeline/results.h>
#include <submap_slam/pipeline/run_files.h>
#include <submap_slam/rawlog/landmark_log.h>
#include <submap_slam/rawlog/resume_state.h>
#include <tbb/info.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <sstream>

#include "cell_scores.h"
#include "child_processes.h"
#include "common_options.h"
#include "landmark_scores.h"
#include "program_hash.h"
#include "simulation_files.h"
#include "stop_signal.h"
#include "terminal_reporter.h"

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
  std::string log, truth, landmarks;  ///< files

  std::string name() const { return fmt::format("{}, {}, seed {}", data.name, setting.name, seed); }
};

// Simulated data

std::string simulationText(const ExperimentData& data) {
  return version() + scenarioIni(loadScenario(data.world, "", data.simulation));
}

/** Named by all that they depend on, so that an older simulation is never taken for a new one. */
SimulationFiles simulationFiles(const fs::path& folder, const ExperimentData& data, uint64_t seed) {
  const Scenario scenario = loadScenario(data.world, "", data.simulation);
  const std::string hash = textHash(programHash({}) + simulationText(data));
  return {(folder / "data" / fmt::format("{}-{}-{}", data.world, hash, seed)).string(), scenario};
}

/** What simulates the logs of cells that do not exist yet, each once. */
std::vector<ChildTask> simulationTasks(const std::vector<Cell>& cells, const fs::path& folder) {
  std::vector<ChildTask> tasks;
  std::set<std::string> logs;
  for (const Cell& cell : cells) {
    const ExperimentData& data = cell.data;
    if (data.world.empty() || fs::exists(cell.log) || !logs.insert(cell.log).second) continue;
    const auto simulate = [&data, seed = cell.seed, files = simulationFiles(folder, data, cell.seed)] {
      writeSimulation(loadScenario(data.world, "", data.simulation), seed, RawlogForm::kObservations, files);
    };
    tasks.push_back({fmt::format("simulating {}, seed {}", data.name, cell.seed), folder / "data", simulate});
  }
  return tasks;
}

// One cell

std::unique_ptr<Configuration> configurationOf(const Cell& cell) {
  ConfigurationOptions options;
  options.settings = cell.data.settings;
  options.settings.insert(options.settings.end(), cell.setting.settings.begin(), cell.setting.settings.end());
  options.seed = cell.seed;
  auto config = loadConfiguration(options);
  vary(config->table, cell.setting.variation, cell.seed);
  return config;
}

/** Everything that a result depends on but the build of the program; recordings by both ends of their files.
 */
std::string fingerprint(const Cell& cell) {
  std::ostringstream text;
  text << version() << '\n' << cell.setting.baseline << '\n';
  configurationOf(cell)->table.writeIni(text);
  if (!cell.data.world.empty()) text << simulationText(cell.data);
  const auto& antenna = cell.data.antenna;
  text << antenna.x << ' ' << antenna.y << '\n';
  for (const auto& file :
       {cell.data.log, cell.data.truth, cell.data.relations, cell.data.landmarks, cell.data.gps})
    if (!file.empty()) text << endsHash(file) << ' ' << fs::file_size(file) << '\n';
  return textHash(text.str());
}

/** The build that a cell runs with, the plugins of its setting included. */
std::string buildOf(const Cell& cell) {
  std::vector<std::string> files;
  std::istringstream list(configurationOf(cell)->plugins);
  for (std::string file; std::getline(list, file, ',');) files.push_back(file);
  return programHash(files);
}

/** The poses and the map that are to be judged; a result of landmarks alone has no grid map. */
struct Estimate {
  TimedTrajectory trajectory;
  std::optional<EvidenceGrid> map;
};

/** What a run of the pipeline wrote into the cell's folder. */
Estimate estimateOf(const Cell& cell, const RunSummary& summary, Metrics& figures) {
  if (summary.interrupted) throw Interrupted();
  figures = summary.metrics;
  const double iterations = figures["join_iterations"].get<double>();
  if (iterations > 0) figures["iteration_s"] = figures["join_wall_s"].get<double>() / iterations;
  const OutputDirectory out(cell.folder, true);
  Estimate estimate{readTum(out.file("trajectory.tum")), {}};
  if (summary.joined) estimate.map = summary.joined->map.unpacked();
  return estimate;
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
  const auto has_scans = [](const Frame& frame) { return !frame.scans.empty(); };
  if (std::any_of(frames.begin(), frames.end(), has_scans))
    estimate.map = mapFromPoses(frames, estimate.trajectory, {}, config.mapper);
  return estimate;
}

void judgeLandmarks(Metrics& figures, const Cell& cell, const std::string& submaps,
                    const TimedTrajectory& truth) {
  const LandmarkScores scores = landmarkScores(cell.folder, submaps, truth, cell.landmarks);
  writeText((cell.folder / kConsistencyFile).string(), frameErrorsCsv(scores.frames));
  addLandmarkScores(figures, scores);
}

/** @param submaps file of landmark submaps, empty if the result is without */
void addScores(Metrics& figures, const Cell& cell, const Configuration& config, const Estimate& estimate,
               const std::vector<Frame>& frames, const std::string& submaps) {
  const TimedTrajectory& path = estimate.trajectory;
  if (!cell.truth.empty()) {
    const TimedTrajectory truth = readTum(cell.truth);
    addPoseScores(figures, path, truth);
    if (estimate.map) addMapScores(figures, *estimate.map, path, truth, frames, config.mapper);
    if (!submaps.empty()) judgeLandmarks(figures, cell, submaps, truth);
  }
  if (!cell.data.relations.empty()) addRelationScores(figures, path, cell.data.relations);
  if (!cell.data.gps.empty()) addGpsScores(figures, path, cell.data.gps, cell.data.antenna);
}

/** Maps a log, or takes its poses from elsewhere, and judges the result. */
void mapLog(const Cell& cell, const Configuration& config, Metrics& figures) {
  const MapForms forms = mapForms(cell.log, config);
  const bool pipeline = cell.setting.baseline.empty();
  std::vector<Frame> frames;
  if (!pipeline || (forms.grids && !cell.truth.empty()))
    frames = readFrames(cell.log, readerParams(config, forms));
  TerminalReporter reporter(true);
  const Estimate estimate =
      pipeline ? estimateOf(cell, mapRawlog(cell.log, cell.folder.string(), true, config, reporter), figures)
               : runBaseline(cell, config, frames);
  const std::string submaps = pipeline && forms.landmarks ? (cell.folder / kLandmarkFile).string() : "";
  addScores(figures, cell, config, estimate, frames, submaps);
}

/** Joins a log of landmark submaps and judges the result. */
void joinLog(const Cell& cell, const Configuration& config, Metrics& figures) {
  if (!cell.setting.baseline.empty())
    throw InputError(fmt::format("{}: holds landmark submaps, of which there is no baseline", cell.log));
  TerminalReporter reporter(true);
  const RunSummary run = joinLandmarkFile(cell.log, cell.folder.string(), true, config, reporter);
  addScores(figures, cell, config, estimateOf(cell, run, figures), {}, cell.log);
}

void runCell(const Cell& cell, int threads) {
  const auto config = configurationOf(cell);
  const auto limit = limitThreads(threads);
  Metrics figures;
  (holdsLandmarkSubmaps(cell.log) ? joinLog : mapLog)(cell, *config, figures);
  figures["version"] = version();
  figures["mrpt"] = mrpt::system::MRPT_getVersion();
  figures["build"] = buildOf(cell);
  figures["seed"] = cell.seed;
  figures["fingerprint"] = fingerprint(cell);
  replaceFile((cell.folder / kResultFile).string(),
              [&figures](const std::string& file) { writeJson(file, figures); });
}

nlohmann::json readResult(const fs::path& folder) {
  std::ifstream in(folder / kResultFile);
  return nlohmann::json::parse(in, nullptr, false);
}

bool isComplete(const Cell& cell, bool any_build) {
  const auto result = readResult(cell.folder);
  return result.is_object() && result.value("fingerprint", "") == fingerprint(cell) &&
         (any_build || result.value("build", "") == buildOf(cell));
}

Cell cellOf(const fs::path& folder, const ExperimentData& data, const ExperimentSetting& setting,
            uint64_t seed) {
  const fs::path own = folder / "cells" / data.name / setting.name / std::to_string(seed);
  if (data.world.empty()) return {data, setting, seed, own, data.log, data.truth, data.landmarks};
  const SimulationFiles files = simulationFiles(folder, data, seed);
  return {data, setting, seed, own, files.log, files.truth, files.landmarks};
}

std::vector<Cell> cellsOf(const Experiment& experiment, const fs::path& folder) {
  std::vector<Cell> cells;
  for (const auto& data : experiment.data)
    for (const auto& setting : experiment.settings)
      for (const uint64_t seed : experiment.seeds) cells.push_back(cellOf(folder, data, setting, seed));
  return cells;
}

}  // namespace

std::string listCells(const Experiment& experiment, const ExperimentRun& run) {
  std::string list;
  for (const Cell& cell : cellsOf(experiment, run.folder))
    list += fmt::format("{}: {}\n", cell.name(), isComplete(cell, run.any_build) ? "complete" : "to do");
  return list;
}

bool runCells(const Experiment& experiment, const ExperimentRun& run, Reporter& reporter) {
  fs::create_directories(run.folder / "data");
  std::vector<Cell> to_do;
  for (const Cell& cell : cellsOf(experiment, run.folder))
    if (!isComplete(cell, run.any_build)) to_do.push_back(cell);
  if (!runInChildProcesses(simulationTasks(to_do, run.folder), run.jobs, reporter)) return false;

  const int threads =
      run.threads > 0 ? run.threads : std::max(1, tbb::info::default_concurrency() / run.jobs);
  std::vector<ChildTask> tasks;
  for (const Cell& cell : to_do) {
    fs::remove(cell.folder / kResultFile);
    tasks.push_back({cell.name(), cell.folder, [cell, threads] { runCell(cell, threads); }});
  }
  return runInChildProcesses(tasks, run.jobs, reporter);
}

CellResult readCell(const fs::path& experiment_folder, const ExperimentData& data,
                    const ExperimentSetting& setting, uint64_t seed) {
  const Cell described = cellOf(experiment_folder, data, setting, seed);
  CellResult cell;
  cell.folder = described.folder;
  cell.truth = described.truth;
  std::ifstream error(cell.folder / kErrorFile);
  std::getline(error, cell.error);
  const auto result = readResult(cell.folder);
  if (!result.is_object()) return cell;
  for (const auto& [key, value] : result.items())
    if (value.is_number()) cell.figures[key] = value.get<double>();
  cell.build = result.value("build", "");
  cell.mrpt = result.value("mrpt", "");
  return cell;
}

std::string CellResult::failure() const {
  if (!figures.empty()) return "";
  return error.empty() ? "not run" : error;
}

}  // namespace submap_slam
