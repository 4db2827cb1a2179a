#include <gtest/gtest.h>
#include <submap_slam/mapping/stretch_splitter.h>

#include <chrono>
#include <cmath>
#include <random>
#include <vector>

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;

struct Cut {
  std::vector<Stretch> stretches;

  std::vector<std::size_t> boundaries() const {
    std::vector<std::size_t> first;
    for (const auto& s : stretches) first.push_back(s.frames[s.warm_up].index);
    return first;
  }
};

Cut cut(const std::vector<Frame>& frames, const StretchParams& params) {
  StretchSplitter splitter(params);
  Cut out;
  for (const auto& frame : frames)
    if (auto stretch = splitter.push(frame)) out.stretches.push_back(std::move(*stretch));
  if (auto stretch = splitter.finish()) out.stretches.push_back(std::move(*stretch));
  return out;
}

std::vector<Frame> framesAlong(const std::vector<TPose2D>& odometry, double period = 0.2) {
  std::vector<Frame> frames(odometry.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i].index = i;
    frames[i].stamp = mrpt::Clock::fromDouble(1e9 + period * static_cast<double>(i));
    frames[i].odometry = odometry[i];
  }
  return frames;
}

std::vector<Frame> withoutOdometry(std::vector<Frame> frames) {
  for (auto& frame : frames) frame.odometry.reset();
  return frames;
}

std::vector<Frame> straight(std::size_t n, double step) {
  std::vector<TPose2D> odometry(n);
  for (std::size_t i = 0; i < n; ++i) odometry[i].x = step * static_cast<double>(i);
  return framesAlong(odometry);
}

/** Wanders, turns on the spot and stands still by turns. */
std::vector<Frame> wandering(uint64_t seed, std::size_t n) {
  std::mt19937_64 random(seed);
  std::vector<TPose2D> odometry(n);
  TPose2D step;
  for (std::size_t i = 1; i < n; ++i) {
    if (random() % 20 == 0)
      step = {0.05 * static_cast<double>(random() % 5), 0, 0.05 * (static_cast<double>(random() % 5) - 2)};
    odometry[i] = odometry[i - 1] + step;
  }
  return framesAlong(odometry);
}

double path(const Stretch& s, std::size_t begin, std::size_t end) {
  double sum = 0;
  for (std::size_t i = begin + 1; i < end; ++i)
    sum += std::hypot(s.frames[i].odometry->x - s.frames[i - 1].odometry->x,
                      s.frames[i].odometry->y - s.frames[i - 1].odometry->y);
  return sum;
}

/** What holds for the stretches of every log of `frames` frames. */
void expectPartition(const Cut& log, std::size_t frames) {
  std::size_t next = 0;
  for (std::size_t k = 0; k < log.stretches.size(); ++k) {
    const Stretch& s = log.stretches[k];
    EXPECT_EQ(s.index, k);
    EXPECT_EQ(s.last, k + 1 == log.stretches.size());
    ASSERT_GT(s.ownFrames(), 0u);
    ASSERT_LE(s.warm_up, next) << "warm-up frames come before the stretch";
    // Warm-up frames without motion are left out; own frames never.
    for (std::size_t i = 1; i <= s.warm_up; ++i) ASSERT_LT(s.frames[i - 1].index, s.frames[i].index);
    for (std::size_t i = s.warm_up; i < s.frames.size(); ++i)
      ASSERT_EQ(s.frames[i].index, next - s.warm_up + i);
    next += s.ownFrames();
  }
  EXPECT_EQ(next, frames);
}

class WanderingLog : public ::testing::TestWithParam<uint64_t> {
 protected:
  const std::vector<Frame> frames = wandering(GetParam(), 1500);
};

TEST_P(WanderingLog, EveryFrameBelongsToExactlyOneStretch) {
  StretchParams params;
  params.max_distance = 4;
  const Cut log = cut(frames, params);
  EXPECT_GT(log.stretches.size(), 5u);
  expectPartition(log, frames.size());
}

TEST_P(WanderingLog, StretchesEndAtTheFirstFrameBeyondTheDistance) {
  StretchParams params;
  params.max_distance = 4;
  params.max_nodes = 1'000'000;
  for (const auto& s : cut(frames, params).stretches) {
    if (s.last) continue;
    EXPECT_GE(path(s, s.warm_up, s.frames.size()), 4 - 1e-9);
    EXPECT_LT(path(s, s.warm_up, s.frames.size() - 1), 4);
  }
}

TEST_P(WanderingLog, BoundariesDependOnOdometryAndStampsAlone) {
  StretchParams params;
  params.max_distance = 4;
  auto others = frames;
  for (auto& frame : others) frame.scans = {mrpt::obs::CObservation2DRangeScan::Create()};
  EXPECT_EQ(cut(others, params).boundaries(), cut(frames, params).boundaries());
  params.warm_up_keys = 0;
  EXPECT_EQ(cut(others, params).boundaries(), cut(frames, params).boundaries());
}

TEST_P(WanderingLog, BoundariesDoNotDependOnWhatFollows) {
  StretchParams params;
  params.max_distance = 4;
  const auto whole = cut(frames, params).boundaries();
  auto part = cut({frames.begin(), frames.begin() + 700}, params).boundaries();
  ASSERT_LE(part.size(), whole.size());
  EXPECT_TRUE(std::equal(part.begin(), part.end(), whole.begin()));
}

INSTANTIATE_TEST_SUITE_P(Seeds, WanderingLog, ::testing::Range<uint64_t>(0, 10));

TEST(StretchSplitter, NoFrameGivesNoStretch) { EXPECT_TRUE(cut({}, {}).stretches.empty()); }

TEST(StretchSplitter, OneFrameIsAStretch) {
  const Cut log = cut(straight(1, 0), {});
  expectPartition(log, 1);
  EXPECT_EQ(log.stretches.size(), 1u);
}

TEST(StretchSplitter, FinishingTwiceGivesNothingMore) {
  StretchSplitter splitter({});
  splitter.push(straight(1, 0)[0]);
  EXPECT_TRUE(splitter.finish());
  EXPECT_FALSE(splitter.finish());
}

TEST(StretchSplitter, TheWarmUpReachesBackSoManyKeyScans) {
  StretchParams params;
  params.max_distance = 2;
  params.warm_up_keys = 3;
  params.key_distance = 0.15;
  const Cut log = cut(straight(100, 0.0501), params);  // three steps to a key scan
  ASSERT_GT(log.stretches.size(), 1u);
  EXPECT_EQ(log.stretches[0].warm_up, 0u);
  EXPECT_EQ(log.stretches[1].warm_up, 9u);
}

TEST(StretchSplitter, TurningOnTheSpotMakesKeyScansToo) {
  std::vector<TPose2D> odometry;
  for (int i = 0; i < 60; ++i) odometry.push_back({0, 0, 0.0501 * i});
  StretchParams params;
  params.max_nodes = 30;
  params.warm_up_keys = 2;
  params.key_angle = 0.1;
  const Cut log = cut(framesAlong(odometry), params);
  ASSERT_GT(log.stretches.size(), 1u);
  EXPECT_EQ(log.stretches[1].warm_up, 4u);
  expectPartition(log, 60);
}

TEST(StretchSplitter, WithoutWarmUpNothingPrecedes) {
  StretchParams params;
  params.max_distance = 2;
  params.warm_up_keys = 0;
  for (const auto& s : cut(straight(200, 0.05), params).stretches) EXPECT_EQ(s.warm_up, 0u);
}

TEST(StretchSplitter, LogsWithoutOdometryAreCutByFrames) {
  StretchParams params;
  params.max_nodes = 40;
  const Cut log = cut(withoutOdometry(straight(200, 0.05)), params);
  expectPartition(log, 200);
  EXPECT_GE(log.stretches.size(), 5u);
  for (const auto& s : log.stretches) EXPECT_LE(s.ownFrames(), 40u);
}

TEST(StretchSplitter, LogsWithoutOdometryAreCutByTime) {
  StretchParams params;
  params.max_duration = 2;
  const Cut log = cut(withoutOdometry(straight(101, 0.05)), params);  // 0.2 s apart
  expectPartition(log, 101);
  EXPECT_EQ(log.boundaries(), (std::vector<std::size_t>{0, 10, 20, 30, 40, 50, 60, 70, 80, 90, 100}));
}

TEST(StretchSplitter, OdometryThatStartsLateIsUsed) {
  auto frames = straight(300, 0.05);
  for (std::size_t i = 0; i < 100; ++i) frames[i].odometry.reset();
  StretchParams params;
  params.max_distance = 4;
  const Cut log = cut(frames, params);
  expectPartition(log, 300);
  EXPECT_GE(log.stretches.size(), 3u);
}

TEST(StretchSplitter, ARobotThatStandsStillIsOneNode) {
  auto frames = straight(100, 0.0);
  StretchParams params;
  params.max_nodes = 20;
  EXPECT_EQ(cut(frames, params).stretches.size(), 1u);
}

TEST(StretchSplitter, ARobotThatStandsStillForHoursIsCutAndNeedsNoMoreMemory) {
  StretchParams params;
  params.max_nodes = 20;
  const Cut log = cut(straight(5000, 0.0), params);
  expectPartition(log, 5000);
  EXPECT_GT(log.stretches.size(), 5u);
  for (const auto& s : log.stretches) EXPECT_LE(s.frames.size(), 3 * s.ownFrames() + 20) << s.index;
}

}  // namespace
}  // namespace submap_slam
