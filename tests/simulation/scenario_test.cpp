#include <gtest/gtest.h>
#include <mrpt/math/wrap2pi.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/simulation/scenario.h>

#include <cmath>

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;

/** Mean absolute error of odometry over scans, first pose aligned: x and y (m), and heading (rad). */
struct OdometryError {
  double xy = 0, phi = 0;
};

OdometryError odometryError(const SimulatedLog& log) {
  OdometryError sum;
  for (std::size_t k = 0; k < log.frames.size(); ++k) {
    const TPose2D found = log.truth[0].pose + *log.frames[k].odometry, wanted = log.truth[k].pose;
    sum.xy += (std::abs(found.x - wanted.x) + std::abs(found.y - wanted.y)) / 2;
    sum.phi += std::abs(mrpt::math::wrapToPi(found.phi - wanted.phi));
  }
  const auto scans = static_cast<double>(log.frames.size());
  return {sum.xy / scans, sum.phi / scans};
}

/** Mean over seeds; the laser plays no part in it. */
OdometryError meanOdometryError(const std::string& world) {
  constexpr int kSeeds = 40;
  Scenario scenario = makeScenario(world);
  scenario.laser.beams = 2;
  OdometryError mean;
  for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const OdometryError error = odometryError(simulate(scenario, seed));
    mean.xy += error.xy / kSeeds;
    mean.phi += error.phi / kSeeds;
  }
  return mean;
}

void expectScans(const std::string& world, std::size_t scans, double duration_s) {
  Scenario scenario = makeScenario(world);
  EXPECT_EQ(scenario.laser.beams, 1081);
  scenario.laser.beams = 2;
  EXPECT_EQ(simulate(scenario, 1).frames.size(), scans);
  EXPECT_NEAR(static_cast<double>(scans) / scenario.scan_rate, duration_s, 1e-9);
}

TEST(Scenario, HasAsManyScansAsPublished) {
  expectScans("non_convex", 3640, 117);
  expectScans("long_corridors", 2680, 83);
}

TEST(Scenario, OdometryDriftsAboutAsMuchAsPublished) {
  const OdometryError hall = meanOdometryError("non_convex"), corridors = meanOdometryError("long_corridors");
  EXPECT_NEAR(hall.xy, 0.7827, 0.2);
  EXPECT_NEAR(hall.phi, 0.0491, 0.015);
  EXPECT_NEAR(corridors.xy, 0.7535, 0.2);
  EXPECT_NEAR(corridors.phi, 0.0518, 0.015);
}

TEST(Scenario, TableChangesWhatIsSimulated) {
  Scenario scenario = makeScenario("room");
  ParameterTable table;
  describe(table, scenario);
  table.set("simulation.max_scans=7");
  table.set("simulation.beams=11");
  const SimulatedLog log = simulate(scenario, 1);
  EXPECT_EQ(log.frames.size(), 7u);
  EXPECT_EQ(log.frames[0].scans[0]->getScanSize(), 11u);
  EXPECT_THROW(table.set("simulation.aperture=7"), ConfigError);
}

TEST(Scenario, KnowsEveryWorldAndNoOther) {
  for (const auto& world : scenarioNames()) EXPECT_EQ(makeScenario(world).world.name, world);
  EXPECT_THROW(makeScenario("moon"), ConfigError);
}

}  // namespace
}  // namespace submap_slam
