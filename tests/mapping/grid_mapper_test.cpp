#include <gtest/gtest.h>
#include <submap_slam/mapping/rbpf_grid_mapper.h>
#include <submap_slam/mapping/stray_scans.h>
#include <tbb/parallel_for.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "mapped_log.h"

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;

/** The first metres of the room log, with odometry as bad as an old robot's. */
const SimulatedLog& roomLog() {
  static const SimulatedLog log = simulateRoute(roomWorld(), 25, OdometryModel{}, 1);
  return log;
}

StretchParams shortStretches() {
  StretchParams params;
  params.max_distance = 6;
  return params;
}

const GridSubmaps& roomSubmaps() {
  static const GridSubmaps submaps = mapLog(roomLog().frames, {}, 1, shortStretches());
  return submaps;
}

TEST(GridMapper, SubmapsHoldEveryFrameOnce) {
  expectConsistent(roomSubmaps(), roomLog().frames.size());
  EXPECT_GE(roomSubmaps().size(), 4u);
  for (const auto& submap : roomSubmaps())
    for (std::size_t i = 0; i < submap->nodes.size(); ++i) {
      const Frame& frame = roomLog().frames[submap->first_frame + i];
      EXPECT_EQ(submap->nodes[i].stamp, frame.stamp);
      EXPECT_EQ(submap->nodes[i].odometry, frame.odometry);
      if (submap->nodes[i].isKey()) {
        EXPECT_EQ(submap->nodes[i].scans, frame.scans);
      }
    }
}

TEST(GridMapper, KeyScansAreAtLeastAsFarApartAsAsked) {
  const double key_distance = KeyParams{}.distance, key_angle = KeyParams{}.angle;
  for (const auto& submap : roomSubmaps()) {
    std::vector<TPose2D> keys;
    for (const auto& node : submap->nodes)
      if (node.isKey()) keys.push_back(node.pose);
    // The first key may follow a key scan of the warm-up closely; refinement moves poses by millimetres.
    for (std::size_t k = 2; k < keys.size(); ++k) {
      const auto step = poseError(keys[k], keys[k - 1]);
      EXPECT_TRUE(step.distance() > key_distance - 0.02 || std::abs(step.phi) > key_angle - 0.01);
    }
  }
}

TEST(GridMapper, FollowsTheTruthWithinMillimetres) {
  double sum = 0, most = 0, most_turn = 0;
  std::size_t n = 0;
  for (const auto& submap : roomSubmaps())
    for (std::size_t i = 0; i < submap->nodes.size(); ++i, ++n) {
      const auto error =
          poseError(submap->nodes[i].pose, trueLocalPose(roomLog().truth, *submap, submap->first_frame + i));
      sum += error.distance();
      most = std::max(most, error.distance());
      most_turn = std::max(most_turn, std::abs(error.phi));
    }
  EXPECT_LT(sum / static_cast<double>(n), 0.008);
  EXPECT_LT(most, 0.03);
  EXPECT_LT(most_turn, 0.008);
}

TEST(GridMapper, WallsAreOccupiedAndThePathIsFree) {
  const GridSubmap& submap = *roomSubmaps().front();
  std::size_t wall = 0, occupied = 0;
  const TPose2D& origin = roomLog().truth[submap.first_frame].pose;
  for (const auto& node : submap.nodes) {
    const auto ahead = node.pose.composePoint(mrpt::math::TPoint2D(0.2, 0));
    const float* cell_ahead = submap.evidence.log_odds.cellByPos(ahead.x, ahead.y);
    ASSERT_NE(cell_ahead, nullptr);
    EXPECT_LT(*cell_ahead, 0);
    // Walls ahead to the left and right, by ray casting in the true world.
    for (const double side : {-1.2, 1.2}) {
      const double heading = node.pose.phi + side;
      const mrpt::math::TPoint2D from = origin.composePoint(mrpt::math::TPoint2D(node.pose.x, node.pose.y));
      const double range = roomWorld().raycast(from, origin.phi + heading);
      if (range > 3) continue;
      const double x = node.pose.x + range * std::cos(heading), y = node.pose.y + range * std::sin(heading);
      ++wall;
      bool any = false;  // within the cell or its neighbours
      for (const double dx : {-0.05, 0.0, 0.05})
        for (const double dy : {-0.05, 0.0, 0.05}) {
          const float* cell = submap.evidence.log_odds.cellByPos(x + dx, y + dy);
          any = any || (cell && *cell > 0);
        }
      occupied += any;
    }
  }
  EXPECT_GT(wall, 40u);
  EXPECT_GT(static_cast<double>(occupied), 0.95 * static_cast<double>(wall));
}

TEST(GridMapper, AStretchAloneGivesTheSameBytesAsInSequence) {
  const auto stretches = stretchesOf(roomLog().frames, shortStretches());
  ASSERT_EQ(stretches.size(), roomSubmaps().size());
  const RbpfGridMapper mapper({}, 1);
  for (const std::size_t k : {stretches.size() - 1, std::size_t{1}})
    EXPECT_EQ(bytesOf(mapper.map(stretches[k])), bytesOf({roomSubmaps()[k]}));
}

TEST(GridMapper, StretchesInParallelGiveTheSameBytes) {
  const auto stretches = stretchesOf(roomLog().frames, shortStretches());
  const RbpfGridMapper mapper({}, 1);
  GridSubmaps submaps(stretches.size());
  tbb::parallel_for(std::size_t{0}, stretches.size(),
                    [&](std::size_t k) { submaps[k] = mapper.map(stretches[k])[0]; });
  EXPECT_EQ(bytesOf(submaps), bytesOf(roomSubmaps()));
}

TEST(GridMapper, MatchScoresAreShares) {
  for (const auto& submap : roomSubmaps()) {
    const SubmapStatistics& s = submap->statistics;
    EXPECT_GE(s.match_score_min, 0);
    EXPECT_LE(s.match_score_min, s.match_score_mean);
    EXPECT_LE(s.match_score_mean, s.match_score_max);
    EXPECT_LE(s.match_score_max, 1);
    EXPECT_GT(s.match_score_mean, 0.9f);
    EXPECT_FALSE(s.closed_because.empty());
  }
}

TEST(GridMapper, ASubmapThatSawNothingHasTheResolutionOfTheOthers) {
  std::vector<Frame> frames = simulateRoute(roomWorld(), 3, {}, 1).frames;
  for (auto& frame : frames) {
    const auto blind = mrpt::obs::CObservation2DRangeScan::Create(*frame.scans.front());
    for (std::size_t i = 0; i < blind->getScanSize(); ++i) blind->setScanRangeValidity(i, false);
    frame.scans = {blind};
  }
  for (const auto& submap : mapLog(frames, {})) {
    EXPECT_EQ(submap->evidence.resolution(), EvidenceParams{}.resolution);
    EXPECT_EQ(submap->evidence.observedCells(), 0u);
    EXPECT_EQ(submap->statistics.closed_because, "log ended");
  }
}

TEST(GridMapper, EndCovarianceIsPositiveDefinite) {
  for (const auto& submap : roomSubmaps()) {
    const Eigen::Matrix3d cov = submap->end_pose.cov.asEigen();
    EXPECT_LT((cov - cov.transpose()).norm(), 1e-12);
    EXPECT_GT(cov.ldlt().vectorD().minCoeff(), 0);
    EXPECT_LT(std::sqrt(cov(0, 0)), 0.1);
  }
}

// ---- the classical filter ----

TEST(GridMapper, FixedParticlesSampleAndResample) {
  GridMapperParams params;
  params.filter.fixed_particles = 10;
  std::vector<Frame> frames(roomLog().frames.begin(), roomLog().frames.begin() + 60);
  const auto first = mapLog(frames, params, 1), again = mapLog(frames, params, 1),
             other = mapLog(frames, params, 2);
  EXPECT_EQ(first[0]->statistics.max_particles, 10u);
  EXPECT_GT(first[0]->statistics.resamplings, 0u);
  EXPECT_LT(endError(roomLog().truth, *first[0]).distance(), 0.05);
  EXPECT_EQ(bytesOf(first), bytesOf(again));
  EXPECT_NE(bytesOf(first), bytesOf(other)) << "another seed, other samples";
}

// ---- degenerate input ----

std::vector<Frame> withScans(std::vector<Frame> frames, const mrpt::obs::CObservation2DRangeScan::Ptr& scan) {
  for (auto& frame : frames) frame.scans = {scan};
  return frames;
}

void expectOdometryIsFollowed(const std::vector<Frame>& frames) {
  const auto submaps = mapLog(frames, {});
  expectConsistent(submaps, frames.size());
  const GridSubmap& submap = *submaps.front();
  const TPose2D expected = *frames[submap.end_frame - 1].odometry - *frames[0].odometry;
  const auto error = poseError(submap.nodes.back().pose, expected);
  EXPECT_LT(error.distance(), 1e-6);
  EXPECT_LT(std::abs(error.phi), 1e-6);
  EXPECT_EQ(submap.evidence.observedCells(), 0u);
  EXPECT_TRUE(submap.end_pose.cov.asEigen().allFinite());
}

TEST(GridMapper, ScansWithoutBeamsLeaveOdometry) {
  const std::vector<Frame> some(roomLog().frames.begin(), roomLog().frames.begin() + 30);
  expectOdometryIsFollowed(withScans(some, mrpt::obs::CObservation2DRangeScan::Create()));
}

TEST(GridMapper, ScansWithoutAValidBeamLeaveOdometry) {
  auto invalid = mrpt::obs::CObservation2DRangeScan::Create();
  invalid->resizeScanAndAssign(181, 10.0f, false);
  const std::vector<Frame> some(roomLog().frames.begin(), roomLog().frames.begin() + 30);
  expectOdometryIsFollowed(withScans(some, invalid));
}

TEST(GridMapper, OneFrameIsASubmap) {
  const auto submaps = mapLog({roomLog().frames[0]}, {});
  expectConsistent(submaps, 1);
  EXPECT_EQ(submaps[0]->end_pose.mean.asTPose(), TPose2D());
  EXPECT_GT(submaps[0]->evidence.observedCells(), 100u);
  EXPECT_GT(submaps[0]->end_pose.cov(0, 0), 0);
}

TEST(GridMapper, ARobotThatStandsStillStays) {
  auto frames = std::vector<Frame>(40, roomLog().frames[0]);
  for (std::size_t i = 0; i < frames.size(); ++i) frames[i].index = i;
  const auto submaps = mapLog(frames, {});
  expectConsistent(submaps, 40);
  EXPECT_LT(std::hypot(submaps[0]->end_pose.mean.x(), submaps[0]->end_pose.mean.y()), 0.003);
  EXPECT_EQ(submaps[0]->keyNodes(), 1u);
}

TEST(GridMapper, LogsWithoutOdometryAreMapped) {
  auto frames = roomLog().frames;
  for (auto& frame : frames) frame.odometry.reset();
  StretchParams stretching;
  stretching.max_nodes = 50;
  const auto submaps = mapLog(frames, {}, 1, stretching);
  expectConsistent(submaps, frames.size());
  for (const auto& submap : submaps) EXPECT_LT(endError(roomLog().truth, *submap).distance(), 0.05);
}

TEST(GridMapper, AMatchThatStaysLostClosesTheSubmap) {
  GridMapperParams params;
  params.closing.lost_below = 0.8;
  params.closing.lost_scans = 3;
  auto frames = std::vector<Frame>(roomLog().frames.begin(), roomLog().frames.begin() + 80);
  scrambleScans(frames, 40, 46);
  const auto submaps = mapLog(frames, params);
  expectConsistent(submaps, frames.size());
  ASSERT_GT(submaps.size(), 1u);
  EXPECT_EQ(submaps[0]->statistics.closed_because, "match lost");
}

/** The first submap that ends at that frame; null if none does. */
GridSubmap::Ptr endingAt(const GridSubmaps& submaps, std::size_t frame) {
  const auto found = std::find_if(submaps.begin(), submaps.end(),
                                  [frame](const auto& submap) { return submap->end_frame == frame; });
  return found == submaps.end() ? nullptr : *found;
}

TEST(GridMapper, AStepThatOdometryContradictsEndsTheSubmap) {
  OdometryModel odometry;
  odometry.jumps = {{15, {0, 0, 0.9}}};  // frame 75, at 5 scans a second
  const SimulatedLog log = simulateRoute(roomWorld(), 25, odometry, 1);
  const auto submaps = mapLog(log.frames, {}, 1, shortStretches());
  expectConsistent(submaps, log.frames.size());
  const auto before = endingAt(submaps, 75);
  ASSERT_TRUE(before);
  EXPECT_EQ(before->statistics.closed_because, "match in doubt");
  EXPECT_NEAR(std::sqrt(before->end_pose.cov(2, 2)), 0.45, 0.05) << "odometry may be right";
  for (const auto& submap : submaps) EXPECT_LT(endError(log.truth, *submap).distance(), 0.05);
}

TEST(GridMapper, NothingIsInDoubtInAnOrdinaryLog) {
  for (const auto& submap : roomSubmaps())
    EXPECT_EQ(submap->statistics.closed_because, submap->has_successor ? "stretch ended" : "log ended");
}

TEST(GridMapper, StrayScansAreLeftOut) {
  auto frames = roomLog().frames;
  scrambleScans(frames, 40, 40 + kStrayScans);
  const auto submaps = mapLog(frames, {}, 1, shortStretches());
  ASSERT_EQ(submaps.size(), roomSubmaps().size());
  for (const auto& submap : submaps) {
    EXPECT_LT(endError(roomLog().truth, *submap).distance(), 0.05);
    for (std::size_t n = 0; n < submap->nodes.size(); ++n) {
      const std::size_t frame = submap->first_frame + n;
      const bool stray = frame >= 40 && frame < 40 + kStrayScans && n > 0;
      EXPECT_FALSE(stray && submap->nodes[n].isKey()) << frame;
    }
  }
}

TEST(GridMapper, ARobotThatWasCarriedBeginsASubmap) {
  GridMapperParams params;
  params.closing.carried = true;
  for (const std::size_t at : {50u, 51u, 52u, 53u, 54u, 55u, 56u}) {  // also next to the end of a stretch
    auto frames = std::vector<Frame>(roomLog().frames.begin(), roomLog().frames.begin() + at);
    const SimulatedLog elsewhere = simulateRoute(loopWorld(), 10, {}, 2);
    for (Frame frame : elsewhere.frames) {
      frame.odometry = *roomLog().frames[at - 1].odometry + *frame.odometry;
      frame.index = frames.size();
      frames.push_back(frame);
    }
    const auto submaps = mapLog(frames, params, 1, shortStretches());
    expectConsistent(submaps, frames.size());
    const auto before = endingAt(submaps, at);
    ASSERT_TRUE(before) << at;
    EXPECT_GT(before->end_pose.cov(0, 0), 20);
    EXPECT_GT(before->end_pose.cov(2, 2), 0.9);
  }
}

// ---- parameters ----

TEST(GridMapper, EveryParameterCanBeSetFromItsOwnText) {
  GridMapperParams params;
  ParameterTable table;
  describe(table, params);
  EXPECT_GT(table.parameters().size(), 30u);
  for (const auto& p : table.parameters()) {
    EXPECT_NO_THROW(table.set(p.section, p.key, p.value())) << p.section << '.' << p.key;
    EXPECT_FALSE(p.description.empty()) << p.section << '.' << p.key;
  }
  table.set("particles.fixed=10");
  EXPECT_EQ(params.filter.fixed_particles, 10);
}

}  // namespace
}  // namespace submap_slam
