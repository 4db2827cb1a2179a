// What the adaptive filter is for: odometry goes wrong where one scan does not tell. Each case is run with
// several seeds; the trouble comes at another place with each.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>

#include "mapped_log.h"

namespace submap_slam {
namespace {

constexpr std::size_t kSeeds = 20;
constexpr double kMetres = 22;  ///< length of the logs

/** Odometry with something wrong from a given time (s) on. */
using Trouble = std::function<OdometryModel(double)>;

OdometryModel jump(double time) {
  OdometryModel model;
  model.jumps = {{time, {0.8, 0, 0}}};
  return model;
}

OdometryModel turn(double time) {
  OdometryModel model;
  model.jumps = {{time, {0, 0, 0.9}}};
  return model;
}

OdometryModel stall(double time) {
  OdometryModel model;
  model.slips = {{time, time + 2, 0.0}};
  return model;
}

/** Odometry stands still for two seconds and then catches up. */
OdometryModel lag(double time) {
  OdometryModel model = stall(time);
  model.jumps = {{time + 2.001, {1.6, 0, 0}}};
  return model;
}

/** Number of seeds whose end pose is within 0.2 m and 2° of the truth. */
std::size_t kept(const World& world, const Trouble& trouble, int max_particles) {
  GridMapperParams params;
  params.filter.max_particles = max_particles;
  StretchParams one_submap;
  one_submap.max_distance = 1000;
  std::array<std::size_t, kSeeds> right{};
  tbb::parallel_for(std::size_t{0}, kSeeds, [&](std::size_t k) {
    const SimulatedLog log =
        simulateRoute(world, kMetres, trouble(5 + 0.4 * static_cast<double>(k)), 100 + k);
    right[k] = 1;
    for (const auto& submap : mapLog(log.frames, params, 1, one_submap)) {
      const PoseError error = endError(log.truth, *submap);
      if (error.distance() > 0.2 || std::abs(error.phi) > 2 * M_PI / 180) right[k] = 0;
    }
  });
  return std::accumulate(right.begin(), right.end(), std::size_t{0});
}

std::size_t adaptive(const World& world, const Trouble& trouble) {
  return kept(world, trouble, FilterParams{}.max_particles);
}
std::size_t single(const World& world, const Trouble& trouble) { return kept(world, trouble, 1); }

TEST(AdaptiveFilter, SeesThroughStallingWheelsInACorridor) {
  EXPECT_GE(adaptive(corridorWorld(), stall), 18u);
  EXPECT_LE(single(corridorWorld(), stall), 5u);
}

TEST(AdaptiveFilter, SeesThroughAJumpInACorridor) {
  EXPECT_GE(adaptive(corridorWorld(), jump), 18u);
  EXPECT_LE(single(corridorWorld(), jump), 17u);
}

TEST(AdaptiveFilter, FollowsOdometryThatCatchesUp) { EXPECT_GE(adaptive(corridorWorld(), lag), 18u); }

TEST(AdaptiveFilter, SeesThroughAFalseTurn) {
  EXPECT_GE(adaptive(corridorWorld(), turn), 18u);
  EXPECT_GE(adaptive(symmetricRoomsWorld(), turn), 18u);
}

TEST(AdaptiveFilter, IsNotDrawnToTheNextOfManyEqualNichesOrRooms) {
  EXPECT_GE(adaptive(periodicCorridorWorld(), stall), 18u);
  EXPECT_GE(adaptive(periodicCorridorWorld(), jump), 18u);
  EXPECT_GE(adaptive(symmetricRoomsWorld(), stall), 18u);
  EXPECT_GE(adaptive(symmetricRoomsWorld(), jump), 18u);
}

}  // namespace
}  // namespace submap_slam
