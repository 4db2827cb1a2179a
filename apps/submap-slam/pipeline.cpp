#include "pipeline.h"

#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/mapping/grid_mapper.h>
#include <submap_slam/mapping/node_refinement.h>
#include <submap_slam/output/json_file.h>
#include <submap_slam/output/text_file.h>
#include <tbb/global_control.h>
#include <tbb/parallel_pipeline.h>

#include <algorithm>
#include <memory>

#include "edited_submaps.h"
#include "joining.h"
#include "map_updates.h"
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

/** Rounds of [node_refinement]: new submaps from better poses of their nodes, joined again. */
void refineNodesAndJoin(GridSubmaps& submaps, JoinOutcome& outcome, const Joining& joining,
                        const Configuration& config, SubmapStore& store, Reporter& reporter) {
  for (int round = 1; round <= config.node_refinement.rounds && !outcome.stopped; ++round) {
    reporter.progress(fmt::format("refining nodes, round {}", round), 0);
    RefinedSubmaps refined = refineNodes(submaps, outcome.map, config.mapper, config.node_refinement,
                                         [&](GridSubmap& submap) { store.takeOver(submap); });
    reporter.log(fmt::format("nodes refined, round {}: moved by {:.4f} m at the mean, {:.4f} m at most",
                             round, refined.mean_move, refined.max_move));
    submaps = std::move(refined.submaps);
    outcome = joining.joinAgain(submaps, std::move(refined.joined), reporter);
  }
}

/** Joins and writes everything but metrics.json. */
void joinAndWrite(const EditedSubmaps& submaps, Joining& joining, const OutputDirectory& out,
                  const Configuration& config, SubmapStore& store, Reporter& reporter, RunSummary& summary) {
  checkEdits(submaps.edits(), submaps.all());
  Metrics& metrics = summary.metrics;
  const StageTimer join_timer;
  reporter.log(fmt::format("{} submaps", submaps.all().size()));
  logEdits(submaps.edits(), joining.joiners(), reporter);
  GridSubmaps shown = submaps.shown();
  JoinOutcome outcome = joining.join(shown, reporter, submaps.byHand());
  refineNodesAndJoin(shown, outcome, joining, config, store, reporter);
  const JoinedMap& joined = outcome.map;
  requireObservations(joined.map);
  summary.interrupted = outcome.stopped;
  addJoinMetrics(metrics, submaps.all(), joined);
  addTime(metrics, "join_", join_timer);

  const StageTimer write_timer;
  writeResults(out, shown, joined);
  const auto progress = mappingProgress(shown, joined.frames);
  addProgressMetrics(metrics, progress);
  writeText(out.file("submaps.csv"), progressCsv(progress));
  writeRunRecord(out, config, reporter.logLines());
  addTime(metrics, "write_", write_timer);
}

}  // namespace

RunSummary mapRawlog(const std::string& log, const std::string& folder, bool overwrite,
                     const Configuration& config, Reporter& reporter, const Edits& edits) {
  const StageTimer timer;
  RunSummary summary;
  Joining joining(config.joinerChain(), config.joining.map_resolution);  // a wrong name is refused at once
  StretchSource source(log, config.reader, StretchSplitter(config.stretches, config.mapper));
  const OutputDirectory out = openFolder(folder, overwrite);

  SubmapLogWriter writer = openSubmapFile(out.file(kSubmapFile), log, config, overwrite, reporter);
  const bool goes_on = writer.state().submaps_done > 0;
  const auto mapper = makeGridMapper(config.mapper, config.seed);
  const auto store = makeStore(config, out);
  SubmapFollower follower(out.file(kSubmapFile), store);
  EditedSubmaps submaps(edits);
  MapUpdates updates(follower, submaps, joining, out, config.joining.update_growth, goes_on, reporter);
  StretchDone show;
  if (config.joining.incremental)
    show = [&](double fraction_read) { updates.update(writer.state().submaps_done, fraction_read); };
  summary.interrupted = !buildSubmaps(source, *mapper, writer, reporter, show);
  summary.submaps_in_map = updates.submapsInMap();
  addTime(summary.metrics, "build_", timer);
  reportLog(source, reporter);
  summary.damaged = !source.damage().empty();
  if (summary.interrupted) return summary;

  addLogMetrics(summary.metrics, source.report());
  submaps.add(follower.readNew());
  requireSubmaps(out.file(kSubmapFile));
  joinAndWrite(submaps, joining, out, config, *store, reporter, summary);
  addRunMetrics(summary.metrics, config.seed, reporter.warnings(), timer);
  writeJson(out.file(kMetricsFile), summary.metrics);
  return summary;
}

RunSummary buildRawlog(const std::string& log, const std::string& submap_file, bool overwrite,
                       const Configuration& config, Reporter& reporter) {
  const StageTimer timer;
  RunSummary summary;
  StretchSource source(log, config.reader, StretchSplitter(config.stretches, config.mapper));
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
  Joining joining(config.joinerChain(), config.joining.map_resolution);
  requireSubmaps(submap_file);  // before a folder is made for nothing
  const OutputDirectory out(folder, overwrite);
  const auto store = makeStore(config, out);
  const RecoveredSubmaps read = readUsableSubmaps(submap_file, store);
  EditedSubmaps submaps(edits);
  submaps.add(read.submaps);
  summary.damaged = !read.damage.empty();
  if (summary.damaged) reporter.warning(read.damage + "; the submaps before it are joined");
  joinAndWrite(submaps, joining, out, config, *store, reporter, summary);
  addRunMetrics(summary.metrics, config.seed, reporter.warnings(), timer);
  writeJson(out.file(kMetricsFile), summary.metrics);
  return summary;
}

bool buildSubmaps(StretchSource& source, const LocalMapper& mapper, SubmapLogWriter& writer,
                  Reporter& reporter, const StretchDone& on_disk) {
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
    if (on_disk) on_disk(job->fraction_read);
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

}  // namespace submap_slam
