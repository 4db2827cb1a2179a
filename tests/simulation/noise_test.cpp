#include <gtest/gtest.h>
#include <submap_slam/simulation/normal_generator.h>
#include <submap_slam/simulation/simulate.h>

#include <cmath>
#include <vector>

namespace submap_slam {
namespace {

constexpr double kPi = 3.141592653589793;

struct Moments {
  double mean = 0, sigma = 0;
};

Moments momentsOf(const std::vector<double>& values) {
  Moments moments;
  for (const double value : values) moments.mean += value / static_cast<double>(values.size());
  double sum = 0;
  for (const double value : values) sum += (value - moments.mean) * (value - moments.mean);
  moments.sigma = std::sqrt(sum / static_cast<double>(values.size() - 1));
  return moments;
}

TEST(NormalGenerator, HasTheShapeOfAStandardNormalDistribution) {
  NormalGenerator normal(42, 0);
  constexpr int kSamples = 100000;
  std::vector<double> values;
  int beyond_one = 0, beyond_two = 0;
  double neighbours = 0;
  for (int i = 0; i < kSamples; ++i) {
    values.push_back(normal());
    beyond_one += std::abs(values.back()) > 1;
    beyond_two += std::abs(values.back()) > 2;
    if (i > 0) neighbours += values[values.size() - 2] * values.back() / kSamples;
  }
  const auto [mean, sigma] = momentsOf(values);
  EXPECT_NEAR(mean, 0, 0.015);  // tolerances are about five standard errors
  EXPECT_NEAR(sigma, 1, 0.012);
  EXPECT_NEAR(beyond_one / double{kSamples}, std::erfc(std::sqrt(0.5)), 0.008);
  EXPECT_NEAR(beyond_two / double{kSamples}, std::erfc(std::sqrt(2.0)), 0.0035);
  EXPECT_NEAR(neighbours, 0, 0.016);
}

TEST(NormalGenerator, FollowsBoxAndMullersFormula) {
  std::seed_seq sequence{7u, 3u, 9u};  // low and high half of the seed, stream
  std::mt19937_64 engine(sequence);
  const double u = (static_cast<double>(engine() >> 11) + 1) / 9007199254740992.0;
  const double v = (static_cast<double>(engine() >> 11) + 1) / 9007199254740992.0;
  NormalGenerator normal((uint64_t{3} << 32) + 7, 9);
  EXPECT_NEAR(normal(), std::sqrt(-2 * std::log(u)) * std::cos(2 * kPi * v), 1e-12);
  EXPECT_NEAR(normal(), std::sqrt(-2 * std::log(u)) * std::sin(2 * kPi * v), 1e-12);
}

TEST(NormalGenerator, HasStreamsThatDoNotFollowEachOther) {
  NormalGenerator one(5, 1), two(5, 2), other_seed(6, 1);
  double streams = 0, seeds = 0;
  constexpr int kSamples = 20000;
  for (int i = 0; i < kSamples; ++i) {
    const double value = one();
    streams += value * two() / kSamples;
    seeds += value * other_seed() / kSamples;
  }
  EXPECT_NEAR(streams, 0, 0.04);
  EXPECT_NEAR(seeds, 0, 0.04);
}

/** A robot that stands in the middle of a round room of 3 m radius. */
World roundRoom() {
  World room;
  constexpr int kCorners = 3600;
  for (int i = 0; i < kCorners; ++i) {
    const double a = 2 * kPi * i / kCorners, b = 2 * kPi * (i + 1) / kCorners;
    room.walls.push_back({{3 * std::cos(a), 3 * std::sin(a)}, {3 * std::cos(b), 3 * std::sin(b)}});
  }
  return room;
}

TEST(LaserNoise, HasTheSigmaOfTheModelAndNoBias) {
  LaserModel laser;
  laser.sensor_pose = {0, 0, 0};
  laser.sigma_range = 0.03;
  const Path standing{0.2, std::vector<mrpt::math::TPose2D>(30, {0, 0, 0})};
  const SimulatedLog log = simulate(roundRoom(), standing, laser, OdometryModel{}, 11);
  std::vector<double> errors;
  for (const Frame& frame : log.frames)
    for (std::size_t beam = 0; beam < frame.scans[0]->getScanSize(); ++beam)
      errors.push_back(frame.scans[0]->getScanRange(beam) - 3.0);
  const auto [mean, sigma] = momentsOf(errors);
  EXPECT_NEAR(mean, 0, 0.002);
  EXPECT_NEAR(sigma, 0.03, 0.0015);
}

/** Errors of single odometry steps of the same increment, in the robot frame. */
struct StepErrors {
  std::vector<double> along, lateral, turn;
};

StepErrors stepErrors(const mrpt::math::TPose2D& increment, const OdometryModel& model) {
  Path path{0.2, {{0, 0, 0}}};
  for (int k = 0; k < 5000; ++k) path.poses.push_back(path.poses.back() + increment);
  LaserModel laser;
  laser.beams = 2;
  const SimulatedLog log = simulate(World{}, path, laser, model, 3);
  StepErrors errors;
  for (std::size_t k = 1; k < log.frames.size(); ++k) {
    const auto step = *log.frames[k].odometry - *log.frames[k - 1].odometry;
    errors.along.push_back(step.x - increment.x);
    errors.lateral.push_back(step.y - increment.y);
    errors.turn.push_back(std::remainder(step.phi - increment.phi, 2 * kPi));
  }
  return errors;
}

TEST(OdometryNoise, GrowsWithTheRootOfDistanceAndTurn) {
  OdometryModel model = OdometryModel::perfect();
  model.along = 0.1;
  model.lateral = 0.05;
  model.turn_by_distance = 0.03;
  model.turn_by_turn = 0.2;
  const StepErrors errors = stepErrors({0.09, 0, -0.04}, model);
  const Moments along = momentsOf(errors.along), lateral = momentsOf(errors.lateral),
                turn = momentsOf(errors.turn);
  EXPECT_NEAR(along.sigma, 0.1 * 0.3, 0.0015);
  EXPECT_NEAR(lateral.sigma, 0.05 * 0.3, 0.0008);
  EXPECT_NEAR(turn.sigma, std::hypot(0.03 * 0.3, 0.2 * 0.2), 0.002);
  EXPECT_NEAR(along.mean, 0, 0.002);
  EXPECT_NEAR(lateral.mean, 0, 0.001);
  EXPECT_NEAR(turn.mean, 0, 0.003);
}

TEST(OdometryNoise, HasItsFixedPartInEveryNthStepOnly) {
  OdometryModel model = OdometryModel::perfect();
  model.fixed_xy = 0.04;
  model.fixed_turn = 0.003;
  model.fixed_every = 4;
  const StepErrors errors = stepErrors({0, 0, 0}, model);
  std::vector<double> along, turn;
  for (std::size_t i = 0; i < errors.along.size(); ++i) {
    if (i % 4 == 3) {
      along.push_back(errors.along[i]);
      turn.push_back(errors.turn[i]);
    } else {
      ASSERT_NEAR(errors.along[i], 0, 3e-6) << i;
      ASSERT_NEAR(errors.turn[i], 0, 3e-6) << i;
    }
  }
  EXPECT_NEAR(momentsOf(along).sigma, 0.04, 0.004);
  EXPECT_NEAR(momentsOf(turn).sigma, 0.003, 0.0003);
}

}  // namespace
}  // namespace submap_slam
