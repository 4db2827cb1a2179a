// The steps of the local mapper, on the simulated room: time for each scan.
#include <benchmark/benchmark.h>
#include <submap_slam/mapping/rbpf_grid_mapper.h>
#include <submap_slam/mapping/stretch_splitter.h>
#include <submap_slam/simulation/simulate.h>

#include <vector>

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;

/** Half a minute in the room, the laser's points, and the map that they make at their true poses. */
struct Drive {
  SimulatedLog log;
  std::vector<LaserPoints> scans;
  std::vector<TPose2D> poses;  ///< in the frame of the first
  SurfelMap map{SurfelMapParams{}};

  Drive() {
    constexpr std::size_t kFrames = 150;
    const World world = roomWorld();
    Path path = drive(world.route, {}, 5);
    path.poses.resize(kFrames);
    log = simulate(world, path, {}, {}, 1);
    for (std::size_t i = 0; i < kFrames; ++i) {
      scans.push_back(toLaserPoints(log.frames[i], 1e9));
      poses.push_back(log.truth[i].pose - log.truth[0].pose);
      map.insert(scans.back(), poses.back());
    }
  }
};

const Drive& theDrive() {
  static const Drive drive;
  return drive;
}

/** A pose as wrong as odometry's prediction. */
TPose2D wrong(const TPose2D& pose) { return {pose.x + 0.03, pose.y - 0.02, pose.phi + 0.02}; }

void toPoints(benchmark::State& state) {
  const Drive& drive = theDrive();
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(toLaserPoints(drive.log.frames[i], 1e9));
    i = (i + 1) % drive.scans.size();
  }
}
BENCHMARK(toPoints)->Unit(benchmark::kMicrosecond);

void match(benchmark::State& state) {
  const Drive& drive = theDrive();
  const ScanMatcher matcher({}, SurfelMapParams{}.search_radius);
  std::size_t i = 0;
  for (auto _ : state) {
    const PosePrior prior{wrong(drive.poses[i]), motionInformation({}, {0.1, 0, 0})};
    benchmark::DoNotOptimize(matcher.match(drive.map, drive.scans[i], prior));
    i = (i + 1) % drive.scans.size();
  }
}
BENCHMARK(match)->Unit(benchmark::kMicrosecond);

void insert(benchmark::State& state) {
  const Drive& drive = theDrive();
  SurfelMap map{SurfelMapParams{}};
  std::size_t i = 0;
  for (auto _ : state) {
    map.insert(drive.scans[i], drive.poses[i]);
    i = (i + 1) % drive.scans.size();
  }
}
BENCHMARK(insert)->Unit(benchmark::kMicrosecond);

/** A copy and the first insertion into it: what a new hypothesis costs. */
void insertIntoCopy(benchmark::State& state) {
  const Drive& drive = theDrive();
  for (auto _ : state) {
    SurfelMap copy = drive.map;
    copy.insert(drive.scans.back(), drive.poses.back());
    benchmark::DoNotOptimize(copy);
  }
}
BENCHMARK(insertIntoCopy)->Unit(benchmark::kMicrosecond);

void search(benchmark::State& state) {
  const Drive& drive = theDrive();
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(correlativeSearch(drive.map, drive.scans[i], wrong(drive.poses[i]), {}));
    i = (i + 1) % drive.scans.size();
  }
}
BENCHMARK(search)->Unit(benchmark::kMicrosecond);

void render(benchmark::State& state) {
  const Drive& drive = theDrive();
  std::vector<PlacedScan> placed;
  for (std::size_t i = 0; i < drive.scans.size(); ++i) placed.push_back({&drive.scans[i], drive.poses[i]});
  for (auto _ : state) benchmark::DoNotOptimize(renderEvidence(placed, {}));
  state.counters["scan"] =
      benchmark::Counter(static_cast<double>(placed.size()),
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(render)->Unit(benchmark::kMillisecond);

/** The whole mapper. @param state range(0): particles of the classical filter, 0: adaptive */
void mapStretches(benchmark::State& state) {
  const Drive& drive = theDrive();
  GridMapperParams params;
  params.filter.fixed_particles = static_cast<int>(state.range(0));
  const RbpfGridMapper mapper(params, 1);
  for (auto _ : state) {
    StretchSplitter splitter({});
    for (const auto& frame : drive.log.frames)
      if (const auto stretch = splitter.push(frame)) benchmark::DoNotOptimize(mapper.map(*stretch));
    if (const auto stretch = splitter.finish()) benchmark::DoNotOptimize(mapper.map(*stretch));
  }
  state.counters["scan"] =
      benchmark::Counter(static_cast<double>(drive.log.frames.size()),
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(mapStretches)->Arg(0)->Arg(10)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace submap_slam
