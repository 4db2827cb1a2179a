#include <gtest/gtest.h>
#include <submap_slam/mapping/node_refinement.h>
#include <tbb/global_control.h>

#include <random>
#include <stdexcept>

#include "mapped_log.h"

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;
using mrpt::poses::CPose2D;

const SimulatedLog& roomLog() {
  static const SimulatedLog log = simulateRoute(roomWorld(), 25, OdometryModel{}, 1);
  return log;
}

const GridSubmaps& roomSubmaps() {
  static const GridSubmaps submaps = [] {
    StretchParams stretching;
    stretching.max_distance = 6;
    GridSubmaps made = mapLog(roomLog().frames, {}, 1, stretching);
    for (std::size_t k = 0; k < made.size(); ++k) made[k]->id = static_cast<uint32_t>(k);
    return made;
  }();
  return submaps;
}

/** True pose of a frame in the map frame, that of the first frame. */
TPose2D truePose(std::size_t frame) { return roomLog().truth[frame].pose - roomLog().truth[0].pose; }

/** Frames at the truth, one exact constraint, and nodes a bit off wherever submaps drift. */
JoinedMap disturbed(double sigma_xy, double sigma_phi) {
  JoinedMap joined = chainSubmaps(roomSubmaps());
  joined.constraints.clear();
  std::mt19937 random(1);
  std::normal_distribution<double> xy(0, sigma_xy), phi(0, sigma_phi);
  for (std::size_t k = 0; k < roomSubmaps().size(); ++k) {
    const GridSubmap& submap = *roomSubmaps()[k];
    joined.frames[k].mean = CPose2D(truePose(submap.first_frame));
    auto& nodes = joined.nodes.emplace_back();
    for (std::size_t i = 0; i < submap.nodes.size(); ++i) {
      const TPose2D local = trueLocalPose(roomLog().truth, submap, submap.first_frame + i);
      nodes.push_back(i == 0 ? local : local + TPose2D(xy(random), xy(random), phi(random)));
    }
  }
  Constraint loop;
  loop.from = 0;
  loop.to = 2;
  loop.T_a_b.mean = joined.frames[2].mean - joined.frames[0].mean;
  joined.constraints.push_back(loop);
  return joined;
}

/** Mean distance of the key nodes from the truth (m), by the trajectory. */
double meanKeyError(const GridSubmaps& submaps, const JoinedMap& joined) {
  double sum = 0;
  std::size_t n = 0;
  for (std::size_t k = 0; k < submaps.size(); ++k) {
    const auto poses = nodePosesOf(submaps, joined, k);
    for (std::size_t i = 0; i < poses.size(); ++i, ++n) {
      if (!submaps[k]->nodes[i].isKey()) continue;
      const TPose2D pose = joined.frames[k].mean.asTPose() + poses[i];
      sum += poseError(pose, truePose(submaps[k]->first_frame + i)).distance();
    }
  }
  return sum / static_cast<double>(n);
}

NodeRefinementParams oneRound() {
  NodeRefinementParams params;
  params.rounds = 1;
  return params;
}

TEST(NodeRefinement, BringsScatteredNodesTogether) {
  const JoinedMap before = disturbed(0.03, 0.01);
  const RefinedSubmaps after = refineNodes(roomSubmaps(), before, {}, oneRound());
  EXPECT_LT(meanKeyError(after.submaps, after.joined), 0.35 * meanKeyError(roomSubmaps(), before));
  EXPECT_GT(after.mean_move, 0.01);
  EXPECT_GE(after.max_move, after.mean_move);
}

TEST(NodeRefinement, LeavesGoodNodesWhereTheyAre) {
  const RefinedSubmaps after = refineNodes(roomSubmaps(), disturbed(0, 0), {}, oneRound());
  EXPECT_LT(after.mean_move, 0.005);
  EXPECT_LT(meanKeyError(after.submaps, after.joined), 0.01);
}

TEST(NodeRefinement, KeepsWhatSubmapsPromise) {
  const RefinedSubmaps after = refineNodes(roomSubmaps(), disturbed(0.03, 0.01), {}, oneRound());
  ASSERT_EQ(after.submaps.size(), roomSubmaps().size());
  EXPECT_EQ(after.joined.frames[0].mean.asTPose(), TPose2D());
  EXPECT_TRUE(after.joined.nodes.empty());
  for (std::size_t k = 0; k < after.submaps.size(); ++k) {
    const GridSubmap &now = *after.submaps[k], &was = *roomSubmaps()[k];
    EXPECT_EQ(now.id, was.id);
    EXPECT_EQ(now.first_frame, was.first_frame);
    EXPECT_EQ(now.end_frame, was.end_frame);
    EXPECT_EQ(now.nodes.size(), was.nodes.size());
    EXPECT_EQ(now.keyNodes(), was.keyNodes());
    EXPECT_EQ(now.resolution(), was.resolution());
    EXPECT_NEAR(now.nodes.front().pose.norm(), 0, 1e-12) << "the local map frame is the first node";
    EXPECT_NEAR(static_cast<double>(now.evidenceSummary().observed_cells),
                static_cast<double>(was.evidenceSummary().observed_cells),
                0.1 * static_cast<double>(was.evidenceSummary().observed_cells));
  }
}

TEST(NodeRefinement, EndPosesAndConstraintsFollowTheFrames) {
  const RefinedSubmaps after = refineNodes(roomSubmaps(), disturbed(0.03, 0.01), {}, oneRound());
  const auto& frames = after.joined.frames;
  for (std::size_t k = 0; k + 1 < frames.size(); ++k) {
    const PoseError error =
        poseError(after.submaps[k]->end_pose.mean.asTPose(), (frames[k + 1].mean - frames[k].mean).asTPose());
    EXPECT_NEAR(error.distance() + std::abs(error.phi), 0, 1e-9) << k;
  }
  // What agreed with the frames before does so after.
  const PoseError loop = poseError(after.joined.constraints[0].T_a_b.mean.asTPose(),
                                   (frames[2].mean - frames[0].mean).asTPose());
  EXPECT_NEAR(loop.distance() + std::abs(loop.phi), 0, 1e-9);
}

TEST(NodeRefinement, SameBitsForAnyNumberOfThreads) {
  const auto run = [](std::size_t threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    return refineNodes(roomSubmaps(), disturbed(0.03, 0.01), {}, oneRound());
  };
  const RefinedSubmaps a = run(1), b = run(4);
  for (std::size_t k = 0; k < a.submaps.size(); ++k)
    for (std::size_t i = 0; i < a.submaps[k]->nodes.size(); ++i)
      EXPECT_EQ(a.submaps[k]->nodes[i].pose, b.submaps[k]->nodes[i].pose);
}

TEST(NodeRefinement, SubmapsWithoutScansStayAsTheyAre) {
  auto bare = GridSubmap::Create();
  bare->nodes.push_back({{}, {}, std::nullopt, {}});
  bare->nodes.push_back({{}, {1, 2, 0.5}, std::nullopt, {}});
  bare->end_pose.mean = CPose2D(1, 2, 0.5);
  const GridSubmaps submaps{bare};
  const RefinedSubmaps after = refineNodes(submaps, chainSubmaps(submaps), {}, oneRound());
  ASSERT_EQ(after.submaps.size(), 1u);
  EXPECT_EQ(after.submaps[0]->nodes[1].pose, bare->nodes[1].pose);
  EXPECT_EQ(after.mean_move, 0);
  EXPECT_TRUE(refineNodes({}, {}, {}, oneRound()).submaps.empty());
}

TEST(NodeRefinement, RefusesFramesOfOtherSubmaps) {
  JoinedMap joined = disturbed(0, 0);
  joined.frames.pop_back();
  EXPECT_THROW(refineNodes(roomSubmaps(), joined, {}, oneRound()), std::invalid_argument);
}

}  // namespace
}  // namespace submap_slam
