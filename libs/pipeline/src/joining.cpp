#include <submap_slam/pipeline/joining.h>

#include <fmt/format.h>
#include <malloc.h>
#include <submap_slam/core/doubtful_ends.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/mapping/map_from_scans.h>
#include <submap_slam/pipeline/stage_timer.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace submap_slam {
namespace {

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

void reportResult(const SubmapJoiner& joiner, const JoinedMap& joined, Reporter& reporter) {
  const std::string outcome =
      fmt::format("{}: {} ({}), objective {}, {} iterations", joiner.name(), toString(joined.status),
                  joined.reason, joined.objective, joined.iterations.size());
  if (joined.status == JoinStatus::kFailed) {
    reporter.warning(outcome);
  } else {
    reporter.log(outcome);
  }
}

/** Runs a joiner from where the one before it came to, and gives the memory back that it leaves free. */
void run(const SubmapJoiner& joiner, IncrementalJoin& at_work, const GridSubmaps& submaps,
         JoinOutcome& result, Reporter& reporter) {
  const StageTimer timer;
  const auto show = [&](double fraction) { reporter.progress("joining with " + joiner.name(), fraction); };
  const auto step = [&](double fraction, const std::string&) {
    show(fraction);
    if (reporter.stopRequested()) result.stopped = true;
    return !result.stopped;
  };
  ProgressCallback progress(step);
  if (reporter.showsFrames()) progress = {step, [&reporter](const auto& frames) { reporter.frames(frames); }};
  show(0);
  result.map = at_work.join(submaps, result.map, progress);
  show(1);
  checkResult(joiner, result.map, submaps);
  reportResult(joiner, result.map, reporter);
  malloc_trim(0);
  result.stages.push_back(timer.record(joiner.name()));
}

/** Makes the map that a joiner left over, and gives the memory back that this leaves free. */
void fuse(const GridSubmaps& submaps, const MapMaker& make_map, JoinOutcome& result, Reporter& reporter) {
  const StageTimer timer;
  JoinedMap& joined = result.map;
  if (joined.map.observedCells() == 0) joined.map = make_map(submaps, joined, reporter);
  malloc_trim(0);
  result.stages.push_back(timer.record("fuse"));
}

}  // namespace

MapMaker mapMaker(const Configuration& config) {
  return [from_scans = config.joining.map == "scans", resolution = config.joining.map_resolution,
          mapper = config.mapper](const GridSubmaps& submaps, const JoinedMap& joined, Reporter& reporter) {
    if (from_scans) {
      if (auto map = mapFromScans(submaps, joined, mapper, resolution)) return std::move(*map);
      reporter.log(
          "map fused from the submaps' evidence: they keep no scans, or were made with other parameters of "
          "the beams");
    }
    return fuseEvidence(submaps, joined.frames, resolution);
  };
}

Joining::Joining(JoinerChain joiners, MapMaker make_map)
    : joiners_(std::move(joiners)), make_map_(std::move(make_map)) {
  begin();
}

void Joining::begin() {
  at_work_.clear();
  for (const auto& joiner : joiners_) at_work_.push_back(joiner->incremental());
}

JoinOutcome Joining::join(const GridSubmaps& submaps, Reporter& reporter,
                          const std::vector<Constraint>& by_hand) {
  try {
    return goOn(submaps, reporter, by_hand);
  } catch (...) {
    begin();
    throw;
  }
}

JoinOutcome Joining::goOn(const GridSubmaps& submaps, Reporter& reporter,
                          const std::vector<Constraint>& by_hand) {
  JoinOutcome result{chainSubmaps(submaps), false, {}};
  auto& constraints = result.map.constraints;
  constraints.insert(constraints.end(), by_hand.begin(), by_hand.end());
  for (std::size_t k = 0; k < joiners_.size(); ++k)
    run(*joiners_[k], *at_work_[k], submaps, result, reporter);
  if (const auto breaks = describeBreaks(submaps, result.map.constraints); !breaks.empty())
    reporter.warning(breaks);
  fuse(submaps, make_map_, result, reporter);
  return result;
}

JoinOutcome Joining::joinAgain(const GridSubmaps& submaps, JoinedMap initial, Reporter& reporter) const {
  JoinOutcome result{std::move(initial), false, {}};
  if (!joiners_.empty()) run(*joiners_.back(), *joiners_.back()->incremental(), submaps, result, reporter);
  fuse(submaps, make_map_, result, reporter);
  return result;
}

}  // namespace submap_slam
