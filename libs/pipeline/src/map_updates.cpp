#include <submap_slam/pipeline/map_updates.h>

#include <fmt/format.h>
#include <submap_slam/output/replace_file.h>
#include <submap_slam/output/text_file.h>
#include <submap_slam/pipeline/metrics.h>
#include <submap_slam/pipeline/results.h>
#include <submap_slam/pipeline/stage_timer.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <exception>
#include <fstream>
#include <iterator>
#include <numeric>

namespace submap_slam {
namespace {

/** What joiners say of a part of the map is not for the log of the run; its warnings are shown all the same.
 */
class OnTheWay : public Reporter {
 public:
  explicit OnTheWay(Reporter& of_run) : of_run_(of_run) {}
  bool stopRequested() const override { return of_run_.stopRequested(); }
  void showWarning(const std::string& line) override { of_run_.showWarning(line); }

 private:
  Reporter& of_run_;
};

/** Times are of the wall clock. */
std::string headOf(const JoinerChain& joiners) {
  std::string head = "submaps,nodes,constraints_accepted,constraints_rejected,objective,status,read_s";
  for (const auto& joiner : joiners) head += fmt::format(",{}_s", joiner->name());
  return head + ",fuse_s,write_s,update_s\n";
}

std::string contentOf(const std::string& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::size_t nodesOf(const GridSubmaps& submaps) {
  return std::accumulate(submaps.begin(), submaps.end(), std::size_t{0},
                         [](std::size_t sum, const auto& submap) { return sum + submap->nodes.size(); });
}

}  // namespace

MapUpdates::MapUpdates(SubmapFollower& follower, EditedSubmaps& submaps, Joining& joining,
                       const OutputDirectory& out, double growth, bool goes_on, Reporter& reporter)
    : follower_(follower),
      submaps_(submaps),
      joining_(joining),
      out_(out),
      schedule_(growth),
      reporter_(reporter),
      table_(headOf(joining.joiners())) {
  const std::string before = goes_on ? contentOf(out.file(kUpdatesFile)) : "";
  if (before.compare(0, table_.size(), table_) == 0) table_ = before;
}

void MapUpdates::update(std::size_t submaps_in_file, double fraction) {
  if (!schedule_.take(submaps_in_file)) return;
  const StageTimer timer;
  submaps_.add(follower_.readNew());
  const double read_s = timer.elapsed().wall_s;
  std::optional<JoinOutcome> outcome;
  // Else a thread that waits for a joiner might begin to build a submap meanwhile.
  tbb::this_task_arena::isolate([&] { outcome = join(); });
  if (!outcome || outcome->stopped) return;

  const JoinedMap& joined = outcome->map;
  if (joined.map.observedCells() == 0) {
    reporter_.note(fmt::format("{} submaps show nothing yet", schedule_.last()));
    return;
  }
  const StageTimer write_timer;
  writeMapSoFar(out_, submaps_.shown(), joined);
  in_map_ = schedule_.last();
  list(*outcome, read_s, write_timer.elapsed().wall_s);
  reporter_.note(fmt::format("map of {} submaps ({:.0f} % of the log): {}, in {:.2f} s", schedule_.last(),
                             100 * fraction, toString(joined.status), timer.elapsed().wall_s));
}

std::optional<JoinOutcome> MapUpdates::join() {
  OnTheWay unheard(reporter_);
  try {
    return joining_.join(submaps_.shown(), unheard, submaps_.byHand());
  } catch (const std::exception& error) {
    reporter_.warning(fmt::format("no map of the first {} submaps: {}", schedule_.last(), error.what()));
    return std::nullopt;
  }
}

void MapUpdates::list(const JoinOutcome& outcome, double read_s, double write_s) {
  const JoinedMap& joined = outcome.map;
  const LoopCount loops = countLoops(joined.constraints);
  table_ += fmt::format("{},{},{},{},{},{},{:.3f}", submaps_.all().size(), nodesOf(submaps_.all()),
                        loops.accepted, loops.rejected, joined.objective, toString(joined.status), read_s);
  double sum_s = read_s + write_s;
  for (const StageRecord& stage : outcome.stages) {
    table_ += fmt::format(",{:.3f}", stage.time.wall_s);
    sum_s += stage.time.wall_s;
  }
  table_ += fmt::format(",{:.3f},{:.3f}\n", write_s, sum_s);
  replaceFile(out_.file(kUpdatesFile), [this](const std::string& file) { writeText(file, table_); });
}

}  // namespace submap_slam
