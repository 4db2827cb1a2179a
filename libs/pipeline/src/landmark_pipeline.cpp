#include <submap_slam/pipeline/landmark_pipeline.h>

#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/core/landmark_consistency.h>
#include <submap_slam/core/path_length.h>
#include <submap_slam/eval/trajectory_error.h>
#include <submap_slam/output/json_file.h>
#include <submap_slam/output/landmark_files.h>
#include <submap_slam/output/landmark_image.h>
#include <submap_slam/output/replace_file.h>
#include <submap_slam/output/text_file.h>
#include <submap_slam/output/trajectory_file.h>
#include <submap_slam/pipeline/finish_run.h>
#include <submap_slam/pipeline/results.h>
#include <submap_slam/pipeline/run_files.h>
#include <submap_slam/rawlog/landmark_log.h>
#include <submap_slam/report/run_report.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <submap_slam/pipeline/map_updates.h>

namespace submap_slam {
namespace {

void checkResult(const LandmarkJoiner& joiner, const JoinedLandmarks& joined,
                 const LandmarkSubmaps& submaps) {
  std::size_t features = 0;
  for (const auto& submap : submaps) features += submap->features.size();
  if (joined.frames.size() != submaps.size() + 1)
    throw PluginError(fmt::format("joiner {}: gave {} frames for {} submaps, expected one more",
                                  joiner.name(), joined.frames.size(), submaps.size()));
  if (joined.associations.size() != features)
    throw PluginError(fmt::format("joiner {}: said of {} features what became of them, expected {}",
                                  joiner.name(), joined.associations.size(), features));
  const bool finite = std::all_of(joined.frames.begin(), joined.frames.end(),
                                  [](const auto& f) {
                                    return std::isfinite(f.mean.x()) && std::isfinite(f.mean.y()) &&
                                           std::isfinite(f.mean.phi()) && f.cov.asEigen().allFinite();
                                  }) &&
                      std::all_of(joined.landmarks.begin(), joined.landmarks.end(), [](const auto& l) {
                        return std::isfinite(l.x) && std::isfinite(l.y) && l.covariance.asEigen().allFinite();
                      });
  if (!finite)
    throw PluginError(
        fmt::format("joiner {}: gave an estimate or a covariance that is not finite", joiner.name()));
}

void reportResult(const LandmarkJoiner& joiner, const JoinedLandmarks& joined, Reporter& reporter) {
  if (joined.status == JoinStatus::kFailed)
    reporter.warning(fmt::format("{}: the submaps could not be joined: {}; results are without any joining",
                                 joiner.name(), joined.reason));
  else
    reporter.log(fmt::format("{}: {} ({}), objective {}, {} iterations", joiner.name(),
                             toString(joined.status), joined.reason, joined.objective,
                             joined.iterations.size()));
}

/** What the map of the moment is looked at by, each file in one step. */
void writeLandmarksSoFar(const OutputDirectory& out, const std::string& prefix, const JoinedLandmarks& joined,
                         const Trajectory& path) {
  using File = std::string;
  replaceFile(out.file(prefix + "map.png"),
              [&](const File& file) { writeLandmarkImage(file, joined, path); });
  replaceFile(out.file("landmarks.csv"), [&](const File& file) { writeLandmarks(file, joined.landmarks); });
  replaceFile(out.file(prefix + "trajectory.tum"), [&](const File& file) { writeTum(file, path); });
}

void writeLandmarkResults(const OutputDirectory& out, const std::string& prefix,
                          const JoinedLandmarks& joined, const Trajectory& path) {
  writeLandmarksSoFar(out, prefix, joined, path);
  writeLandmarkScene(out.file(prefix + "map.3Dscene"), joined, path);
  writeAssociations(out.file("association.csv"), joined.associations);
}

std::vector<mrpt::poses::CPose2D> endsOf(const JoinedLandmarks& joined) {
  std::vector<mrpt::poses::CPose2D> ends;
  for (std::size_t k = 0; k + 1 < joined.frames.size(); ++k)
    ends.push_back(joined.frames[k + 1].mean - joined.frames[k].mean);
  return ends;
}

}  // namespace

LandmarkHalf::LandmarkHalf(const LandmarkJoiner& joiner, const OutputDirectory& out, bool beside_grids,
                           double update_growth, Reporter& reporter)
    : joiner_(joiner),
      at_work_(joiner.incremental()),
      out_(out),
      prefix_(beside_grids ? "landmark_" : ""),
      schedule_(update_growth),
      reporter_(reporter),
      table_("submaps,landmarks,objective,status,join_s,update_s\n") {}

JoinedLandmarks LandmarkHalf::join(const LandmarkSubmaps& submaps, bool& stopped) {
  const auto show = [&](double fraction) { reporter_.progress("joining with " + joiner_.name(), fraction); };
  const auto progress = [&](double fraction, const std::string&) {
    show(fraction);
    stopped = stopped || reporter_.stopRequested();
    return !stopped;
  };
  show(0);
  JoinedLandmarks joined = at_work_->join(submaps, progress);
  show(1);
  checkResult(joiner_, joined, submaps);
  return joined;
}

void LandmarkHalf::update(std::size_t submaps_in_file, double fraction) {
  if (!schedule_.take(submaps_in_file)) return;
  const StageTimer timer;
  const LandmarkSubmaps submaps = readLandmarkSubmaps(out_.file(kLandmarkFile));
  const StageTimer join_timer;
  bool stopped = false;
  JoinedLandmarks joined;
  // Else a thread that waits for the joiner might begin to build a submap meanwhile.
  tbb::this_task_arena::isolate([&] { joined = join(submaps, stopped); });
  if (stopped) return;
  const double join_s = join_timer.elapsed().wall_s;
  writeLandmarksSoFar(out_, prefix_, joined, trajectoryOf(submaps, joined));
  in_map_ = submaps.size();
  const double update_s = timer.elapsed().wall_s;
  table_ += fmt::format("{},{},{},{},{:.4f},{:.4f}\n", submaps.size(), joined.landmarks.size(),
                        joined.objective, toString(joined.status), join_s, update_s);
  replaceFile(out_.file(kUpdatesFile), [this](const std::string& file) { writeText(file, table_); });
  reporter_.note(fmt::format("map of {} landmark submaps ({:.0f} % of the log): {}, in {:.2f} s",
                             submaps.size(), 100 * fraction, toString(joined.status), update_s));
}

FinishedMap LandmarkHalf::finish(const LandmarkSubmaps& submaps, RunSummary& summary) {
  Metrics metrics;
  const StageTimer join_timer;
  reporter_.log(fmt::format("{} landmark submaps", submaps.size()));
  JoinedLandmarks joined = join(submaps, summary.interrupted);
  reportResult(joiner_, joined, reporter_);
  if (const auto text = describeContradiction(submaps, joined); !text.empty()) reporter_.warning(text);
  addTime(metrics, "join_", join_timer);
  addStage(summary.metrics, join_timer.record(joiner_.name()));
  summary.failed = joined.status == JoinStatus::kFailed;
  addLandmarkMetrics(metrics, submaps, joined);

  const StageTimer write_timer;
  Trajectory path = trajectoryOf(submaps, joined);
  writeLandmarkResults(out_, prefix_, joined, path);
  writeFrames(out_.file(prefix_ + "frames.csv"), submaps, joined);
  addTime(metrics, "write_", write_timer);
  addStage(summary.metrics, write_timer.record(prefix_ + "write"));
  for (const auto& [key, value] : metrics.items()) summary.metrics[prefix_ + key] = value;
  if (!summary.failed) ends_ = endsOf(joined);
  return {std::move(path), [submaps, joined = std::move(joined)](const RunRecord& record) {
            return runReport(submaps, joined, record);
          }};
}

void comparePaths(const Trajectory& grid_path, const Trajectory& path, Metrics& metrics, Reporter& reporter) {
  const auto pairs = associate(TimedTrajectory(grid_path), TimedTrajectory(path));
  const TrajectoryError error = absoluteTrajectoryError(pairs);
  metrics["landmark_path_difference_m"] = error.translation_m.rmse;
  metrics["landmark_path_difference_deg"] = error.rotation_deg.rmse;
  constexpr double kMuch = 0.01;
  const std::string text =
      fmt::format("the paths of grids and landmarks differ by {:.2f} m and {:.1f} deg (RMS)",
                  error.translation_m.rmse, error.rotation_deg.rmse);
  if (error.translation_m.rmse > kMuch * pathLength(path))
    reporter.warning(text + "; the map of one of them is bent");
  else
    reporter.log(text);
}

RunSummary joinLandmarkFile(const std::string& submap_file, const std::string& folder, bool overwrite,
                            const Configuration& config, Reporter& reporter) {
  const StageTimer timer;
  RunSummary summary;
  const auto joiner = config.landmarkJoiner();
  const RecoveredLandmarkSubmaps read = recoverLandmarkSubmaps(submap_file);
  summary.damaged = !read.damage.empty();
  if (summary.damaged) reporter.warning(read.damage + kRestIsJoined);
  const OutputDirectory out(folder, overwrite);
  addTimedStage(summary.metrics, "read", timer);
  LandmarkHalf half(*joiner, out, false, config.joining.update_growth, reporter);
  const FinishedMap map = half.finish(read.submaps, summary);
  finishRun({submap_file, out, config, reporter, timer}, summary.metrics, map.report);
  return summary;
}

}  // namespace submap_slam
