/** From submaps to one map. */
#pragma once

#include <submap_slam/core/joined_map.h>
#include <submap_slam/pipeline/configuration.h>
#include <submap_slam/pipeline/reporter.h>
#include <submap_slam/pipeline/stage_timer.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace submap_slam {

/** Makes the global map of joined submaps. */
using MapMaker = std::function<PackedEvidence(const GridSubmaps&, const JoinedMap&, Reporter&)>;

/** The one that [joining] map and map_resolution ask for; keeps a copy of what it needs. */
MapMaker mapMaker(const Configuration& config);

/** What joiners made of submaps. */
struct JoinOutcome {
  JoinedMap map;
  bool stopped = false;             ///< a stop signal ended a joiner early
  std::vector<StageRecord> stages;  ///< each joiner, and last "fuse", making the map if that was left over
};

/** The joiners of [joining] chain at work. They may be called again when there are more submaps, and then
 * need not find again what they know; the result is the same, to the bit. */
class Joining {
 public:
  /** @param make_map where no joiner made the map */
  Joining(JoinerChain joiners, MapMaker make_map);

  /** Runs the joiners one after the other, from the chain of end poses, and makes the global map. Throws as
   * they do, and PluginError for results of the wrong form; the next call then begins anew.
   * @param submaps the same objects as in the call before, and any number behind them
   * @param by_hand constraints from the user, which the joiners get with those of the chain */
  JoinOutcome join(const GridSubmaps& submaps, Reporter& reporter,
                   const std::vector<Constraint>& by_hand = {});

  /** The next call of join() begins anew: to be called when submaps were changed. */
  void begin();

  /** Runs the last joiner on other submaps of the same number, from `initial`, and makes the global map. */
  JoinOutcome joinAgain(const GridSubmaps& submaps, JoinedMap initial, Reporter& reporter) const;

  const JoinerChain& joiners() const { return joiners_; }

 private:
  JoinOutcome goOn(const GridSubmaps& submaps, Reporter& reporter, const std::vector<Constraint>& by_hand);

  JoinerChain joiners_;
  std::vector<std::unique_ptr<IncrementalJoin>> at_work_;  // one for each joiner
  MapMaker make_map_;
};

}  // namespace submap_slam
