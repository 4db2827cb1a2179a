#include <submap_slam/viewer/join_worker.h>

#include <algorithm>
#include <exception>
#include <stdexcept>
#include <utility>

namespace submap_slam {

/** Passes on what joiners tell. */
class JoinWorker::Listener : public Reporter {
 public:
  explicit Listener(JoinWorker& worker) : worker_(worker) {}

  void progress(const std::string& stage, double fraction, std::size_t, const std::string&) override {
    const std::lock_guard lock(worker_.mutex_);
    worker_.news_.stage = stage;
    worker_.news_.fraction = fraction;
  }
  bool stopRequested() const override { return worker_.stop_; }
  bool showsFrames() const override { return true; }
  void frames(const std::vector<mrpt::math::TPose2D>& frames) override {
    const std::lock_guard lock(worker_.mutex_);
    worker_.news_.frames = frames;
  }

 private:
  JoinWorker& worker_;
};

namespace {

/** The same start with the user's constraints of now in the place of those of before. */
JoinedMap withEdits(JoinedMap from, const std::vector<Constraint>& by_hand) {
  auto& constraints = from.constraints;
  constraints.erase(
      std::remove_if(constraints.begin(), constraints.end(), [](const Constraint& c) { return c.by_hand; }),
      constraints.end());
  constraints.insert(constraints.end(), by_hand.begin(), by_hand.end());
  from.map = PackedEvidence();
  return from;
}

}  // namespace

JoinWorker::~JoinWorker() {
  stop();
  if (thread_.joinable()) thread_.join();
}

void JoinWorker::start(JoinTask task) {
  start([this, given = std::move(task)] { run(given); });
}

void JoinWorker::start(LandmarkJoinTask task) {
  start([this, given = std::move(task)] { run(given); });
}

void JoinWorker::start(std::function<void()> work) {
  if (busy()) throw std::logic_error("the worker joins already");
  stop_ = done_ = false;
  news_ = {};
  thread_ = std::thread([this, todo = std::move(work)] {
    try {
      todo();
    } catch (const std::exception& error) {
      const std::lock_guard lock(mutex_);
      news_.error = error.what();
    }
    done_ = true;
  });
}

void JoinWorker::run(const JoinTask& task) {
  checkEdits(task.edits, task.submaps);
  const GridSubmaps shown = maskSubmaps(task.submaps, task.edits);
  const auto by_hand = constraintsOf(task.edits, task.submaps);
  Listener listener(*this);
  Joining joining(task.joiners, task.make_map);
  JoinOutcome outcome = task.from ? joining.joinAgain(shown, withEdits(*task.from, by_hand), listener)
                                  : joining.join(shown, listener, by_hand);
  const std::lock_guard lock(mutex_);
  news_.outcome = std::move(outcome);
  news_.log = listener.logLines();
}

void JoinWorker::run(const LandmarkJoinTask& task) {
  Listener listener(*this);
  const auto progress = [&](double fraction, const std::string& what) {
    listener.progress(what, fraction, 0, "");
    return !listener.stopRequested();
  };
  JoinedLandmarks joined = task.joiner->join(task.submaps, progress);
  const std::lock_guard lock(mutex_);
  news_.landmarks = std::move(joined);
}

JoinNews JoinWorker::takeNews() {
  if (done_ && thread_.joinable()) thread_.join();
  const std::lock_guard lock(mutex_);
  JoinNews taken = std::move(news_);
  news_ = {};
  const bool ended = taken.outcome || taken.landmarks || !taken.error.empty();
  if (busy() && !ended) {
    news_.stage = taken.stage;
    news_.fraction = taken.fraction;
  }
  return taken;
}

}  // namespace submap_slam
