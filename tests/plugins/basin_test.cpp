/** From how far away the joiner finds the frames, with the chain prior: 45 of 50 starts, drawn at random,
 * must lead to the truth. */
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "grid_gauss_newton/grid_gauss_newton.h"
#include "synthetic_submaps.h"

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;
using PoseList = std::vector<TPose2D>;

constexpr double kDegree = M_PI / 180;
constexpr uint32_t kTrials = 50, kSuccesses = 45;

/** Portable: the standard distributions differ between libraries. */
double uniform(std::mt19937& generator, double from, double to) {
  return from + (to - from) * static_cast<double>(generator()) / 4294967296.0;
}

/** All frames but the first moved by a distance in a random direction, and turned to one side or the other.
 */
PoseList displaced(const PoseList& truth, double distance, double turn, uint32_t seed) {
  std::mt19937 generator(seed);
  PoseList frames = truth;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const double direction = uniform(generator, -M_PI, M_PI);
    frames[i].x += distance * std::cos(direction);
    frames[i].y += distance * std::sin(direction);
    frames[i].phi += uniform(generator, -1, 1) < 0 ? -turn : turn;
  }
  return frames;
}

JoinedMap join(const GridSubmaps& submaps, const PoseList& start) {
  GridGaussNewton joiner;
  ParameterTable parameters;
  joiner.describe(parameters);
  parameters.set("grid_gauss_newton", "finest_level", "0");  // cells are large already
  parameters.set("grid_gauss_newton", "levels", "5");        // the coarsest of 1.6 m
  parameters.set("grid_gauss_newton", "prior_weight", "1");  // covariances are honest
  JoinedMap initial;
  initial.frames = testing::asGaussians(start);
  initial.constraints = chainSubmaps(submaps).constraints;
  return joiner.join(submaps, initial, {});
}

/** Whether all frames are that near to the truth. */
bool found(const JoinedMap& joined, const PoseList& truth, double distance_m, double angle_rad) {
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const TPose2D frame = joined.frames[i].mean.asTPose();
    if (std::hypot(frame.x - truth[i].x, frame.y - truth[i].y) > distance_m) return false;
    if (std::abs(std::remainder(frame.phi - truth[i].phi, 2 * M_PI)) > angle_rad) return false;
  }
  return true;
}

/** The chain has the same error as the start: only its covariance is right. */
TEST(Basin, RoomsFrom2MetresAnd5Degrees) {
  const PoseList truth{{0, 0, 0}, {1.5, 0.6, 0.7}, {-1.2, 0.9, -0.4}};
  uint32_t successes = 0;
  for (uint32_t trial = 0; trial < kTrials; ++trial) {
    GridSubmaps submaps;
    for (uint32_t i = 0; i < 3; ++i)
      submaps.push_back(testing::scanSubmap(testing::room(), truth[i], 5, 0.1, 0.1, 3 * trial + i));
    const PoseList start = displaced(truth, 2, 5 * kDegree, trial);
    testing::linkChain(submaps, start, 2, 5 * kDegree);
    successes += found(join(submaps, start), truth, 0.02, 0.2 * kDegree) ? 1 : 0;
  }
  EXPECT_GE(successes, kSuccesses);
}

TEST(Basin, CorridorsFromHalfAMetreAnd2Degrees) {
  PoseList truth;
  for (int i = 0; i < 5; ++i) truth.emplace_back(4.0 * i - 8, 0.1, 0.05 * i);
  uint32_t successes = 0;
  for (uint32_t trial = 0; trial < kTrials; ++trial) {
    GridSubmaps submaps;
    for (uint32_t i = 0; i < 5; ++i)
      submaps.push_back(testing::scanSubmap(testing::corridor(60), truth[i], 5, 0.1, 0.1, 5 * trial + i));
    testing::linkChain(submaps, truth, 0.02, 0.003);
    const JoinedMap joined = join(submaps, displaced(truth, 0.5, 2 * kDegree, trial));
    const double two_sigma_of_the_chain = 2 * 0.02 * std::sqrt(4.0);
    successes += found(joined, truth, two_sigma_of_the_chain, 0.5 * kDegree) ? 1 : 0;
  }
  EXPECT_GE(successes, kSuccesses);
}

}  // namespace
}  // namespace submap_slam
