#include <submap_slam/pipeline/pipeline.h>

#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/mapping/node_refinement.h>
#include <submap_slam/output/text_file.h>
#include <submap_slam/pipeline/edited_submaps.h>
#include <submap_slam/pipeline/finish_run.h>
#include <submap_slam/pipeline/joining.h>
#include <submap_slam/pipeline/landmark_pipeline.h>
#include <submap_slam/pipeline/map_forms.h>
#include <submap_slam/pipeline/map_updates.h>
#include <submap_slam/pipeline/metrics.h>
#include <submap_slam/pipeline/results.h>
#include <submap_slam/pipeline/run_files.h>
#include <submap_slam/pipeline/stage_timer.h>
#include <submap_slam/pipeline/submap_budget.h>
#include <submap_slam/pipeline/submap_building.h>
#include <submap_slam/rawlog/landmark_log.h>
#include <submap_slam/report/run_report.h>

#include <algorithm>
#include <memory>
#include <optional>

namespace submap_slam {
namespace {

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
void requireObservations(const PackedEvidence& map) {
  if (map.observedCells() == 0)
    throw InputError(
        "the map would be empty: no scan has a valid beam between [reader] min_range and [mapper] max_range");
}

void requireFeatures(const LandmarkSubmaps& submaps) {
  if (std::all_of(submaps.begin(), submaps.end(),
                  [](const auto& submap) { return submap->features.empty(); }))
    throw InputError(
        "the map would be empty: no landmark was measured as often as [landmark_mapper] min_hits asks for");
}

std::shared_ptr<SubmapStore> makeStore(const Configuration& config, const OutputDirectory& out) {
  return SubmapStore::create(submapBudget(config.joining.memory), out.file(kSpillFile));
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
    const StageTimer timer;
    reporter.progress(fmt::format("refining nodes, round {}", round), 0);
    RefinedSubmaps refined = refineNodes(submaps, outcome.map, config.mapper, config.node_refinement,
                                         [&](GridSubmap& submap) { store.takeOver(submap); });
    reporter.log(fmt::format("nodes refined, round {}: moved by {:.4f} m at the mean, {:.4f} m at most",
                             round, refined.mean_move, refined.max_move));
    submaps = std::move(refined.submaps);
    std::vector<StageRecord> stages = std::move(outcome.stages);
    stages.push_back(timer.record("refine nodes"));
    outcome = joining.joinAgain(submaps, std::move(refined.joined), reporter);
    outcome.stages.insert(outcome.stages.begin(), stages.begin(), stages.end());
  }
}

/** Joins and writes everything but what finishRun writes. */
FinishedMap joinAndWrite(const Run& run, const EditedSubmaps& submaps, Joining& joining, SubmapStore& store,
                         RunSummary& summary) {
  const auto& [input, out, config, reporter, run_timer] = run;
  checkEdits(submaps.edits(), submaps.all());
  Metrics& metrics = summary.metrics;
  const StageTimer join_timer;
  reporter.log(fmt::format("{} submaps", submaps.all().size()));
  logEdits(submaps.edits(), joining.joiners(), reporter);
  GridSubmaps shown = submaps.shown();
  JoinOutcome outcome = joining.join(shown, reporter, submaps.byHand());
  refineNodesAndJoin(shown, outcome, joining, config, store, reporter);
  JoinedMap& joined = outcome.map;
  requireObservations(joined.map);
  summary.interrupted = outcome.stopped;
  addJoinMetrics(metrics, submaps.all(), joined);
  addTime(metrics, "join_", join_timer);
  for (const StageRecord& stage : outcome.stages) addStage(metrics, stage);

  const StageTimer write_timer;
  const auto progress = writeJoined(out, shown, joined, metrics);
  addTimedStage(metrics, "write", write_timer);
  Trajectory path = trajectoryOf(shown, joined);
  summary.joined = std::make_shared<const JoinedMap>(std::move(joined));
  return {std::move(path), [shown, progress, map = summary.joined](const RunRecord& record) {
            return runReport(shown, *map, progress, record);
          }};
}

/** The grids of a run that maps a log: joined while they are built, if the user wants that, and in the end.
 */
class GridHalf {
 public:
  GridHalf(const Run& run, Joining& joining, const Edits& edits, bool goes_on)
      : run_(run),
        joining_(joining),
        store_(makeStore(run.config, run.out)),
        follower_(run.out.file(kSubmapFile), store_),
        submaps_(edits),
        updates_(follower_, submaps_, joining, run.out, run.config.joining.update_growth, goes_on,
                 run.reporter) {}

  MapUpdates& updates() { return updates_; }

  /** @param ends T_s_end of all submaps, if they are known better than by the submaps themselves */
  FinishedMap finish(RunSummary& summary, const std::vector<mrpt::poses::CPose2D>& ends) {
    submaps_.add(follower_.readNew());
    requireSubmaps(run_.out.file(kSubmapFile));
    if (!ends.empty()) setEnds(ends);
    return joinAndWrite(run_, submaps_, joining_, *store_, summary);
  }

 private:
  void setEnds(const std::vector<mrpt::poses::CPose2D>& ends) {
    for (const auto* submaps : {&submaps_.all(), &submaps_.shown()})
      for (const auto& submap : *submaps)
        if (submap->has_successor) submap->end_pose.mean = ends.at(submap->id);
    joining_.begin();
  }

  const Run& run_;
  Joining& joining_;
  std::shared_ptr<SubmapStore> store_;
  SubmapFollower follower_;
  EditedSubmaps submaps_;
  MapUpdates updates_;
};

void refuseEdits(const Edits& edits, const MapForms& forms) {
  if (!forms.grids && !edits.list.empty())
    throw ConfigError("--edits: is for grid submaps; the log is mapped as landmarks");
}

}  // namespace

std::vector<SubmapProgress> writeJoined(const OutputDirectory& out, const GridSubmaps& submaps,
                                        const JoinedMap& joined, Metrics& metrics) {
  auto progress = mappingProgress(submaps, joined.frames);
  addProgressMetrics(metrics, progress);
  writeText(out.file("submaps.csv"), progressCsv(progress));
  writeResults(out, submaps, joined);
  return progress;
}

RunSummary mapRawlog(const std::string& log, const std::string& folder, bool overwrite,
                     const Configuration& config, Reporter& reporter, const Edits& edits) {
  const StageTimer timer;
  RunSummary summary;
  const MapForms forms = mapForms(log, config);
  refuseEdits(edits, forms);
  Joining joining(config.joinerChain(), mapMaker(config));  // a wrong name is refused at once
  const auto landmark_joiner = forms.landmarks ? config.landmarkJoiner() : nullptr;
  StretchSource source(log, readerParams(config, forms),
                       StretchSplitter(stretchParams(config, forms), config.mapper),
                       detectorParams(config, forms));
  const OutputDirectory out = openFolder(folder, overwrite);
  const Run run{log, out, config, reporter, timer};

  SubmapFiles files = openSubmapFiles(out, forms, log, config, overwrite, reporter);
  const bool goes_on = files.submapsDone() > 0;
  std::optional<GridHalf> grids;
  if (forms.grids) grids.emplace(run, joining, edits, goes_on);
  std::optional<LandmarkHalf> landmarks;
  if (forms.landmarks)
    landmarks.emplace(*landmark_joiner, out, forms.grids, config.joining.update_growth, reporter);
  StretchDone show;
  if (config.joining.incremental)
    show = [&](double fraction_read) {
      if (grids)
        grids->updates().update(files.submapsDone(), fraction_read);
      else
        landmarks->update(files.submapsDone(), fraction_read);
    };
  summary.interrupted = !buildSubmaps(source, StretchMapper(config, forms), files, reporter, show);
  summary.submaps_in_map = grids ? grids->updates().submapsInMap() : landmarks->submapsInMap();
  addTimedStage(summary.metrics, "build", timer);
  reportLog(source, reporter);
  summary.damaged = !source.damage().empty();
  if (summary.interrupted) return summary;

  addLogMetrics(summary.metrics, source.report());
  FinishedMap map;
  std::vector<mrpt::poses::CPose2D> ends;
  if (landmarks) {
    const LandmarkSubmaps submaps = readLandmarkSubmaps(out.file(kLandmarkFile));
    requireFeatures(submaps);
    map = landmarks->finish(submaps, summary);
    ends = landmarks->ends();
  }
  if (grids && !summary.interrupted) {
    FinishedMap of_grids = grids->finish(summary, ends);
    if (landmarks) comparePaths(of_grids.path, map.path, summary.metrics, reporter);
    map = std::move(of_grids);
  }
  finishRun(run, summary.metrics, map.report);
  return summary;
}

RunSummary buildRawlog(const std::string& log, const std::string& submap_file, bool overwrite,
                       const Configuration& config, Reporter& reporter) {
  const StageTimer timer;
  RunSummary summary;
  const MapForms forms = mapForms(log, config);
  StretchSource source(log, readerParams(config, forms),
                       StretchSplitter(stretchParams(config, forms), config.mapper),
                       detectorParams(config, forms));
  if (!overwrite) refuseFinished(submap_file);
  SubmapFiles files = openSubmapFiles(submap_file, forms, log, config, overwrite, reporter);
  summary.interrupted = !buildSubmaps(source, StretchMapper(config, forms), files, reporter);
  reportLog(source, reporter);
  summary.damaged = !source.damage().empty();
  addLogMetrics(summary.metrics, source.report());
  summary.metrics["submaps"] = files.submapsDone();
  addRunMetrics(summary.metrics, config.seed, reporter.warnings(), timer);
  return summary;
}

RunSummary joinFile(const std::string& submap_file, const std::string& folder, bool overwrite,
                    const Configuration& config, Reporter& reporter, const Edits& edits) {
  const StageTimer timer;
  RunSummary summary;
  Joining joining(config.joinerChain(), mapMaker(config));
  requireSubmaps(submap_file);  // before a folder is made for nothing
  const OutputDirectory out(folder, overwrite);
  const auto store = makeStore(config, out);
  const RecoveredSubmaps read = readUsableSubmaps(submap_file, store);
  EditedSubmaps submaps(edits);
  submaps.add(read.submaps);
  summary.damaged = !read.damage.empty();
  if (summary.damaged) reporter.warning(read.damage + kRestIsJoined);
  const Run run{submap_file, out, config, reporter, timer};
  const FinishedMap map = joinAndWrite(run, submaps, joining, *store, summary);
  finishRun(run, summary.metrics, map.report);
  return summary;
}

}  // namespace submap_slam
