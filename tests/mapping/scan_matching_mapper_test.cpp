#include <submap_slam/mapping/scan_matching_mapper.h>

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <random>

#include "mapped_log.h"

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;
using mrpt::obs::CObservation2DRangeScan;

GridMapperParams scanMatching() {
  GridMapperParams params;
  params.method = "scan_matching";
  return params;
}

const SimulatedLog& roomLog() {
  static const SimulatedLog log = simulateRoute(roomWorld(), 25, OdometryModel{}, 1);
  return log;
}

std::vector<Frame> firstFrames(std::ptrdiff_t n) {
  return {roomLog().frames.begin(), roomLog().frames.begin() + n};
}

StretchParams shortStretches() {
  StretchParams params;
  params.max_distance = 6;
  return params;
}

const GridSubmaps& roomSubmaps() {
  static const GridSubmaps submaps = mapLog(roomLog().frames, scanMatching(), 1, shortStretches());
  return submaps;
}

/** All frames with that scan instead of their own. */
std::vector<Frame> withScan(std::vector<Frame> frames, const CObservation2DRangeScan::Ptr& scan) {
  for (auto& frame : frames) frame.scans = {scan};
  return frames;
}

TEST(ScanMatchingMapper, SubmapsHoldEveryFrameOnce) {
  expectConsistent(roomSubmaps(), roomLog().frames.size());
  EXPECT_GE(roomSubmaps().size(), 4u);
  EXPECT_GT(roomSubmaps()[0]->keyNodes(), 20u);
  EXPECT_LT(roomSubmaps()[0]->keyNodes(), roomSubmaps()[0]->nodes.size());
  for (const auto& submap : roomSubmaps()) {
    EXPECT_EQ(submap->evidence.resolution(), EvidenceParams{}.resolution);
    EXPECT_GT(submap->statistics.match_score_mean, 0.8f);
    EXPECT_EQ(submap->statistics.max_particles, 1u);
  }
}

TEST(ScanMatchingMapper, FollowsTheTruthWithinCentimetres) {
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
  EXPECT_LT(sum / static_cast<double>(n), 0.03);
  EXPECT_LT(most, 0.08);
  EXPECT_LT(most_turn, 0.015);
}

TEST(ScanMatchingMapper, EndCovarianceIsPositiveDefinite) {
  for (const auto& submap : roomSubmaps()) {
    const Eigen::Matrix3d cov = submap->end_pose.cov.asEigen();
    EXPECT_LT((cov - cov.transpose()).norm(), 1e-12);
    EXPECT_GT(cov.ldlt().vectorD().minCoeff(), 0);
    EXPECT_LT(std::sqrt(cov(0, 0)), 0.1);
  }
}

TEST(ScanMatchingMapper, StretchesInParallelGiveTheSameBytes) {
  const auto stretches = stretchesOf(roomLog().frames, shortStretches());
  ASSERT_EQ(stretches.size(), roomSubmaps().size());
  const ScanMatchingMapper mapper(scanMatching());
  GridSubmaps submaps(stretches.size());
  tbb::parallel_for(std::size_t{0}, stretches.size(),
                    [&](std::size_t k) { submaps[k] = mapper.map(stretches[k])[0]; });
  EXPECT_EQ(bytesOf(submaps), bytesOf(roomSubmaps()));
}

TEST(ScanMatchingMapper, TheSearchIsDeterministicToo) {
  GridMapperParams params = scanMatching();
  params.scan_matching.correlative_search = true;
  const auto frames = firstFrames(60);
  const auto first = mapLog(frames, params), again = mapLog(frames, params);
  EXPECT_EQ(bytesOf(first), bytesOf(again));
  EXPECT_LT(endError(roomLog().truth, *first[0]).distance(), 0.05);
}

TEST(ScanMatchingMapper, ScansWithoutAValidBeamLeaveOdometry) {
  auto invalid = CObservation2DRangeScan::Create();
  invalid->resizeScanAndAssign(181, 10.0f, false);
  auto not_a_number = CObservation2DRangeScan::Create();
  not_a_number->resizeScanAndAssign(181, std::numeric_limits<float>::quiet_NaN(), true);
  for (const auto& scan : {CObservation2DRangeScan::Create(), invalid, not_a_number}) {
    const auto frames = withScan(firstFrames(30), scan);
    const auto submaps = mapLog(frames, scanMatching());
    expectConsistent(submaps, 30);
    const TPose2D expected = *frames.back().odometry - *frames.front().odometry;
    EXPECT_LT(poseError(submaps[0]->nodes.back().pose, expected).distance(), 1e-6);
    EXPECT_EQ(submaps[0]->evidence.observedCells(), 0u);
    EXPECT_TRUE(submaps[0]->end_pose.cov.asEigen().allFinite());
  }
}

TEST(ScanMatchingMapper, BrokenBeamsAndEmptyScansInBetweenDoNotMatter) {
  auto frames = firstFrames(60);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    auto scan = CObservation2DRangeScan::Create(*frames[i].scans[0]);
    for (std::size_t b = i % 5; b < scan->getScanSize(); b += 5)
      scan->setScanRange(b, std::numeric_limits<float>::quiet_NaN());
    if (i % 7 == 0) scan = CObservation2DRangeScan::Create();
    frames[i].scans = {scan};
  }
  const auto submaps = mapLog(frames, scanMatching());
  expectConsistent(submaps, frames.size());
  EXPECT_LT(endError(roomLog().truth, *submaps[0]).distance(), 0.05);
}

TEST(ScanMatchingMapper, OneFrameIsASubmap) {
  const auto submaps = mapLog(firstFrames(1), scanMatching());
  expectConsistent(submaps, 1);
  EXPECT_EQ(submaps[0]->end_pose.mean.asTPose(), TPose2D());
  EXPECT_GT(submaps[0]->evidence.observedCells(), 100u);
  EXPECT_GT(submaps[0]->end_pose.cov(0, 0), 0);
}

/** One hypothesis without odometry can lose its way, but not the frames. */
TEST(ScanMatchingMapper, LogsWithoutOdometryAreAccepted) {
  auto frames = firstFrames(60);
  for (auto& frame : frames) frame.odometry.reset();
  const auto submaps = mapLog(frames, scanMatching());
  expectConsistent(submaps, frames.size());
  EXPECT_TRUE(submaps[0]->end_pose.cov.asEigen().allFinite());
  EXPECT_TRUE(std::isfinite(submaps[0]->end_pose.mean.x()));
}

TEST(ScanMatchingMapper, AMatchThatStaysLostClosesTheSubmap) {
  GridMapperParams params = scanMatching();
  params.closing.lost_below = 0.6;
  params.closing.lost_scans = 3;
  auto frames = firstFrames(80);
  scrambleScans(frames, 40, 46);
  const auto submaps = mapLog(frames, params);
  expectConsistent(submaps, frames.size());
  ASSERT_GT(submaps.size(), 1u);
  EXPECT_EQ(submaps[0]->statistics.closed_because, "match lost");
}

}  // namespace
}  // namespace submap_slam
