#include <gtest/gtest.h>
#include <submap_slam/core/joined_map.h>
#include <tbb/global_control.h>

#include <Eigen/Dense>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;
using mrpt::poses::CPosePDFGaussian;

constexpr double kQuarterTurn = M_PI / 2;

CPosePDFGaussian gaussian(const TPose2D& mean, const Eigen::Matrix3d& cov = Eigen::Matrix3d::Zero()) {
  CPosePDFGaussian pdf;
  pdf.mean = mrpt::poses::CPose2D(mean);
  pdf.cov = cov;
  return pdf;
}

/** A submap of 2 m × 2 m with 0.1 m cells; set() fills cells. */
GridSubmap::Ptr emptySubmap() {
  auto submap = GridSubmap::Create();
  submap->evidence = EvidenceGrid(-1, 1, -1, 1, 0.1);
  return submap;
}

void set(GridSubmap& submap, double x, double y, float log_odds, float hits) {
  *submap.evidence.log_odds.cellByPos(x, y) = log_odds;
  *submap.evidence.hits.cellByPos(x, y) = hits;
}

float logOddsAt(const EvidenceGrid& map, double x, double y) {
  const float* cell = map.log_odds.cellByPos(x, y);
  return cell ? *cell : 0;
}
float hitsAt(const EvidenceGrid& map, double x, double y) {
  const float* cell = map.hits.cellByPos(x, y);
  return cell ? *cell : 0;
}

Eigen::Matrix3d someCovariance(double scale) {
  Eigen::Matrix3d cov;
  cov << 0.04, 0.01, 0.002, 0.01, 0.09, -0.003, 0.002, -0.003, 0.01;
  return scale * cov;
}

/** Covariance of a ∘ b by numerical derivatives. */
Eigen::Matrix3d composedCovariance(const CPosePDFGaussian& a, const CPosePDFGaussian& b) {
  Eigen::Matrix<double, 3, 6> jacobian;
  const double h = 1e-6;
  for (int k = 0; k < 6; ++k) {
    const auto composed = [&](double offset) {
      TPose2D first = a.mean.asTPose(), second = b.mean.asTPose();
      (k < 3 ? first : second)[static_cast<std::size_t>(k % 3)] += offset;
      return first + second;
    };
    const TPose2D high = composed(h), low = composed(-h);
    jacobian.col(k) = Eigen::Vector3d(high.x - low.x, high.y - low.y, high.phi - low.phi) / (2 * h);
  }
  Eigen::Matrix<double, 6, 6> cov = Eigen::Matrix<double, 6, 6>::Zero();
  cov.topLeftCorner<3, 3>() = a.cov.asEigen();
  cov.bottomRightCorner<3, 3>() = b.cov.asEigen();
  return jacobian * cov * jacobian.transpose();
}

GridSubmaps threeLinkedSubmaps() {
  GridSubmaps submaps{emptySubmap(), emptySubmap(), emptySubmap()};
  for (uint32_t k = 0; k < 3; ++k) {
    submaps[k]->id = 10 + k;
    submaps[k]->has_successor = k < 2;
  }
  submaps[0]->end_pose = gaussian({2, 1, 0.7}, someCovariance(1));
  submaps[1]->end_pose = gaussian({-1, 3, -0.4}, someCovariance(0.5));
  return submaps;
}

TEST(ChainSubmaps, ComposesEndPosesWithTheirCovariance) {
  const GridSubmaps submaps = threeLinkedSubmaps();
  const JoinedMap chain = chainSubmaps(submaps);
  ASSERT_EQ(chain.frames.size(), 3u);
  EXPECT_EQ(chain.status, JoinStatus::kChained);
  EXPECT_EQ(chain.frames[0].mean.asTPose(), TPose2D(0, 0, 0));
  EXPECT_EQ(chain.frames[0].cov.asEigen().norm(), 0);
  const TPose2D last = chain.frames[2].mean.asTPose();
  EXPECT_NEAR(last.x, 2 - std::cos(0.7) - 3 * std::sin(0.7), 1e-12);
  EXPECT_NEAR(last.y, 1 - std::sin(0.7) + 3 * std::cos(0.7), 1e-12);
  EXPECT_NEAR(last.phi, 0.3, 1e-12);
  EXPECT_LT((chain.frames[1].cov.asEigen() - submaps[0]->end_pose.cov.asEigen()).norm(), 1e-12);
  const Eigen::Matrix3d expected = composedCovariance(submaps[0]->end_pose, submaps[1]->end_pose);
  EXPECT_LT((chain.frames[2].cov.asEigen() - expected).norm(), 1e-7);
}

TEST(ChainSubmaps, ListsTheLinksById) {
  const JoinedMap chain = chainSubmaps(threeLinkedSubmaps());
  ASSERT_EQ(chain.constraints.size(), 2u);
  EXPECT_EQ(chain.constraints[1].from, 11u);
  EXPECT_EQ(chain.constraints[1].to, 12u);
  EXPECT_FALSE(chain.constraints[1].inter);
  EXPECT_TRUE(chain.constraints[1].accepted);
  EXPECT_EQ(chain.constraints[1].T_a_b.mean.asTPose(), TPose2D(-1, 3, -0.4));
}

TEST(ChainSubmaps, GoesOnAtTheLastPoseAcrossAGap) {
  GridSubmaps submaps = threeLinkedSubmaps();
  submaps[1]->has_successor = false;
  const JoinedMap chain = chainSubmaps(submaps);
  EXPECT_EQ(chain.constraints.size(), 1u);
  EXPECT_NEAR(chain.frames[2].mean.phi(), 0.3, 1e-12);
}

TEST(ChainSubmaps, OneSubmapLiesAtTheOrigin) {
  GridSubmap::Ptr only = emptySubmap();
  only->has_successor = true;  // its successor was not given
  const JoinedMap chain = chainSubmaps({only});
  EXPECT_EQ(chain.frames.size(), 1u);
  EXPECT_TRUE(chain.constraints.empty());
}

JoinedMap withFrames(const std::vector<mrpt::poses::CPosePDFGaussian>& frames) {
  JoinedMap joined;
  joined.frames = frames;
  return joined;
}

TEST(TrajectoryOf, PlacesTheNodesOfEverySubmap) {
  GridSubmaps submaps{emptySubmap(), emptySubmap()};
  SubmapNode node;
  node.stamp = mrpt::Clock::fromDouble(100);
  node.pose = {1, 0, 0.2};
  submaps[0]->nodes = {node};
  node.stamp = mrpt::Clock::fromDouble(101);
  node.pose = {0, 2, 0};
  submaps[1]->nodes = {node, node};
  const Trajectory trajectory =
      trajectoryOf(submaps, withFrames({gaussian({0, 0, 0}), gaussian({5, 1, kQuarterTurn})}));
  ASSERT_EQ(trajectory.size(), 3u);
  EXPECT_NEAR(trajectory[0].pose.x, 1, 1e-12);
  EXPECT_NEAR(trajectory[0].pose.phi, 0.2, 1e-12);
  EXPECT_NEAR(trajectory[1].pose.x, 3, 1e-12);
  EXPECT_NEAR(trajectory[1].pose.y, 1, 1e-12);
  EXPECT_EQ(trajectory[2].stamp, mrpt::Clock::fromDouble(101));
  EXPECT_THROW(trajectoryOf(submaps, withFrames({gaussian({0, 0, 0})})), std::invalid_argument);
}

TEST(TrajectoryOf, NodesThatAJoinerMovedAreWhereItPutThem) {
  GridSubmaps submaps{emptySubmap()};
  submaps[0]->nodes.resize(2);
  JoinedMap joined = withFrames({gaussian({5, 1, kQuarterTurn})});
  joined.nodes = {{{0, 0, 0}, {2, 0, 0.1}}};
  const Trajectory trajectory = trajectoryOf(submaps, joined);
  ASSERT_EQ(trajectory.size(), 2u);
  EXPECT_NEAR(trajectory[1].pose.x, 5, 1e-12);
  EXPECT_NEAR(trajectory[1].pose.y, 3, 1e-12);
  joined.nodes[0].pop_back();
  EXPECT_THROW(trajectoryOf(submaps, joined), std::invalid_argument);
}

TEST(OdometryOf, LeavesOutFramesWithoutOdometry) {
  std::vector<Frame> frames(3);
  for (std::size_t k = 0; k < frames.size(); ++k)
    frames[k].stamp = mrpt::Clock::fromDouble(100 + static_cast<double>(k));
  frames[0].odometry = TPose2D(1, 2, 0.3);
  frames[2].odometry = TPose2D(4, 5, 0.6);
  const Trajectory odometry = odometryOf(frames);
  ASSERT_EQ(odometry.size(), 2u);
  EXPECT_EQ(odometry[0].pose, TPose2D(1, 2, 0.3));
  EXPECT_EQ(odometry[1].pose, TPose2D(4, 5, 0.6));
  EXPECT_EQ(odometry[1].stamp, frames[2].stamp);
  EXPECT_TRUE(odometryOf({}).empty());
}

TEST(FuseEvidence, OneSubmapIsItsOwnMap) {
  auto submap = emptySubmap();
  set(*submap, 0.25, 0.35, 3.5f, 4);
  set(*submap, -0.45, 0.05, -2, 7);
  const EvidenceGrid map = fuseEvidence({submap}, {gaussian({0, 0, 0})}, 0).unpacked();
  EXPECT_NEAR(map.resolution(), 0.1, 1e-12);
  EXPECT_EQ(map.observedCells(), 2u);
  EXPECT_NEAR(logOddsAt(map, 0.25, 0.35), 3.5, 1e-5);
  EXPECT_NEAR(hitsAt(map, 0.25, 0.35), 4, 1e-5);
  EXPECT_NEAR(logOddsAt(map, -0.45, 0.05), -2, 1e-5);
}

TEST(FuseEvidence, WeighsSubmapsAsInEquation15) {
  auto a = emptySubmap(), b = emptySubmap();
  set(*a, 0.25, 0.35, 6, 2);
  set(*b, 0.35, -0.25, 5, 1);  // turned by a quarter: lands on (0.25, 0.35)
  const EvidenceGrid map =
      fuseEvidence({a, b}, {gaussian({0, 0, 0}), gaussian({0, 0, kQuarterTurn})}, 0).unpacked();
  // omega = 2/3 and 1/3: (2/3 · 6 + 1/3 · 5) / (4/9 + 1/9)
  EXPECT_NEAR(logOddsAt(map, 0.25, 0.35), (17.0 / 3) / (5.0 / 9), 1e-5);
  EXPECT_NEAR(hitsAt(map, 0.25, 0.35), 3, 1e-5);
  EXPECT_EQ(map.observedCells(), 1u);
}

TEST(FuseEvidence, ConsistentEvidenceAddsUp) {
  auto a = emptySubmap(), b = emptySubmap();
  set(*a, 0.25, 0.35, 6, 2);
  set(*b, 0.25, 0.35, 15, 5);
  const EvidenceGrid map = fuseEvidence({a, b}, {gaussian({0, 0, 0}), gaussian({0, 0, 0})}, 0).unpacked();
  EXPECT_NEAR(logOddsAt(map, 0.25, 0.35), 21, 1e-4);
}

TEST(FuseEvidence, InterpolatesBetweenCells) {
  auto submap = emptySubmap();
  set(*submap, 0.05, 0.05, 4, 4);
  const EvidenceGrid map = fuseEvidence({submap}, {gaussian({0.025, 0.05, 0})}, 0).unpacked();
  EXPECT_EQ(map.observedCells(), 4u);
  EXPECT_NEAR(hitsAt(map, 0.05, 0.05), 4 * 0.75 * 0.5, 1e-4);
  EXPECT_NEAR(hitsAt(map, 0.15, 0.05), 4 * 0.25 * 0.5, 1e-4);
  EXPECT_NEAR(hitsAt(map, 0.15, 0.15), 4 * 0.25 * 0.5, 1e-4);
  EXPECT_NEAR(logOddsAt(map, 0.05, 0.15), 4 * 0.75 * 0.5, 1e-4);
}

TEST(FuseEvidence, ReachesTheBorderOfTheGridAndFarFrames) {
  auto submap = emptySubmap();
  set(*submap, -0.95, -0.95, 1, 1);
  set(*submap, 0.95, 0.95, 2, 1);
  const EvidenceGrid map = fuseEvidence({submap}, {gaussian({-300, 200, 0})}, 0.1).unpacked();
  EXPECT_NEAR(logOddsAt(map, -300.95, 199.05), 1, 1e-4);
  EXPECT_NEAR(logOddsAt(map, -299.05, 200.95), 2, 1e-4);
  EXPECT_LE(map.cells(), 21u * 21u);
}

TEST(FuseEvidence, TakesTheAskedOrTheFinestResolution) {
  auto coarse = GridSubmap::Create();
  coarse->evidence = EvidenceGrid(-1, 1, -1, 1, 0.2);
  set(*coarse, 0.1, 0.1, 1, 1);
  auto fine = emptySubmap();
  set(*fine, 0.05, 0.05, 1, 1);
  const std::vector<CPosePDFGaussian> frames{gaussian({0, 0, 0}), gaussian({0, 0, 0})};
  EXPECT_NEAR(fuseEvidence({coarse, fine}, frames, 0).resolution(), 0.1, 1e-12);
  EXPECT_NEAR(fuseEvidence({coarse, fine}, frames, 0.05).resolution(), 0.05, 1e-12);
}

TEST(FuseEvidence, AFrameAlmostParallelToTheAxesIsLikeAParallelOne) {
  GridSubmaps submaps{emptySubmap(), emptySubmap()};
  set(*submaps[0], 0.05, 0.05, 1, 1);
  set(*submaps[1], 0.05, 0.05, 2, 1);
  for (const double phi : {1e-7, -1e-8, 1e-10}) {
    const EvidenceGrid map = fuseEvidence(submaps, {gaussian({}), gaussian({4, 40, phi})}, 0.1).unpacked();
    EXPECT_NEAR(logOddsAt(map, 0.05, 0.05), 1, 1e-5);
    EXPECT_NEAR(logOddsAt(map, 4.05, 40.05), 2, 1e-4);
  }
}

TEST(FuseEvidence, AHugeMapIsMadeCoarserUnlessAskedFor) {
  GridSubmaps submaps{emptySubmap(), emptySubmap()};
  for (const auto& submap : submaps) set(*submap, 0.05, 0.05, 1, 1);
  const EvidenceGrid map = fuseEvidence(submaps, {gaussian({}), gaussian({600, 500, 0})}, 0).unpacked();
  EXPECT_DOUBLE_EQ(map.resolution(), 0.2);
  EXPECT_EQ(fuseEvidence(submaps, {gaussian({}), gaussian({60, 50, 0})}, 0).resolution(), 0.1);
}

TEST(FuseEvidence, AMapWithSeveralTilesHasNoSeam) {
  auto far = emptySubmap(), here = emptySubmap();
  set(*here, 0.05, 0.05, 1, 1);
  const auto value = [](int x, int y) { return static_cast<float>(1 + x + 20 * y); };
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 20; ++x) set(*far, -0.95 + 0.1 * x, -0.95 + 0.1 * y, value(x, y), 2);
  // The first tile ends 1024 cells from the left edge of the map, in the middle of the far submap.
  const TPose2D frame(101.3, 0, 0);
  const PackedEvidence fused = fuseEvidence({here, far}, {gaussian({0, 0, 0}), gaussian(frame)}, 0.1);
  const EvidenceGrid map = fused.unpacked();
  EXPECT_EQ(map.observedCells(), 401u);
  EXPECT_EQ(fused.bytes(), PackedEvidence(map).bytes());  // nothing for blocks that nobody saw
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 20; ++x)
      EXPECT_NEAR(logOddsAt(map, frame.x - 0.95 + 0.1 * x, -0.95 + 0.1 * y), value(x, y), 1e-3);
}

TEST(FuseEvidence, NothingObservedGivesNoObservedCell) {
  EXPECT_EQ(fuseEvidence({emptySubmap()}, {gaussian({0, 0, 0})}, 0.1).observedCells(), 0u);
  EXPECT_EQ(fuseEvidence({}, {}, 0.1).observedCells(), 0u);
  EXPECT_THROW(fuseEvidence({emptySubmap()}, {}, 0.1), std::invalid_argument);
}

TEST(FuseEvidence, SameBitsForAnyNumberOfThreads) {
  GridSubmaps submaps{emptySubmap(), emptySubmap(), emptySubmap()};
  std::vector<CPosePDFGaussian> frames;
  for (std::size_t k = 0; k < submaps.size(); ++k) {
    EvidenceGrid& grid = submaps[k]->evidence;
    for (std::size_t c = 0; c < grid.cells(); ++c) {
      const auto cell = static_cast<std::ptrdiff_t>(c);
      grid.log_odds.begin()[cell] = static_cast<float>(std::sin(static_cast<double>(c * (k + 1))));
      grid.hits.begin()[cell] = 1.5f + static_cast<float>(std::cos(static_cast<double>(c)));
    }
    frames.push_back(gaussian({0.3 * static_cast<double>(k), 0.1, 0.4 * static_cast<double>(k)}));
  }
  const auto with = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return fuseEvidence(submaps, frames, 0.07).unpacked();
  };
  const EvidenceGrid one = with(1), two = with(2);
  EXPECT_GT(one.observedCells(), 400u);
  EXPECT_EQ(one.log_odds.data(), two.log_odds.data());
  EXPECT_EQ(one.hits.data(), two.hits.data());
}

TEST(JoinStatus, EveryStatusHasItsOwnName) {
  std::set<std::string> names;
  for (const JoinStatus status : {JoinStatus::kChained, JoinStatus::kConverged, JoinStatus::kIterationLimit,
                                  JoinStatus::kNothingToJoin, JoinStatus::kFailed})
    names.insert(toString(status));
  EXPECT_EQ(names.size(), 5u);
}

}  // namespace
}  // namespace submap_slam
