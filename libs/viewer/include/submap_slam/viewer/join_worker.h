#pragma once

#include <mrpt/math/TPose2D.h>
#include <submap_slam/core/edits.h>
#include <submap_slam/pipeline/joining.h>

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace submap_slam {

/** What a joining needs. */
struct JoinTask {
  GridSubmaps submaps;
  Edits edits;
  JoinerChain joiners;  ///< nobody changes their parameters while the worker is busy
  MapMaker make_map;    ///< where no joiner makes the map

  /** Where one joiner begins; empty: all joiners run, from the chain of end poses. */
  std::optional<JoinedMap> from;
};

/** What a joining of landmark submaps needs. */
struct LandmarkJoinTask {
  LandmarkSubmaps submaps;
  std::shared_ptr<const LandmarkJoiner> joiner;  ///< nobody changes its parameters while the worker is busy
};

/** What became of it since it was last asked. */
struct JoinNews {
  std::string stage;                                       ///< what is being done; empty: nothing
  double fraction = 0;                                     ///< of the stage
  std::optional<std::vector<mrpt::math::TPose2D>> frames;  ///< the latest on the way, if they are new
  std::optional<JoinOutcome> outcome;                      ///< once, at the end
  std::optional<JoinedLandmarks> landmarks;                ///< the same of landmark submaps
  std::vector<std::string> log;                            ///< with the outcome: lines for log.txt
  std::string error;                                       ///< once, if it failed
};

/** Joins in a thread of its own. To be used from one thread. */
class JoinWorker {
 public:
  JoinWorker() = default;
  ~JoinWorker();  ///< stops and waits
  JoinWorker(const JoinWorker&) = delete;
  JoinWorker& operator=(const JoinWorker&) = delete;

  /** Throws std::logic_error if it is busy. */
  void start(JoinTask task);
  void start(LandmarkJoinTask task);

  /** From start() until takeNews() has handed over the outcome or the error. */
  bool busy() const { return thread_.joinable(); }

  /** Asks the joiner to end soon; the outcome is what it has by then. */
  void stop() { stop_ = true; }

  JoinNews takeNews();

 private:
  class Listener;
  void start(std::function<void()> work);
  void run(const JoinTask& task);
  void run(const LandmarkJoinTask& task);

  std::thread thread_;
  std::atomic<bool> stop_{false}, done_{false};
  std::mutex mutex_;  // of news_
  JoinNews news_;
};

}  // namespace submap_slam
