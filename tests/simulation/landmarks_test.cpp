#include <gmock/gmock.h>
#include <mrpt/math/wrap2pi.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/core/path_length.h>
#include <submap_slam/core/vehicle_model.h>
#include <submap_slam/simulation/scenario.h>

#include <algorithm>
#include <cmath>

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;

/** A short piece of a road. */
Scenario pieceOf(const std::string& road, int scans) {
  Scenario scenario = makeScenario(road);
  scenario.max_scans = scans;
  return scenario;
}

Scenario withoutNoise(Scenario scenario) {
  scenario.landmark_sensor.sigma_range = scenario.landmark_sensor.sigma_bearing = 0;
  scenario.control.sigma_velocity = scenario.control.sigma_steering = 0;
  return scenario;
}

TEST(Landmarks, WorldsAreThoseOfThePaper) {
  const SimulatedLog a = simulate(makeScenario("landmarks_a"), 1);
  EXPECT_NEAR(pathLength(a.truth), 6700, 30);
  EXPECT_EQ(a.landmarks.size(), 554u);
  EXPECT_NEAR(pathLength(simulate(makeScenario("landmarks_b"), 1).truth), 6400, 30);
  double seen = 0;
  for (const Frame& frame : a.frames)
    seen += static_cast<double>(frame.landmark_scans.at(0).measurements.size());
  EXPECT_NEAR(seen / static_cast<double>(a.frames.size()), 2, 0.5);  // 554 / 6400 m · 30 m · π / 4
}

TEST(Landmarks, StandBesideTheRoad) {
  Path road{0.1, {}};
  for (int k = 0; k <= 1000; ++k) road.poses.emplace_back(0.1 * k, 0, 0);
  LandmarkField field;
  field.count = 4000;
  field.spread = 5;
  double mean_x = 0, mean_y = 0, farthest = 0;
  for (const auto& [id, position] : plantLandmarks(field, road)) {
    mean_x += position.x / field.count;
    mean_y += position.y / field.count;
    farthest = std::max(farthest, std::abs(position.y));
    EXPECT_TRUE(position.x >= 0 && position.x <= 100);
  }
  EXPECT_NEAR(mean_x, 50, 2);
  EXPECT_NEAR(mean_y, 0, 0.2);
  EXPECT_LE(farthest, 5);
  EXPECT_GT(farthest, 4.9);
}

TEST(Landmarks, WithoutNoiseEverythingFitsTogether) {
  const SimulatedLog log = simulate(withoutNoise(makeScenario("landmarks_block")), 1);
  const TPose2D first = log.truth[0].pose;
  for (std::size_t k = 0; k < log.frames.size(); ++k) {
    const TPose2D robot = first + *log.frames[k].odometry, truth = log.truth[k].pose;
    ASSERT_NEAR(robot.x, truth.x, 0.1);  // a step that a corner begins in is cut short: its mean is measured
    ASSERT_NEAR(robot.y, truth.y, 0.1);
    for (const LandmarkMeasurement& m : log.frames[k].landmark_scans.at(0).measurements) {
      const auto& landmark = log.landmarks.at(*m.id - 1);
      ASSERT_EQ(landmark.id, *m.id);
      const double angle = truth.phi + m.bearing;
      ASSERT_NEAR(truth.x + m.range * std::cos(angle), landmark.position.x, 1e-9);
      ASSERT_NEAR(truth.y + m.range * std::sin(angle), landmark.position.y, 1e-9);
    }
  }
}

TEST(Landmarks, SeenAreAllInTheFieldOfViewAndNoOthers) {
  Scenario scenario = withoutNoise(pieceOf("landmarks_block", 100));
  scenario.landmark_sensor.max_range = 20;
  scenario.landmark_sensor.field_of_view = 1;
  const SimulatedLog log = simulate(scenario, 1);
  for (std::size_t k = 0; k < log.frames.size(); ++k) {
    const TPose2D robot = log.truth[k].pose;
    std::size_t expected = 0;
    for (const auto& [id, position] : log.landmarks) {
      const double dx = position.x - robot.x, dy = position.y - robot.y;
      expected +=
          std::hypot(dx, dy) <= 20 && std::abs(mrpt::math::wrapToPi(std::atan2(dy, dx) - robot.phi)) <= 0.5;
    }
    EXPECT_EQ(log.frames[k].landmark_scans.at(0).measurements.size(), expected) << k;
  }
}

TEST(Landmarks, VelocitiesAddUpToTheirPosesAndFramesFollowEveryEighth) {
  const SimulatedLog log = simulate(pieceOf("landmarks_a", 50), 1);
  ASSERT_EQ(log.frames.size(), 50u);
  ASSERT_EQ(log.velocities.size(), 49u * 8 + 1);
  TPose2D pose(0, 0, 0);
  for (std::size_t k = 0; k < log.velocities.size(); ++k) {
    const VelocityReading& reading = log.velocities[k];
    EXPECT_NEAR(reading.pose.x, pose.x, 1e-6);
    EXPECT_NEAR(mrpt::math::wrapToPi(reading.pose.phi - pose.phi), 0, 1e-6);
    if (k % 8 == 0) {
      EXPECT_EQ(log.frames[k / 8].stamp, reading.stamp);
      EXPECT_EQ(log.frames[k / 8].odometry->x, reading.pose.x);
    }
    pose = moved(pose, reading.velocity, 1.0 / 40);
  }
}

TEST(Landmarks, NoiseIsAsLargeAsTheModelsSay) {
  const Scenario scenario = makeScenario("landmarks_a");
  const SimulatedLog log = simulate(scenario, 3);
  double range = 0, bearing = 0, speed = 0, steering = 0, seen = 0;
  for (std::size_t k = 0; k < log.frames.size(); ++k)
    for (const LandmarkMeasurement& m : log.frames[k].landmark_scans.at(0).measurements) {
      const TPose2D robot = log.truth[k].pose;
      const auto& p = log.landmarks.at(*m.id - 1).position;
      const double angle = std::atan2(p.y - robot.y, p.x - robot.x) - robot.phi;
      range += std::pow(m.range - std::hypot(p.x - robot.x, p.y - robot.y), 2);
      bearing += std::pow(mrpt::math::wrapToPi(m.bearing - angle), 2);
      ++seen;
    }
  EXPECT_NEAR(std::sqrt(range / seen), 0.5, 0.01);
  EXPECT_NEAR(std::sqrt(bearing / seen), 5 * M_PI / 180, 0.002);
  const std::size_t straight = 40 * 200;  // readings on the first 600 m
  for (std::size_t k = 0; k < straight; ++k) {
    const auto& v = log.velocities[k].velocity;
    speed += std::pow(v.vx - 3, 2) / static_cast<double>(straight);
    steering += std::pow(std::atan(4 * v.omega / v.vx), 2) / static_cast<double>(straight);
  }
  EXPECT_NEAR(std::sqrt(speed), 0.3, 0.01);
  EXPECT_NEAR(std::sqrt(steering), 3 * M_PI / 180, 0.002);
}

TEST(Landmarks, SeedsChangeTheNoiseAlone) {
  const Scenario scenario = pieceOf("landmarks_a", 200);
  const SimulatedLog a = simulate(scenario, 1), b = simulate(scenario, 1), c = simulate(scenario, 2);
  EXPECT_EQ(*a.frames.back().odometry, *b.frames.back().odometry);
  EXPECT_NE(*a.frames.back().odometry, *c.frames.back().odometry);
  EXPECT_EQ(a.truth.back().pose, c.truth.back().pose);
  EXPECT_EQ(a.landmarks.back().position, c.landmarks.back().position);
  EXPECT_EQ(a.landmarks.front().position,
            simulate(makeScenario("landmarks_a"), 1).landmarks.front().position);
}

TEST(Landmarks, ImpossibleModelsAreRefused) {
  const auto refused = [](const auto& change) {
    Scenario scenario = pieceOf("landmarks_block", 10);
    change(scenario);
    EXPECT_THROW(simulate(scenario, 1), ConfigError);
  };
  refused([](Scenario& s) { s.landmark_sensor.max_range = 0; });
  refused([](Scenario& s) { s.landmark_sensor.sigma_bearing = -1; });
  refused([](Scenario& s) { s.control.wheel_base = 0; });
  refused([](Scenario& s) { s.control.readings_per_scan = 0; });
  refused([](Scenario& s) { s.landmarks.spread = std::nan(""); });
  refused([](Scenario& s) {
    s.world.route = {{0, 0}, {9, 0}, {0, 0}};
    s.max_scans = 0;
  });
}

TEST(Landmarks, TableHoldsTheKeysOfACar) {
  Scenario scenario = makeScenario("landmarks_b");
  ParameterTable table;
  describe(table, scenario);
  table.set("simulation.landmarks=3");
  EXPECT_EQ(scenario.landmarks.count, 3);
  EXPECT_THROW(table.set("simulation.beams=3"), ConfigError);
}

}  // namespace
}  // namespace submap_slam
