#include "experiment_curves.h"

#include <fmt/format.h>
#include <submap_slam/eval/gps_error.h>
#include <submap_slam/eval/landmark_errors.h>
#include <submap_slam/eval/trajectory_error.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>

#include "landmark_scores.h"

namespace submap_slam {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

std::string labelOf(const ExperimentRow& row) { return fmt::format("{}, {}", row.data, row.setting); }

double degrees(double radians) { return radians * 180 / M_PI; }

constexpr const char* kTrajectoryFile = "trajectory.tum";

/** The poses where submaps end, times since the start; none if the cell has no such file. */
std::vector<FrameError> framesOf(const CellResult& cell) {
  const fs::path file = cell.folder / kConsistencyFile;
  if (cell.figures.empty() || !fs::exists(file)) return {};
  const double start = readTum((cell.folder / kTrajectoryFile).string()).poses().front().t;
  auto frames = readFrameErrors(file.string());
  for (FrameError& frame : frames) frame.t -= start;
  return frames;
}

/** Means of the first, second, … over lists, each over those that are long enough. */
std::vector<double> meansOf(const std::vector<std::vector<FrameError>>& lists,
                            double (*value)(const FrameError&)) {
  std::vector<double> means;
  for (std::size_t k = 0;; ++k) {
    double sum = 0, count = 0;
    for (const auto& list : lists)
      if (k < list.size()) sum += value(list[k]), ++count;
    if (count == 0) return means;
    means.push_back(sum / count);
  }
}

/** The cell of the seed that a plot shows. */
const CellResult& cellOf(const Experiment& experiment, const ExperimentPlot& plot, const ExperimentRow& row) {
  const auto& seeds = experiment.seeds;
  const auto seed = std::find(seeds.begin(), seeds.end(), plot.seed.value_or(seeds.front()));
  return row.cells[static_cast<std::size_t>(seed - seeds.begin())];
}

template <class Value>
Json listOf(const std::vector<FrameError>& frames, Value value) {
  Json list = Json::array();
  for (const FrameError& frame : frames) list.push_back(value(frame));
  return list;
}

/** Places of a point on the robot along a path; of very long ones every n-th. */
Json pointsJson(const TimedTrajectory& path, const TPose2D& T_plot_path, const TPoint2D& point) {
  constexpr std::size_t kMost = 5000;
  const auto& poses = path.poses();
  const auto rounded = [](double metres) { return std::round(100 * metres) / 100; };
  Json x = Json::array(), y = Json::array();
  for (std::size_t i = 0; i < poses.size(); i += poses.size() / kMost + 1) {
    const TPoint2D p = (T_plot_path + toPose2D(poses[i].pose)).composePoint(point);
    x.push_back(rounded(p.x));
    y.push_back(rounded(p.y));
  }
  return {{"x", x}, {"y", y}};
}

/** What the paths of a data set are laid on. */
struct PathReference {
  std::vector<GpsFix> fixes;
  TPoint2D point{0, 0};  ///< whose path is drawn, on the robot
  TimedTrajectory truth;

  Json drawn(const TimedTrajectory& path) const {
    const auto pairs = fixes.empty() ? associate(truth, path) : antennaPairs(path, fixes, point);
    return pointsJson(path, alignSe2(pairs), point);
  }
};

PathReference referenceOf(const ExperimentData& data, const std::string& truth) {
  PathReference reference;
  if (!data.gps.empty()) {
    reference.fixes = withoutOutliers(readGps(data.gps));
    reference.point = data.antenna;
  }
  if (!truth.empty() && fs::exists(truth)) reference.truth = readTum(truth);
  return reference;
}

Json fixesJson(const std::vector<GpsFix>& fixes) {
  Json x = Json::array(), y = Json::array();
  for (const GpsFix& fix : fixes) {
    x.push_back(fix.position.x);
    y.push_back(fix.position.y);
  }
  return {{"x", x}, {"y", y}};
}

/** What the figures of a pose are compared with where the covariances are honest. */
Json expectedJson(bool index) {
  if (index)
    return {{"value", 1},
            {"text", "a single pose is below 1 in 95 % of all cases if the covariances are honest"}};
  return {{"value", 3}, {"text", "3 is expected"}};
}

}  // namespace

Json timeCurves(const ExperimentPlot& plot, const std::vector<ExperimentRow>& rows) {
  const bool index = plot.y.front().key == "ci_frames";
  Json curves = Json::array();
  for (const ExperimentRow& row : rows) {
    std::vector<std::vector<FrameError>> cells;
    std::transform(row.cells.begin(), row.cells.end(), std::back_inserter(cells), framesOf);
    curves.push_back({{"label", labelOf(row)},
                      {"t", meansOf(cells, [](const FrameError& f) { return f.t; })},
                      {"values", index ? meansOf(cells, [](const FrameError& f) { return f.index; })
                                       : meansOf(cells, [](const FrameError& f) { return f.nees; })}});
  }
  return {{"curves", curves}, {"expected", expectedJson(index)}};
}

Json errorCurves(const Experiment& experiment, const ExperimentPlot& plot,
                 const std::vector<ExperimentRow>& rows) {
  Json curves = Json::array();
  for (const ExperimentRow& row : rows) {
    const auto frames = framesOf(cellOf(experiment, plot, row));
    Json curve{{"label", labelOf(row)}, {"t", listOf(frames, [](const auto& f) { return f.t; })}};
    curve["x"] = {{"error", listOf(frames, [](const auto& f) { return f.error.x; })},
                  {"sigma", listOf(frames, [](const auto& f) { return f.sigma_x; })}};
    curve["y"] = {{"error", listOf(frames, [](const auto& f) { return f.error.y; })},
                  {"sigma", listOf(frames, [](const auto& f) { return f.sigma_y; })}};
    curve["phi"] = {{"error", listOf(frames, [](const auto& f) { return degrees(f.error.phi); })},
                    {"sigma", listOf(frames, [](const auto& f) { return degrees(f.sigma_phi); })}};
    curves.push_back(curve);
  }
  return curves;
}

Json pathCurves(const Experiment& experiment, const ExperimentPlot& plot,
                const std::vector<ExperimentRow>& rows) {
  Json sets = Json::array();
  for (std::size_t d = 0; d < experiment.data.size(); ++d) {
    const auto first = rows.begin() + static_cast<std::ptrdiff_t>(d * experiment.settings.size());
    const auto last = first + static_cast<std::ptrdiff_t>(experiment.settings.size());
    const PathReference reference = referenceOf(experiment.data[d], cellOf(experiment, plot, *first).truth);
    Json set{{"label", experiment.data[d].name}, {"fixes", fixesJson(reference.fixes)}};
    set["truth"] = reference.drawn(reference.truth);
    set["paths"] = Json::array();
    for (auto row = first; row != last; ++row) {
      const CellResult& cell = cellOf(experiment, plot, *row);
      const fs::path file = cell.folder / kTrajectoryFile;
      if (cell.figures.empty() || !fs::exists(file)) continue;
      Json path = reference.drawn(readTum(file.string()));
      path["label"] = row->setting;
      set["paths"].push_back(path);
    }
    sets.push_back(set);
  }
  return sets;
}

}  // namespace submap_slam
