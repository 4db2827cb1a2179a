#include <gtest/gtest.h>
#include <submap_slam/simulation/normal_generator.h>

#include <Eigen/LU>
#include <cmath>

#include "odometry_pose_graph/node_graph.h"
#include "odometry_pose_graph/odometry_model.h"

namespace submap_slam::pose_graph {
namespace {

using mrpt::math::TPose2D;

constexpr double kStep = 0.25;  // m

/** Submaps along a straight path; odometry errs at each step by what `error` says. */
template <class Error>
GridSubmaps straightSubmaps(std::size_t count, std::size_t nodes, Error error) {
  GridSubmaps submaps;
  TPose2D odometry(3, -1, 0.7);
  for (std::size_t k = 0; k < count; ++k) {
    auto submap = GridSubmap::Create();
    submap->id = static_cast<uint32_t>(k);
    for (std::size_t n = 0; n < nodes; ++n) {
      SubmapNode node;
      node.pose = {kStep * static_cast<double>(n), 0, 0};
      node.odometry = odometry;
      submap->nodes.push_back(node);
      odometry = odometry + error(TPose2D(kStep, 0, 0));
    }
    submap->end_pose.mean = mrpt::poses::CPose2D(kStep * static_cast<double>(nodes), 0, 0);
    submap->end_pose.cov.setDiagonal(1e-4);
    submap->has_successor = k + 1 < count;
    submaps.push_back(submap);
  }
  return submaps;
}

TPose2D exact(const TPose2D& motion) { return motion; }

OdometryModel modelOf(const GridSubmaps& submaps) {
  return odometryModelOf(submaps, graphNodesOf(submaps, 0.2, 0.15), {});
}

TEST(GraphNodes, AreFarEnoughApart) {
  const auto submaps = straightSubmaps(2, 9, exact);
  EXPECT_EQ(graphNodesOf(submaps, 0.2, 1)[1].size(), 9u);
  EXPECT_EQ(graphNodesOf(submaps, 0.6, 1)[0], (std::vector<std::size_t>{0, 3, 6}));
  EXPECT_TRUE(graphNodesOf({GridSubmap::Create()}, 0.6, 1)[0].empty());
}

TEST(OdometryModel, FindsTheNoiseOfTheLog) {
  NormalGenerator normal(7, 0);
  const double sigma_xy = 0.02, sigma_phi = 0.01;  // per step
  const auto model = modelOf(straightSubmaps(20, 50, [&](const TPose2D& motion) {
    return motion + TPose2D(sigma_xy * normal(), sigma_xy * normal(), sigma_phi * normal());
  }));
  ASSERT_TRUE(model.known());
  EXPECT_NEAR(std::sqrt(model.variance_xy * kStep), sigma_xy, 0.1 * sigma_xy);
  EXPECT_NEAR(std::sqrt(model.variance_phi * kStep), sigma_phi, 0.1 * sigma_phi);
  EXPECT_NEAR(model.gain_xy, 1, 0.01);
}

/** Matches err each by itself, odometry's errors add up: neither is taken for the other. */
TEST(OdometryModel, ErrorsOfMatchesAreNotThoseOfOdometry) {
  NormalGenerator normal(7, 0);
  const double sigma_xy = 0.002, sigma_phi = 0.0005;  // per step
  const MatchNoise match;
  auto submaps = straightSubmaps(20, 50, [&](const TPose2D& motion) {
    return motion + TPose2D(sigma_xy * normal(), sigma_xy * normal(), sigma_phi * normal());
  });
  for (auto& submap : submaps)
    for (auto& node : submap->nodes)
      node.pose = node.pose +
                  TPose2D(match.sigma_xy * normal(), match.sigma_xy * normal(), match.sigma_phi * normal());
  const OdometryModel model = modelOf(submaps);
  EXPECT_NEAR(std::sqrt(model.variance_xy * kStep), sigma_xy, 0.25 * sigma_xy);
  EXPECT_NEAR(std::sqrt(model.variance_phi * kStep), sigma_phi, 0.25 * sigma_phi);
}

TEST(OdometryModel, AFewSlipsDontCount) {
  NormalGenerator normal(7, 0);
  int step = 0;
  const auto model = modelOf(straightSubmaps(20, 50, [&](const TPose2D& motion) {
    const double slip = ++step % 50 == 25 ? 0.5 : 0;
    return motion + TPose2D(slip + 0.02 * normal(), 0.02 * normal(), 0.01 * normal());
  }));
  EXPECT_NEAR(std::sqrt(model.variance_xy * kStep), 0.02, 0.005);
}

TEST(OdometryModel, FindsAWrongScale) {
  const auto model =
      modelOf(straightSubmaps(3, 50, [](const TPose2D& m) { return TPose2D(1.2 * m.x, 0, 0); }));
  EXPECT_NEAR(model.gain_xy, 1 / 1.2, 1e-6);
  EXPECT_LT(model.variance_xy, 1e-5);
}

TEST(OdometryModel, NoisyHeadingsOnAStraightPathSayNothingOfTheGain) {
  NormalGenerator normal(7, 0);
  const auto model = modelOf(straightSubmaps(
      20, 50, [&](const TPose2D& motion) { return motion + TPose2D(0, 0, 0.04 * normal()); }));
  EXPECT_EQ(model.gain_phi, 1);
}

TEST(OdometryModel, FindsAWrongScaleOfTurns) {
  auto submaps = straightSubmaps(3, 50, [](const TPose2D&) { return TPose2D(0, 0, 0.2 * 1.25); });
  for (auto& submap : submaps)
    for (std::size_t n = 0; n < submap->nodes.size(); ++n)
      submap->nodes[n].pose = {0, 0, 0.2 * static_cast<double>(n)};
  EXPECT_NEAR(modelOf(submaps).gain_phi, 0.8, 1e-6);
}

TEST(OdometryModel, IsUnknownWithoutOdometryAndForShortLogs) {
  EXPECT_FALSE(modelOf(straightSubmaps(1, 5, exact)).known());
  auto submaps = straightSubmaps(3, 50, exact);
  for (auto& submap : submaps)
    for (auto& node : submap->nodes) node.odometry.reset();
  EXPECT_FALSE(modelOf(submaps).known());
}

FrameGraph chainOf(const GridSubmaps& submaps) {
  FrameGraph graph;
  graph.frames.push_back({});
  for (std::size_t k = 0; k + 1 < submaps.size(); ++k) {
    const TPose2D end = submaps[k]->end_pose.mean.asTPose();
    const Eigen::Matrix3d covariance = submaps[k]->end_pose.cov.asEigen();
    graph.links.push_back({k, k + 1, end, covariance, covariance, false});
    graph.frames.push_back(graph.frames.back() + end);
  }
  return graph;
}

TEST(FuseOdometry, NothingMovesWhereAllAgree) {
  const auto submaps = straightSubmaps(3, 40, exact);
  for (const auto kind : {OdometryResidual::kConsecutive, OdometryResidual::kSubmap}) {
    FusionParams params;
    params.odometry = kind;
    const auto fused = fuseOdometry(submaps, chainOf(submaps), params);
    ASSERT_EQ(fused.nodes.size(), 3u);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(fused.frames.frames[k].x, 10.0 * static_cast<double>(k), 1e-9);
      for (std::size_t n = 0; n < 40; ++n)
        EXPECT_NEAR(fused.nodes[k][n].x, submaps[k]->nodes[n].pose.x, 1e-9);
    }
  }
}

/** Residuals far below their sigmas, where the Cauchy loss is a square: a weighted mean by hand. */
TEST(FuseOdometry, WeighsMatchAgainstOdometry) {
  const auto submaps = straightSubmaps(1, 40, [](const TPose2D& m) { return TPose2D(1.01 * m.x, 0, 0); });
  FusionParams params;
  params.node_distance = 9.6;  // nodes 0 and 39
  params.intra.sigma_xy = 2;
  params.odometry_weight_xy = 0.5;
  OdometryModel model;
  model.variance_xy = model.variance_phi = 1;
  const double matched = 39 * kStep, odometry = 1.01 * matched;
  const double by_match = 1 / 4.0, by_odometry = 0.5 / odometry;
  const double expected = (by_match * matched + by_odometry * odometry) / (by_match + by_odometry);
  for (const auto kind : {OdometryResidual::kConsecutive, OdometryResidual::kSubmap}) {
    params.odometry = kind;
    const auto fused = fuseOdometry(submaps, chainOf(submaps), params, model);
    EXPECT_NEAR(fused.nodes[0][39].x, expected, 1e-4);
    EXPECT_NEAR(fused.nodes[0][20].x - 20 * kStep, (expected - matched) * 20 / 39, 1e-4);
  }
}

/** Matches that fall back by 0.4 % along the way, in submaps whose end poses say that they may: odometry,
 * which knows better, stretches submaps, as long as it is worth it. */
TEST(FuseOdometry, GoodOdometryBendsSubmaps) {
  const auto submaps = straightSubmaps(3, 40, [](const TPose2D& m) { return TPose2D(1.004 * m.x, 0, 0); });
  for (const auto& submap : submaps) submap->end_pose.cov.setDiagonal(0.2 * 0.2);
  const auto fusedWith = [&](double variance, const FusionParams& params) {
    OdometryModel model;
    model.variance_xy = model.variance_phi = variance;
    return fuseOdometry(submaps, chainOf(submaps), params, model);
  };
  const FusedGraph good = fusedWith(1e-4, {}), bad = fusedWith(0.04, {});
  EXPECT_TRUE(good.bent);
  EXPECT_GT(good.frames.frames[2].x, 20.03);  // of 20.08: within a section the matches count as rigid
  EXPECT_EQ(good.frames.links[0].covariance, good.frames.links[0].usual_covariance);
  EXPECT_FALSE(bad.bent);
  EXPECT_NEAR(bad.frames.frames[2].x, 20, 0.005);

  FusionParams params;
  params.odometry_weight_xy = params.odometry_weight_phi = 1e-3;
  EXPECT_FALSE(fusedWith(1e-4, params).bent);
  params = {};
  params.bend_up_to = 0;
  EXPECT_FALSE(fusedWith(1e-4, params).bent);
  params = {};
  params.odometry = OdometryResidual::kSubmap;
  EXPECT_FALSE(fusedWith(1e-4, params).bent);
}

/** Between the last node of a submap and the next submap's frame: by hand as above. */
TEST(FuseOdometry, OdometryReachesAcrossTheEndOfASubmap) {
  auto submaps = straightSubmaps(2, 1, [](const TPose2D&) { return TPose2D(1.1 * kStep, 0, 0); });
  FrameGraph graph = chainOf(submaps);
  graph.links[0].usual_covariance = 4 * Eigen::Matrix3d::Identity();
  OdometryModel model;
  model.variance_xy = model.variance_phi = 1 / (1.1 * kStep);  // variance 1 for this step
  const auto fused = fuseOdometry(submaps, graph, {}, model);
  EXPECT_NEAR(fused.frames.frames[1].x, (0.25 * kStep + 1.1 * kStep) / 1.25, 1e-5);
}

TEST(FuseOdometry, OdometryMissingInTheMiddleIsSkipped) {
  auto submaps = straightSubmaps(2, 40, exact);
  submaps[0]->nodes[17].odometry.reset();
  const auto fused = fuseOdometry(submaps, chainOf(submaps), {});
  EXPECT_NEAR(fused.nodes[0][39].x, 39 * kStep, 1e-9);
  EXPECT_NEAR(fused.frames.frames[1].x, 10, 1e-9);
}

TEST(FuseOdometry, OffMovesNoNode) {
  const auto submaps = straightSubmaps(3, 40, [](const TPose2D& m) { return TPose2D(m.x, 0.01, 0.01); });
  FusionParams params;
  params.odometry = OdometryResidual::kOff;
  EXPECT_TRUE(fuseOdometry(submaps, chainOf(submaps), params).nodes.empty());
}

TEST(FuseOdometry, SubmapsWithoutNodesAreNoTrouble) {
  auto submaps = straightSubmaps(4, 40, exact);
  submaps[1]->nodes.clear();
  const auto fused = fuseOdometry(submaps, chainOf(submaps), {});
  EXPECT_TRUE(fused.nodes[1].empty());
  EXPECT_NEAR(fused.frames.frames[3].x, 30, 1e-6);
}

TEST(FuseOdometry, WhatTheLoopsContradictLosesItsWeight) {
  const auto submaps = straightSubmaps(4, 40, exact);
  FrameGraph graph = chainOf(submaps);
  const Eigen::Matrix3d tight = 1e-4 * Eigen::Matrix3d::Identity();
  const double slip = 1.0;  // the second end pose is off by that
  for (std::size_t k = 2; k < 4; ++k)
    for (std::size_t i = 0; i < 2; ++i)
      graph.links.push_back(
          {k, i, TPose2D(-10.0 * static_cast<double>(k - i) - slip, 0, 0), tight, tight, true});
  for (std::size_t k = 0; k < 3; ++k) graph.links[k].covariance = Eigen::Matrix3d::Identity();
  graph.optimise();  // as the search does, which reckons with slips
  FusionParams params;
  params.odometry = OdometryResidual::kOff;
  const auto fused = fuseOdometry(submaps, graph, params);
  EXPECT_NEAR(fused.frames.frames[2].x, 21, 0.05);
  EXPECT_LT(fused.frames.links[0].covariance(0, 0), 2e-4);
  EXPECT_GT(fused.frames.links[1].covariance(0, 0), 0.1);
}

/** Laps of a square, with loops from each lap to the one before. */
struct Laps {
  GridSubmaps submaps;
  FrameGraph graph;
  std::vector<TPose2D> truth;

  explicit Laps(uint64_t seed) {
    NormalGenerator normal(seed, 0);
    const auto noisy = [&](const TPose2D& pose, double xy, double phi) {
      return pose + TPose2D(xy * normal(), xy * normal(), phi * normal());
    };
    const Eigen::Matrix3d chain = Eigen::Vector3d(4e-4, 4e-4, 1e-4).asDiagonal();
    const Eigen::Matrix3d loop = Eigen::Vector3d(4e-4, 4e-4, 2.5e-5).asDiagonal();
    for (std::size_t k = 0; k < 80; ++k) {
      submaps.push_back(GridSubmap::Create());
      truth.push_back(k == 0 ? TPose2D() : truth.back() + TPose2D(5, 0, k % 4 == 0 ? M_PI / 2 : 0));
      if (k == 0) {
        graph.frames.push_back({});
        continue;
      }
      const TPose2D end = noisy(truth[k] - truth[k - 1], 0.02, 0.01);
      graph.links.push_back({k - 1, k, end, chain, chain, false});
      graph.frames.push_back(graph.frames.back() + end);
      if (k < 16) continue;
      const TPose2D closed = noisy(truth[k - 16] - truth[k], 0.02, 0.005);
      graph.links.push_back({k, k - 16, closed, loop, loop, true});
    }
  }

  double error() const {
    FusionParams params;
    params.odometry = OdometryResidual::kOff;
    const auto fused = fuseOdometry(submaps, graph, params);
    double sum = 0;
    for (std::size_t k = 0; k < truth.size(); ++k)
      sum += std::hypot(fused.frames.frames[k].x - truth[k].x, fused.frames.frames[k].y - truth[k].y);
    return sum / static_cast<double>(truth.size());
  }
};

TEST(FuseOdometry, ATenthOfTheLoopsAtRandomDoesLittleHarm) {
  double clean = 0, spoilt = 0;
  for (uint64_t seed = 1; seed <= 5; ++seed) {
    Laps laps(seed);
    clean += laps.error();
    NormalGenerator normal(seed, 1);
    std::size_t loops = 0;
    for (auto& link : laps.graph.links)
      if (link.loop && ++loops % 10 == 0) link.T_a_b = {10 * normal(), 10 * normal(), normal()};
    spoilt += laps.error();
  }
  EXPECT_LT(spoilt, 1.1 * clean) << clean << " " << spoilt;
}

}  // namespace
}  // namespace submap_slam::pose_graph
