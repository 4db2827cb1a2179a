/** One Gauss-Newton iteration of grid submap joining in its three forms, on the same eight overlapping
 * submaps (0.05 m cells, one room), on one thread. Items are overlap observations: (cell, submap) pairs of
 * cells that two or more submaps see. */
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <cmath>

#include "grid_gauss_newton/full_gauss_newton.h"
#include "grid_gauss_newton/reduced_system.h"
#include "synthetic_submaps.h"

namespace {

using namespace submap_slam;
using namespace submap_slam::grid_joining;

constexpr double kAngle = 0.41;

struct EightSubmaps {
  EvidenceLevels level;  ///< as published
  EvidenceLevels above;  ///< without the background, as the joiner has it
  Frames frames;
  std::vector<bool> held;
  std::size_t observations = 0;

  EightSubmaps() {
    GridSubmaps submaps;
    for (uint32_t i = 0; i < 8; ++i) {
      const double turn = M_PI / 4 * i;
      frames.emplace_back(2.5 * std::cos(turn), 2 * std::sin(turn), 0.3 * i);
      submaps.push_back(testing::renderSubmap(testing::room(), frames.back(), 5, 0.05, 0.1, i));
    }
    level = buildPyramid(submaps, {0, 1, 0}).front();
    above = buildPyramid(submaps, {0, 1, backgroundOf(submaps)}).front();
    const ReducedSystem reduced =
        reduce<double>(PlacedLevels(level, frames, kAngle), frames, JacobianKind::kPaper);
    held = anchorsOf(reduced.system);
    observations = reduced.observations;
  }
};

const EightSubmaps& world() {
  static const EightSubmaps instance;
  return instance;
}

void countObservations(benchmark::State& state) {
  const double all = static_cast<double>(state.iterations()) * static_cast<double>(world().observations);
  state.SetItemsProcessed(static_cast<int64_t>(all));
  state.counters["s/observation"] =
      benchmark::Counter(all, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

template <class Scalar>
void fusedPoseOnly(benchmark::State& state, JacobianKind jacobian,
                   InstructionSet instructions = bestInstructionSet()) {
  if (!isSupported(instructions)) return state.SkipWithError("not on this machine");
  const EightSubmaps& w = world();
  const EvidenceLevels& level = jacobian == JacobianKind::kPaper ? w.level : w.above;
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  for (auto _ : state) {
    const ReducedSystem reduced =
        reduce<Scalar>(PlacedLevels(level, w.frames, kAngle), w.frames, jacobian, instructions);
    benchmark::DoNotOptimize(solve(reduced.system, w.held, dampingDiagonal(reduced.system, 0)));
  }
  countObservations(state);
}

void explicitPoseOnly(benchmark::State& state) {
  const EightSubmaps& w = world();
  const PoseSystem nothing(w.frames.size());
  for (auto _ : state) {
    const ExplicitProblem problem = writeOut(w.level, w.frames, JacobianKind::kPaper, kAngle);
    benchmark::DoNotOptimize(poseOnlyStep(problem, nothing, w.held));
  }
  countObservations(state);
}

void fullGaussNewton(benchmark::State& state) {
  const EightSubmaps& w = world();
  const PoseSystem nothing(w.frames.size());
  for (auto _ : state) {
    const ExplicitProblem problem = writeOut(w.level, w.frames, JacobianKind::kPaper, kAngle);
    benchmark::DoNotOptimize(
        fullStep(problem, Eigen::VectorXd::Zero(problem.map_jacobian.cols()), nothing, w.held));
  }
  countObservations(state);
}

void fusedFloat(benchmark::State& state, JacobianKind jacobian) { fusedPoseOnly<float>(state, jacobian); }
void fusedDouble(benchmark::State& state, JacobianKind jacobian) { fusedPoseOnly<double>(state, jacobian); }

void fusedFloatOn(benchmark::State& state, InstructionSet instructions) {
  fusedPoseOnly<float>(state, JacobianKind::kVariableProjection, instructions);
}

BENCHMARK_CAPTURE(fusedFloat, paper, JacobianKind::kPaper)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(fusedFloat, variable_projection, JacobianKind::kVariableProjection)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(fusedFloat, surface, JacobianKind::kSurface)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(fusedFloatOn, baseline, InstructionSet::kBaseline)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(fusedFloatOn, avx2, InstructionSet::kAvx2)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(fusedDouble, variable_projection, JacobianKind::kVariableProjection)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(explicitPoseOnly)->Unit(benchmark::kMillisecond);
BENCHMARK(fullGaussNewton)->Unit(benchmark::kMillisecond);

}  // namespace
