// Is the end pose of a submap as certain as its covariance says? Normalised estimation error squared against
// the truth.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <Eigen/LU>
#include <vector>

#include "mapped_log.h"

namespace submap_slam {
namespace {

constexpr std::size_t kSeeds = 6;

/** Means over all submaps; 1 if the covariance is right. */
struct Consistency {
  double pose = 0, translation = 0, rotation = 0;
  std::size_t submaps = 0;

  void add(const PoseError& error, const Eigen::Matrix3d& covariance) {
    const Eigen::Vector3d e(error.x, error.y, error.phi);
    pose += e.dot(covariance.inverse() * e) / 3;
    translation += e.head<2>().dot(covariance.topLeftCorner<2, 2>().inverse() * e.head<2>()) / 2;
    rotation += e.z() * e.z() / covariance(2, 2);
    ++submaps;
  }
  void add(const Consistency& other) {
    pose += other.pose, translation += other.translation, rotation += other.rotation;
    submaps += other.submaps;
  }
  Consistency mean() const {
    const auto n = static_cast<double>(submaps);
    return {pose / n, translation / n, rotation / n, submaps};
  }
};

Consistency sumOver(const World& world, const GridMapperParams& params) {
  std::vector<Consistency> of_seed(kSeeds);
  tbb::parallel_for(std::size_t{0}, kSeeds, [&](std::size_t k) {
    const SimulatedLog log = simulateRoute(world, 1e9, OdometryModel{}, 200 + k);
    for (const auto& submap : mapLog(log.frames, params))
      if (submap->has_successor) of_seed[k].add(endError(log.truth, *submap), submap->end_pose.cov.asEigen());
  });
  Consistency sum;
  for (const auto& one : of_seed) sum.add(one);
  return sum;
}

TEST(EndCovariance, IsConsistentInEveryWorldAndOverAll) {
  Consistency all;
  for (const auto& world : {roomWorld(), corridorWorld(), loopWorld()}) {
    const Consistency sum = sumOver(world, {}), mean = sum.mean();
    EXPECT_GT(mean.pose, 0.5) << world.name;
    EXPECT_LT(mean.pose, 1.5) << world.name;
    EXPECT_GT(mean.translation, 0.4) << world.name;
    EXPECT_LT(mean.translation, 1.7) << world.name;
    EXPECT_LT(mean.rotation, 1.5) << world.name;
    all.add(sum);
  }
  const Consistency mean = all.mean();
  EXPECT_GT(mean.submaps, 100u);
  EXPECT_GT(mean.pose, 0.5);
  EXPECT_LT(mean.pose, 1.5);
  EXPECT_GT(mean.translation, 0.5);
  EXPECT_LT(mean.translation, 1.5);
  EXPECT_GT(mean.rotation, 0.4);
  EXPECT_LT(mean.rotation, 1.5);
}

TEST(EndCovariance, OfScanMatchingIsOfTheRightOrder) {
  GridMapperParams params;
  params.method = "scan_matching";
  for (const auto& world : {roomWorld(), corridorWorld(), loopWorld()}) {
    const Consistency mean = sumOver(world, params).mean();
    EXPECT_GT(mean.pose, 0.3) << world.name;
    EXPECT_LT(mean.pose, 2) << world.name;
    EXPECT_LT(mean.translation, 2.5) << world.name;
    EXPECT_LT(mean.rotation, 2) << world.name;
  }
}

}  // namespace
}  // namespace submap_slam
