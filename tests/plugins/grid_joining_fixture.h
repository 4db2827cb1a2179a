#pragma once

#include <gmock/gmock.h>
#include <submap_slam/core/plugins.h>
#include <submap_slam/core/submap_joiner.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "synthetic_submaps.h"

namespace submap_slam {

using PoseList = std::vector<mrpt::math::TPose2D>;

constexpr double kDegree = M_PI / 180;

/** The joiner as the program gets it: from the plugin file. */
class GridGaussNewtonPlugin : public ::testing::Test {
 protected:
  void SetUp() override {
    loadPlugin(GRID_GAUSS_NEWTON_PLUGIN);
    for (const auto& candidate : availableJoiners())
      if (candidate->name() == "grid_gauss_newton")
        joiner = std::dynamic_pointer_cast<SubmapJoiner>(candidate);
    ASSERT_TRUE(joiner);
    joiner->describe(parameters);
    // The synthetic submaps have coarse cells and honest covariances.
    parameters.set("grid_gauss_newton", "finest_level", "0");
    parameters.set("grid_gauss_newton", "prior_weight", "1");
  }

  JoinedMap join(const GridSubmaps& submaps, const PoseList& start) const {
    JoinedMap initial;
    initial.frames = testing::asGaussians(start);
    initial.constraints = chainSubmaps(submaps).constraints;
    joiner->validate();
    return joiner->join(submaps, initial, {});
  }

  std::shared_ptr<SubmapJoiner> joiner;
  ParameterTable parameters;
};

inline double distance(const mrpt::math::TPose2D& a, const mrpt::math::TPose2D& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

inline mrpt::math::TPose2D frameOf(const JoinedMap& joined, std::size_t i) {
  return joined.frames[i].mean.asTPose();
}

inline void expectSameFrames(const JoinedMap& joined, const PoseList& frames) {
  ASSERT_EQ(joined.frames.size(), frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) EXPECT_EQ(frameOf(joined, i), frames[i]);
}

/** Three submaps of a room. */
struct RoomProblem {
  PoseList truth{{0, 0, 0}, {1.5, 0.6, 0.7}, {-1.2, 0.9, -0.4}};
  GridSubmaps submaps;
  RoomProblem() {
    for (std::size_t i = 0; i < truth.size(); ++i)
      submaps.push_back(
          testing::renderSubmap(testing::room(), truth[i], 5, 0.1, 0.1, static_cast<uint32_t>(i)));
  }
};

/** Five submaps along a corridor, whose end poses are known. */
struct CorridorProblem {
  PoseList truth;
  GridSubmaps submaps;
  explicit CorridorProblem(double noise) {
    for (std::size_t i = 0; i < 5; ++i) {
      truth.emplace_back(4.0 * static_cast<double>(i) - 8, 0.1, 0.05 * static_cast<double>(i));
      submaps.push_back(
          testing::renderSubmap(testing::corridor(60), truth[i], 5, 0.1, noise, static_cast<uint32_t>(i)));
    }
    testing::linkChain(submaps, truth, 0.02, 0.003);
  }
};

}  // namespace submap_slam
