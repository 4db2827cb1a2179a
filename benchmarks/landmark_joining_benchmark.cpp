/** Time of joining landmark submaps by the number of submaps, for every method; and of one submap more in the
 * binary tree. */
#include <benchmark/benchmark.h>

#include <numeric>

#include "eif_tree/joining.h"
#include "eif_tree/known_association.h"
#include "landmark_world.h"

namespace {

using namespace submap_slam;
using namespace submap_slam::landmark_joining;

/** One round past 2 landmarks a submap, each seen by three submaps. */
LandmarkSubmaps world(int64_t submaps) {
  submap_slam::testing::LandmarkWorldOptions options;
  options.submaps = static_cast<int>(submaps);
  options.radius_m = 1.7 * static_cast<double>(submaps);
  return submap_slam::testing::simulateLandmarks(options);
}

void join(benchmark::State& state, Method method) {
  const AssociatedProblem associated = associateByIds(world(state.range(0)));
  JoiningOptions options;
  options.method = method;
  for (auto _ : state) benchmark::DoNotOptimize(joinBy(options, associated.problem, {}));
  state.SetComplexityN(state.range(0));
}

/** The last of so many submaps, where the tree of the others is there. */
void oneSubmapMore(benchmark::State& state) {
  const LandmarkSubmaps all = world(state.range(0));
  const AssociatedProblem whole = associateByIds(all), before = associateByIds({all.begin(), all.end() - 1});
  JoiningOptions options;
  JoiningTree tree = treeFor(options);
  tree.join(before.problem, before.landmark_ids, {});
  for (auto _ : state) {
    JoiningTree copy = tree;
    benchmark::DoNotOptimize(copy.join(whole.problem, whole.landmark_ids, {}));
  }
  state.SetComplexityN(state.range(0));
}

BENCHMARK_CAPTURE(join, tree_gn, Method::kTreeThenGaussNewton)
    ->RangeMultiplier(4)
    ->Range(16, 1024)
    ->Unit(benchmark::kMillisecond)
    ->Complexity();
BENCHMARK_CAPTURE(join, sequential_iterated, Method::kSequentialIterated)
    ->RangeMultiplier(4)
    ->Range(16, 256)
    ->Unit(benchmark::kMillisecond)
    ->Complexity();
BENCHMARK_CAPTURE(join, ekf, Method::kDenseFilter)
    ->RangeMultiplier(4)
    ->Range(16, 256)
    ->Unit(benchmark::kMillisecond)
    ->Complexity();
BENCHMARK(oneSubmapMore)->RangeMultiplier(4)->Range(16, 1024)->Unit(benchmark::kMillisecond)->Complexity();

}  // namespace
