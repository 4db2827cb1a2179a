#include "pipeline.h"

#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/mapping/grid_mapper.h>
#include <submap_slam/output/json_file.h>
#include <submap_slam/output/text_file.h>
#include <tbb/global_control.h>
#include <tbb/parallel_pipeline.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "metrics.h"
#include "results.h"
#include "run_files.h"
#include "stage_timer.h"
#include "stop_signal.h"

namespace submap_slam {
namespace {

/** A stretch on its way through the stages. */
struct Job {
  Stretch stretch;
  GridSubmaps submaps;
  double fraction_read = 0;
  bool built = false;
};
using JobPtr = std::shared_ptr<Job>;

void reportLog(const StretchSource& source, Reporter& reporter) {
  const LogReport& report = source.report();
  reporter.log(fmt::format("log: {} frames, {:.1f} s, {:.1f} m by odometry", report.frames,
                           report.duration_s(), report.path_length_m));
  for (const auto& finding : report.findings) {
    if (finding.severity == Severity::kInfo) {
      reporter.log(finding.text);
    } else {
      reporter.warning(finding.text);
    }
  }
}

/** A map of nothing looks like a result; better to say why. */
void requireObservations(const EvidenceGrid& map) {
  if (map.observedCells() == 0)
    throw InputError(
        "the map would be empty: no scan has a valid beam between [reader] min_range and [mapper] max_range");
}

std::shared_ptr<SubmapStore> makeStore(const Configuration& config, const OutputDirectory& out) {
  return SubmapStore::create(bytesForSubmaps(config.joining), out.file(kSpillFile));
}

void logEdits(const Edits& edits, const JoinerChain& joiners, Reporter& reporter) {
  for (const Edit& edit : edits.list) reporter.log("by hand: " + edit.text);
  const auto onlyMasks = [](const Edit& edit) { return edit.kind == Edit::Kind::kMask; };
  if (joiners.empty() && !std::all_of(edits.list.begin(), edits.list.end(), onlyMasks))
    reporter.warning(edits.file + ": only masks count, [joining] chain names no joiner");
}

/** Joins and writes everything but metrics.json. */
void joinAndWrite(const GridSubmaps& submaps, const Edits& edits, const JoinerChain& joiners,
                  const OutputDirectory& out, const Configuration& config, Reporter& reporter,
                  RunSummary& summary) {
  Metrics& metrics = summary.metrics;
  const StageTimer join_timer;
  reporter.log(fmt::format("{} submaps", submaps.size()));
  logEdits(edits, joiners, reporter);
  const GridSubmaps shown = maskSubmaps(submaps, edits);
  const auto [joined, stopped] =
      joinSubmaps(shown, joiners, config.joining.map_resolution, reporter, constraintsOf(edits, submaps));
  requireObservations(joined.map);
  summary.interrupted = stopped;
  addJoinMetrics(metrics, submaps, joined);
  addTime(metrics, "join_", join_timer);

  const StageTimer write_timer;
  writeResults(out, shown, joined);
  const auto progress = mappingProgress(shown, joined.frames);
  addProgressMetrics(metrics, progress);
  writeText(out.file("submaps.csv"), progressCsv(progress));
  writeRunRecord(out, config, reporter.logLines());
  addTime(metrics, "write_", write_timer);
}

void checkResult(const SubmapJoiner& joiner, const JoinedMap& joined, const GridSubmaps& submaps) {
  if (joined.frames.size() != submaps.size())
    throw PluginError(fmt::format("joiner {}: gave {} frames for {} submaps", joiner.name(),
                                  joined.frames.size(), submaps.size()));
  const auto hasItsNodes = [](const auto& poses, const auto& submap) {
    return poses.size() == submap->nodes.size();
  };
  if (!joined.nodes.empty() &&
      !std::equal(joined.nodes.begin(), joined.nodes.end(), submaps.begin(), submaps.end(), hasItsNodes))
    throw PluginError(fmt::format("joiner {}: gave other nodes than the submaps have", joiner.name()));
  for (const auto& frame : joined.frames) {
    if (!std::isfinite(frame.mean.x()) || !std::isfinite(frame.mean.y()) || !std::isfinite(frame.mean.phi()))
      throw PluginError(fmt::format("joiner {}: gave a frame that is not finite", joiner.name()));
  }
}

}  // namespace

RunSummary mapRawlog(const std::string& log, const std::string& folder, bool overwrite,
                     const Configuration& config, Reporter& reporter, const Edits& edits) {
  const StageTimer timer;
  RunSummary summary;
  const JoinerChain joiners = config.joinerChain();  // a wrong name is refused before hours of mapping
  StretchSource source(log, config.reader, config.stretches);
  const OutputDirectory out = openFolder(folder, overwrite);

  SubmapLogWriter writer = openSubmapFile(out.file(kSubmapFile), log, config, overwrite, reporter);
  const auto mapper = makeGridMapper(config.mapper, config.seed);
  summary.interrupted = !buildSubmaps(source, *mapper, writer, reporter);
  addTime(summary.metrics, "build_", timer);
  reportLog(source, reporter);
  summary.damaged = !source.damage().empty();
  if (summary.interrupted) return summary;

  addLogMetrics(summary.metrics, source.report());
  const GridSubmaps submaps = readSubmaps(out.file(kSubmapFile), makeStore(config, out));
  checkEdits(edits, submaps);
  joinAndWrite(submaps, edits, joiners, out, config, reporter, summary);
  addRunMetrics(summary.metrics, config.seed, reporter.warnings(), timer);
  writeJson(out.file(kMetricsFile), summary.metrics);
  return summary;
}

RunSummary buildRawlog(const std::string& log, const std::string& submap_file, bool overwrite,
                       const Configuration& config, Reporter& reporter) {
  const StageTimer timer;
  RunSummary summary;
  StretchSource source(log, config.reader, config.stretches);
  if (!overwrite) refuseFinished(submap_file);
  SubmapLogWriter writer = openSubmapFile(submap_file, log, config, overwrite, reporter);
  const auto mapper = makeGridMapper(config.mapper, config.seed);
  summary.interrupted = !buildSubmaps(source, *mapper, writer, reporter);
  reportLog(source, reporter);
  summary.damaged = !source.damage().empty();
  addLogMetrics(summary.metrics, source.report());
  summary.metrics["submaps"] = writer.state().submaps_done;
  addRunMetrics(summary.metrics, config.seed, reporter.warnings(), timer);
  return summary;
}

RunSummary joinFile(const std::string& submap_file, const std::string& folder, bool overwrite,
                    const Configuration& config, Reporter& reporter, const Edits& edits) {
  const StageTimer timer;
  RunSummary summary;
  const JoinerChain joiners = config.joinerChain();
  requireSubmaps(submap_file);  // before a folder is made for nothing
  const OutputDirectory out(folder, overwrite);
  const RecoveredSubmaps read = readUsableSubmaps(submap_file, makeStore(config, out));
  checkEdits(edits, read.submaps);
  summary.damaged = !read.damage.empty();
  if (summary.damaged) reporter.warning(read.damage + "; the submaps before it are joined");
  joinAndWrite(read.submaps, edits, joiners, out, config, reporter, summary);
  addRunMetrics(summary.metrics, config.seed, reporter.warnings(), timer);
  writeJson(out.file(kMetricsFile), summary.metrics);
  return summary;
}

bool buildSubmaps(StretchSource& source, const LocalMapper& mapper, SubmapLogWriter& writer,
                  Reporter& reporter) {
  using tbb::filter_mode;
  const uint64_t built_before = writer.state().stretches_done;
  bool read_all = false, left_out = false;
  std::size_t frames_built = 0;

  const auto read = [&](tbb::flow_control& flow) -> JobPtr {
    while (!stopRequested()) {
      auto stretch = source.next();
      read_all = !stretch;
      if (read_all) break;
      if (stretch->index < built_before) continue;  // an earlier run did it
      return std::make_shared<Job>(Job{std::move(*stretch), {}, source.fractionRead(), false});
    }
    flow.stop();
    return nullptr;
  };
  const auto build = [&](const JobPtr& job) {
    if (stopRequested()) return job;
    job->submaps = mapper.map(job->stretch);
    job->built = true;
    return job;
  };
  const auto write = [&](const JobPtr& job) {
    left_out = left_out || !job->built;
    if (left_out) return;  // also what comes behind it, so that the file has no gap
    auto id = static_cast<uint32_t>(writer.state().submaps_done);
    for (const auto& submap : job->submaps) submap->id = id++;
    writer.appendStretch(job->submaps);
    frames_built += job->stretch.ownFrames();
    reporter.progress("building submaps", job->fraction_read, frames_built, "scans");
  };

  reporter.progress("building submaps", 0);
  const std::size_t threads = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  const std::size_t in_flight = threads + 2;  // one being read, one being written
  tbb::parallel_pipeline(in_flight, tbb::make_filter<void, JobPtr>(filter_mode::serial_in_order, read) &
                                        tbb::make_filter<JobPtr, JobPtr>(filter_mode::parallel, build) &
                                        tbb::make_filter<JobPtr, void>(filter_mode::serial_in_order, write));
  const bool complete = read_all && !left_out;
  if (complete) writer.finish();
  return complete;
}

JoinOutcome joinSubmaps(const GridSubmaps& submaps, const JoinerChain& joiners, double map_resolution,
                        Reporter& reporter, const std::vector<Constraint>& by_hand) {
  JoinOutcome result{chainSubmaps(submaps)};
  JoinedMap& joined = result.map;
  joined.constraints.insert(joined.constraints.end(), by_hand.begin(), by_hand.end());
  for (const auto& joiner : joiners) {
    const auto show = [&](double fraction) { reporter.progress("joining with " + joiner->name(), fraction); };
    const auto progress = [&](double fraction, const std::string&) {
      show(fraction);
      if (stopRequested()) result.stopped = true;
      return !result.stopped;
    };
    show(0);
    joined = joiner->join(submaps, joined, progress);
    show(1);
    checkResult(*joiner, joined, submaps);
    const std::string outcome =
        fmt::format("{}: {} ({}), objective {}, {} iterations", joiner->name(), toString(joined.status),
                    joined.reason, joined.objective, joined.iterations.size());
    if (joined.status == JoinStatus::kFailed) {
      reporter.warning(outcome);
    } else {
      reporter.log(outcome);
    }
  }
  if (joined.map.observedCells() == 0) joined.map = fuseEvidence(submaps, joined.frames, map_resolution);
  return result;
}

}  // namespace submap_slam
