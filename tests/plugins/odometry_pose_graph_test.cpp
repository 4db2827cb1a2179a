#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/math/wrap2pi.h>
#include <submap_slam/core/edits.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>

#include <submap_slam/core/relative_pose.h>
#include "../mapping/mapped_log.h"
#include "odometry_pose_graph/frame_covariances.h"
#include "odometry_pose_graph/loop_search.h"
#include "odometry_pose_graph/odometry_pose_graph.h"
#include "odometry_pose_graph/residuals.h"

namespace submap_slam::pose_graph {
namespace {

using mrpt::math::TPose2D;

const TPose2D kA(1, -2, 3.0), kB(2.5, 0.5, -2.9), kT(0.3, -1.2, 0.7);

Eigen::Matrix3d someCovariance() {
  Eigen::Matrix3d cov;
  cov << 0.04, 0.01, 0.002, 0.01, 0.09, -0.003, 0.002, -0.003, 0.01;
  return cov;
}

TEST(RelationError, JacobiansAreFiniteDifferences) {
  const RelationError at = relationError(kA, kB, kT);
  const double h = 1e-6;
  for (int k = 0; k < 3; ++k) {
    const auto moved = [k](TPose2D pose, double step) {
      (k == 0 ? pose.x : k == 1 ? pose.y : pose.phi) += step;
      return pose;
    };
    const Eigen::Vector3d a =
        (relationError(moved(kA, h), kB, kT).e - relationError(moved(kA, -h), kB, kT).e) / (2 * h);
    const Eigen::Vector3d b =
        (relationError(kA, moved(kB, h), kT).e - relationError(kA, moved(kB, -h), kT).e) / (2 * h);
    EXPECT_LT((at.to_a.col(k) - a).norm(), 1e-8);
    EXPECT_LT((at.to_b.col(k) - b).norm(), 1e-8);
  }
}

TEST(RelationError, VanishesForTheMeasuredRelation) {
  EXPECT_LT(relationError(kA, kA + kT, kT).e.norm(), 1e-12);
}

/** With a non-diagonal information matrix L and Lᵀ differ. */
TEST(RelationResidual, SquaredNormIsTheErrorInTheMetricOfTheInformation) {
  const Eigen::Matrix3d root = squareRootInformation(someCovariance());
  const RelationResidual residual(kT, root);
  const PoseBlock a(kA), b(kB);
  Eigen::Vector3d r;
  residual(a.values, b.values, r.data());
  const Eigen::Vector3d e = relationError(kA, kB, kT).e;
  EXPECT_NEAR(r.squaredNorm(), e.dot(someCovariance().inverse() * e), 1e-9);
}

/** A square walked once, with a loop closed at its end. */
FrameGraph square() {
  FrameGraph graph;
  graph.frames.push_back({});
  const TPose2D side(4, 0.1, M_PI / 2 + 0.02);
  for (std::size_t k = 0; k < 4; ++k) {
    graph.links.push_back({k, k + 1, side, someCovariance(), someCovariance(), false});
    graph.frames.push_back(graph.frames.back() + side);
  }
  graph.links.push_back({4, 0, {0.05, 0.02, 0.01}, 0.1 * someCovariance(), 0.1 * someCovariance(), true});
  return graph;
}

TEST(FrameCovariances, AreThoseOfTheDenseInverse) {
  const FrameGraph graph = square();
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(15, 15);
  for (const Link& link : graph.links) {
    const RelationError at = relationError(graph.frames[link.from], graph.frames[link.to], link.T_a_b);
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(3, 15);
    J.middleCols(3 * static_cast<Eigen::Index>(link.from), 3) = at.to_a;
    J.middleCols(3 * static_cast<Eigen::Index>(link.to), 3) = at.to_b;
    Eigen::Matrix3d weight = link.covariance.inverse();
    if (link.loop) weight /= 1 + at.e.dot(weight * at.e);
    information += J.transpose() * weight * J;
  }
  const Eigen::MatrixXd dense = information.bottomRightCorner(12, 12).inverse();
  const FrameCovariances covariances(graph);
  for (Eigen::Index i = 0; i < 4; ++i)
    for (Eigen::Index k = 0; k < 4; ++k)
      EXPECT_LT((covariances.block(static_cast<std::size_t>(i + 1), static_cast<std::size_t>(k + 1)) -
                 dense.block<3, 3>(3 * i, 3 * k))
                    .norm(),
                1e-9);
  EXPECT_TRUE(covariances.block(0, 3).isZero());
}

TEST(FrameCovariances, OfARelationSeenFromTheOtherEnd) {
  FrameGraph graph;
  graph.frames = {{}, kT};
  graph.links.push_back({0, 1, kT, someCovariance(), someCovariance(), false});
  const FrameCovariances covariances(graph);
  EXPECT_LT((covariances.relative({0, 1}) - someCovariance()).norm(), 1e-9);
  const RelationError back = relationError(kT, {}, TPose2D() - kT);
  const Eigen::Matrix3d seen = back.to_a * covariances.block(1, 1) * back.to_a.transpose();
  EXPECT_LT((covariances.relative({1, 0}) - seen).norm(), 1e-9);
}

TEST(FrameGraph, ClosesTheLoopAndKeepsTheFirstFrame) {
  FrameGraph graph = square();
  graph.optimise();
  EXPECT_EQ(graph.frames.front(), TPose2D());
  EXPECT_LT(relationError(graph.frames[4], graph.frames[0], graph.links.back().T_a_b).e.norm(), 0.1);
}

TEST(FrameGraph, AWrongLoopIsOutvoted) {
  FrameGraph right = square(), wrong = square();
  wrong.links.push_back({3, 1, {50, -20, 2}, 0.01 * someCovariance(), 0.01 * someCovariance(), true});
  right.optimise();
  wrong.optimise();
  for (std::size_t k = 0; k < right.frames.size(); ++k)
    EXPECT_LT(std::hypot(right.frames[k].x - wrong.frames[k].x, right.frames[k].y - wrong.frames[k].y), 0.1);
}

/** More than a lap around a block; the chain is bent at one submap, as if the mapper had slipped there. */
struct BentLoop {
  SimulatedLog log;
  GridSubmaps submaps;

  explicit BentLoop(double turn) {
    submap_slam::OdometryModel odometry;
    World world = loopWorld();
    log = simulateRoute(world, 90, odometry, 5);
    StretchParams params;
    params.max_distance = 6;
    submaps = mapLog(log.frames, {}, 1, params);
    uint32_t id = 0;
    for (const auto& submap : submaps) {
      submap->id = id++;
      const TPose2D end = submap->end_pose.mean.asTPose();
      if (submap->id == 3) submap->end_pose.mean = mrpt::poses::CPose2D(end.x, end.y, end.phi + turn);
      for (auto& node : submap->nodes) node.odometry.reset();
    }
  }

  /** Largest distance of a frame from the truth (m). */
  double worst(const std::vector<TPose2D>& frames) const {
    double worst = 0;
    for (std::size_t k = 0; k < submaps.size(); ++k) {
      const TPose2D truth = log.truth[submaps[k]->first_frame].pose - log.truth.front().pose;
      worst = std::max(worst, std::hypot(frames[k].x - truth.x, frames[k].y - truth.y));
    }
    return worst;
  }
};

std::vector<TPose2D> meansOf(const JoinedMap& joined) {
  std::vector<TPose2D> frames;
  for (const auto& frame : joined.frames) frames.push_back(frame.mean.asTPose());
  return frames;
}

TEST(LoopSearch, StraightensABentChain) {
  const BentLoop loop(0.06);
  const double bent = loop.worst(meansOf(chainSubmaps(loop.submaps)));
  ASSERT_GT(bent, 0.8);
  const auto found = LoopSearch({}).search(loop.submaps, {});
  EXPECT_LT(loop.worst(found.graph.frames), 0.5 * bent);
  for (const auto& c : found.candidates) {
    EXPECT_FALSE(c.reason.empty());
    if (!c.accepted) continue;
    const TPose2D truth = loop.log.truth[loop.submaps[c.to]->first_frame].pose -
                          loop.log.truth[loop.submaps[c.from]->first_frame].pose;
    EXPECT_LT(std::hypot(c.T_a_b.mean.x() - truth.x, c.T_a_b.mean.y() - truth.y), 0.3)
        << c.from << " " << c.to;
  }
}

TEST(LoopSearch, StopsWhenAskedTo) {
  const BentLoop loop(0);
  const auto found = LoopSearch({}).search(loop.submaps, [](double) { return false; });
  EXPECT_EQ(found.graph.frames.size(), loop.submaps.size());
  EXPECT_TRUE(found.candidates.empty());
  EXPECT_TRUE(found.stopped);
  EXPECT_FALSE(LoopSearch({}).search(loop.submaps, {}).stopped);
}

TEST(LoopSearch, AGapInTheLogSaysNothingOfTheNextSubmap) {
  const BentLoop loop(0);
  loop.submaps[2]->has_successor = false;
  const LoopSearchParams params;
  const auto found = LoopSearch(params).search(loop.submaps, [](double) { return false; });
  EXPECT_GE(found.graph.links[2].covariance(0, 0), 1e4);
  EXPECT_LT(found.graph.links[1].covariance(0, 0), 1);
}

TEST(LoopSearch, SubmapsWithoutNodesAreOnlyChained) {
  const BentLoop loop(0);
  loop.submaps[1]->nodes.clear();
  const auto found = LoopSearch({}).search(loop.submaps, {});
  EXPECT_EQ(found.graph.frames.size(), loop.submaps.size());
  for (const auto& frame : found.graph.frames) EXPECT_TRUE(std::isfinite(frame.x + frame.y + frame.phi));
  for (const auto& c : found.candidates) EXPECT_FALSE(c.accepted && (c.from == 1 || c.to == 1));
}

TEST(OdometryPoseGraph, GivesFramesConstraintsAndAReason) {
  const BentLoop loop(0.03);
  const OdometryPoseGraph joiner;
  const JoinedMap joined = joiner.join(loop.submaps, chainSubmaps(loop.submaps), {});
  EXPECT_EQ(joined.status, JoinStatus::kConverged);
  EXPECT_THAT(joined.reason, ::testing::HasSubstr("accepted"));
  ASSERT_EQ(joined.frames.size(), loop.submaps.size());
  EXPECT_TRUE(joined.frames.front().cov.asEigen().isZero());
  EXPECT_GT(joined.frames.back().cov(0, 0), 0);
  const auto chain = std::count_if(joined.constraints.begin(), joined.constraints.end(),
                                   [](const Constraint& c) { return !c.inter; });
  EXPECT_EQ(static_cast<std::size_t>(chain), loop.submaps.size() - 1);
}

TEST(OdometryPoseGraph, AGapInTheLogIsNoConstraint) {
  const BentLoop loop(0);
  loop.submaps[2]->has_successor = false;
  const JoinedMap joined = OdometryPoseGraph().join(loop.submaps, chainSubmaps(loop.submaps), {});
  for (const auto& c : joined.constraints) EXPECT_FALSE(!c.inter && c.from == 2);
}

TEST(OdometryPoseGraph, OneSubmapIsNothingToJoin) {
  const BentLoop loop(0);
  const GridSubmaps one{loop.submaps.front()};
  const JoinedMap joined = OdometryPoseGraph().join(one, chainSubmaps(one), {});
  EXPECT_EQ(joined.status, JoinStatus::kNothingToJoin);
  EXPECT_EQ(joined.frames.size(), 1u);
}

void expectSameBits(const JoinedMap& a, const JoinedMap& b) {
  EXPECT_EQ(a.reason, b.reason);
  EXPECT_EQ(a.nodes, b.nodes);
  ASSERT_EQ(a.frames.size(), b.frames.size());
  for (std::size_t k = 0; k < a.frames.size(); ++k) {
    EXPECT_EQ(a.frames[k].mean.asTPose(), b.frames[k].mean.asTPose()) << k;
    EXPECT_EQ(a.frames[k].cov.asEigen(), b.frames[k].cov.asEigen()) << k;
  }
  ASSERT_EQ(a.constraints.size(), b.constraints.size());
  for (std::size_t c = 0; c < a.constraints.size(); ++c) {
    EXPECT_EQ(a.constraints[c].T_a_b.mean.asTPose(), b.constraints[c].T_a_b.mean.asTPose()) << c;
    EXPECT_EQ(a.constraints[c].T_a_b.cov.asEigen(), b.constraints[c].T_a_b.cov.asEigen()) << c;
    EXPECT_EQ(a.constraints[c].reason, b.constraints[c].reason) << c;
  }
}

TEST(OdometryPoseGraph, AddingSubmapsGivesWhatAllAtOnceGive) {
  const BentLoop loop(0.03);
  const OdometryPoseGraph joiner;
  const auto growing = joiner.incremental();
  for (const std::size_t count : {std::size_t{1}, std::size_t{3}, loop.submaps.size(), loop.submaps.size()}) {
    const GridSubmaps some(loop.submaps.begin(), loop.submaps.begin() + static_cast<std::ptrdiff_t>(count));
    const JoinedMap initial = chainSubmaps(some);
    expectSameBits(growing->join(some, initial, {}), joiner.join(some, initial, {}));
  }
}

TEST(OdometryPoseGraph, ShowsItsFramesOnTheWayAndGivesTheSameResult) {
  const BentLoop loop(0.03);
  const JoinedMap initial = chainSubmaps(loop.submaps);
  std::vector<std::vector<TPose2D>> shown;
  const ProgressCallback progress([](double, const std::string&) { return true; },
                                  [&shown](const std::vector<TPose2D>& frames) { shown.push_back(frames); });
  const JoinedMap joined = OdometryPoseGraph().join(loop.submaps, initial, progress);
  ASSERT_GT(shown.size(), loop.submaps.size());  // of the search, then of the fusion
  for (const auto& frames : shown) EXPECT_EQ(frames.size(), loop.submaps.size());
  EXPECT_NEAR(shown.front().back().y, initial.frames.back().mean.y(), 1e-9);  // nothing is found yet
  for (std::size_t k = 0; k < loop.submaps.size(); ++k)
    EXPECT_NEAR(shown.back()[k].y, joined.frames[k].mean.y(), 1e-9);
  expectSameBits(joined, OdometryPoseGraph().join(loop.submaps, initial, {}));
}

TEST(OdometryPoseGraph, GoesOnAfterAStop) {
  const BentLoop loop(0.03);
  const OdometryPoseGraph joiner;
  const JoinedMap initial = chainSubmaps(loop.submaps);
  const auto growing = joiner.incremental();
  const auto stop = [](double, const std::string&) { return false; };
  EXPECT_THAT(growing->join(loop.submaps, initial, stop).reason, ::testing::HasSubstr("stopped"));
  expectSameBits(growing->join(loop.submaps, initial, {}), joiner.join(loop.submaps, initial, {}));
}

/** A loop closure that the joiner finds by itself. */
Constraint acceptedLoop(const JoinedMap& joined) {
  for (const auto& c : joined.constraints)
    if (c.inter && c.accepted) return c;
  ADD_FAILURE() << "no loop closure";
  return {};
}

const Constraint* constraintBetween(const JoinedMap& joined, uint32_t from, uint32_t to) {
  for (const auto& c : joined.constraints)
    if (c.inter && c.from == from && c.to == to) return &c;
  return nullptr;
}

JoinedMap joinWith(const GridSubmaps& submaps, const Constraint& by_hand) {
  JoinedMap initial = chainSubmaps(submaps);
  initial.constraints.push_back(by_hand);
  initial.constraints.back().by_hand = true;
  return OdometryPoseGraph().join(submaps, initial, {});
}

Constraint relation(uint32_t from, uint32_t to, const TPose2D& T_a_b, double sigma) {
  Constraint c;
  c.from = from;
  c.to = to;
  c.inter = true;
  c.T_a_b.mean = mrpt::poses::CPose2D(T_a_b);
  c.T_a_b.cov.setDiagonal(3, sigma * sigma);
  c.reason = "added by hand";
  return c;
}

TEST(OdometryPoseGraph, NeverUsesALoopThatIsRejectedByHand) {
  const BentLoop loop(0.03);
  const Constraint found =
      acceptedLoop(OdometryPoseGraph().join(loop.submaps, chainSubmaps(loop.submaps), {}));
  Constraint rejected = relation(found.to, found.from, {}, 0);  // a pair has no direction
  rejected.accepted = false;
  const JoinedMap joined = joinWith(loop.submaps, rejected);
  const Constraint* entry = constraintBetween(joined, found.from, found.to);
  ASSERT_TRUE(entry);
  EXPECT_FALSE(entry->accepted);
  EXPECT_TRUE(entry->by_hand) << "for the joiners behind it";
  EXPECT_EQ(entry->reason, "rejected by hand");
  EXPECT_EQ(entry->T_a_b.mean.asTPose(), found.T_a_b.mean.asTPose()) << "what would have been used";
  EXPECT_FALSE(constraintBetween(joined, found.to, found.from)) << "listed once";
}

TEST(OdometryPoseGraph, ListsARejectedLoopThatItDidNotFind) {
  const BentLoop loop(0);
  Constraint rejected = relation(0, 2, {}, 0);
  rejected.accepted = false;
  const JoinedMap joined = joinWith(loop.submaps, rejected);
  const Constraint* entry = constraintBetween(joined, 0, 2);
  ASSERT_TRUE(entry);
  EXPECT_FALSE(entry->accepted);
  EXPECT_THAT(entry->reason, ::testing::HasSubstr("rejected by hand; the search found no such loop"));
}

/** Against all that scans, loops and odometry say: they can be outvoted, the user cannot. */
TEST(OdometryPoseGraph, AConstraintByHandIsCertain) {
  const BentLoop loop(0);
  const auto last = static_cast<uint32_t>(loop.submaps.size() - 1);
  const auto before = meansOf(OdometryPoseGraph().join(loop.submaps, chainSubmaps(loop.submaps), {}));
  const TPose2D elsewhere = before[last] + TPose2D(3, -2, 0.4);
  for (const bool forwards : {true, false}) {
    const JoinedMap joined =
        joinWith(loop.submaps, forwards ? relation(0, last, elsewhere, 0.001)
                                        : relation(last, 0, TPose2D() - elsewhere, 0.001));
    const TPose2D off = meansOf(joined)[last] - elsewhere;
    EXPECT_LT(std::hypot(off.x, off.y), 0.05);
    EXPECT_LT(std::abs(mrpt::math::wrapToPi(off.phi)), 0.02);
    const Constraint* entry = constraintBetween(joined, forwards ? 0 : last, forwards ? last : 0);
    ASSERT_TRUE(entry);
    EXPECT_TRUE(entry->accepted && entry->by_hand);
    EXPECT_EQ(entry->reason, "added by hand");
    EXPECT_NEAR(entry->T_a_b.cov(0, 0), 1e-6, 1e-12) << "no weight is taken from it";
  }
}

TEST(OdometryPoseGraph, AMaskedSubmapOnlyFollowsTheChain) {
  const BentLoop loop(0);
  const uint32_t id =
      acceptedLoop(OdometryPoseGraph().join(loop.submaps, chainSubmaps(loop.submaps), {})).from;
  Edits edits;
  edits.list.emplace_back().to = id;
  const GridSubmaps masked = maskSubmaps(loop.submaps, edits);
  const JoinedMap joined = OdometryPoseGraph().join(masked, chainSubmaps(masked), {});
  for (const auto& c : joined.constraints)
    EXPECT_FALSE(c.inter && (c.from == id || c.to == id)) << c.from << " " << c.to << " " << c.reason;
  EXPECT_LT(loop.worst(meansOf(joined)), 0.3);
}

}  // namespace
}  // namespace submap_slam::pose_graph
