#include "landmark_pipeline.h"

#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/output/landmark_files.h>
#include <submap_slam/output/landmark_image.h>
#include <submap_slam/output/trajectory_file.h>
#include <submap_slam/rawlog/landmark_log.h>
#include <submap_slam/report/run_report.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "finish_run.h"
#include "results.h"
#include "run_files.h"
#include "stop_signal.h"
#include "summary.h"

namespace submap_slam {
namespace {

void checkResult(const LandmarkJoiner& joiner, const JoinedLandmarks& joined, std::size_t submaps) {
  if (joined.frames.size() != submaps + 1)
    throw PluginError(fmt::format("joiner {}: gave {} frames for {} submaps, expected one more",
                                  joiner.name(), joined.frames.size(), submaps));
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

JoinedLandmarks runJoiner(const LandmarkJoiner& joiner, const LandmarkSubmaps& submaps, Reporter& reporter,
                          bool& stopped) {
  const auto show = [&](double fraction) { reporter.progress("joining with " + joiner.name(), fraction); };
  const auto progress = [&](double fraction, const std::string&) {
    show(fraction);
    stopped = stopped || stopRequested();
    return !stopped;
  };
  show(0);
  JoinedLandmarks joined = joiner.join(submaps, progress);
  show(1);
  checkResult(joiner, joined, submaps.size());
  const std::string outcome =
      fmt::format("{}: {} ({}), objective {}, {} iterations", joiner.name(), toString(joined.status),
                  joined.reason, joined.objective, joined.iterations.size());
  if (joined.status == JoinStatus::kFailed) {
    reporter.warning(fmt::format("{}: the submaps could not be joined: {}; results are without any joining",
                                 joiner.name(), joined.reason));
  } else {
    reporter.log(outcome);
  }
  return joined;
}

void writeLandmarkResults(const OutputDirectory& out, const LandmarkSubmaps& submaps,
                          const JoinedLandmarks& joined) {
  writeLandmarkImage(out.file("map.png"), joined);
  writeLandmarkScene(out.file("map.3Dscene"), joined);
  writeLandmarks(out.file("landmarks.csv"), joined.landmarks);
  writeAssociations(out.file("association.csv"), joined.associations);
  writeTum(out.file("trajectory.tum"), endPoses(submaps, joined));
}

}  // namespace

RunSummary joinLandmarkFile(const std::string& submap_file, const std::string& folder, bool overwrite,
                            const Configuration& config, Reporter& reporter) {
  const StageTimer timer;
  RunSummary summary;
  const auto joiner = config.landmarkJoiner();
  const LandmarkSubmaps submaps = readLandmarkSubmaps(submap_file);
  const OutputDirectory out(folder, overwrite);
  addTimedStage(summary.metrics, "read", timer);

  const StageTimer join_timer;
  reporter.log(fmt::format("{} submaps", submaps.size()));
  const JoinedLandmarks joined = runJoiner(*joiner, submaps, reporter, summary.interrupted);
  addTime(summary.metrics, "join_", join_timer);
  addStage(summary.metrics, join_timer.record(joiner->name()));
  summary.failed = joined.status == JoinStatus::kFailed;
  addLandmarkMetrics(summary.metrics, submaps, joined);

  const StageTimer write_timer;
  writeLandmarkResults(out, submaps, joined);
  writeRunRecord(out, config, reporter.logLines());
  addTimedStage(summary.metrics, "write", write_timer);
  finishRun({submap_file, out, config, reporter, timer}, summary.metrics,
            [&](const RunRecord& record) { return runReport(submaps, joined, record); });
  return summary;
}

std::string landmarkSummary(const RunSummary& summary, const std::string& folder) {
  const Metrics& m = summary.metrics;
  return fmt::format(
      "{} submaps with {} features, {} landmarks\njoined: {} ({}), objective {:.6g}\n"
      "{:.1f} s, {:.1f} s CPU, {:.0f} MB\nmap: {}{}",
      m["submaps"].get<int>(), m["features"].get<int>(), m["landmarks"].get<int>(),
      m["join_status"].get<std::string>(), m["join_reason"].get<std::string>(), m["objective"].get<double>(),
      m["wall_s"].get<double>(), m["cpu_s"].get<double>(), m["peak_memory_mb"].get<double>(),
      (std::filesystem::path(folder) / "map.png").string(), reportLine(m, folder));
}

}  // namespace submap_slam
