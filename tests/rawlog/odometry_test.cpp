#include <gtest/gtest.h>

#include <cmath>

#include "../support/temp_folder.h"
#include "log_builder.h"

namespace submap_slam {
namespace {

Frame onlyFrame(const LogBuilder& log) {
  TempFolder temp;
  auto frames = framesOf(log.savePlain(temp.file("a.rawlog")));
  EXPECT_EQ(frames.size(), 1u);
  return frames.at(0);
}

void expectPose(const Frame& frame, double x, double y, double phi) {
  ASSERT_TRUE(frame.odometry);
  EXPECT_NEAR(frame.odometry->x, x, 1e-9);
  EXPECT_NEAR(frame.odometry->y, y, 1e-9);
  EXPECT_NEAR(frame.odometry->phi, phi, 1e-9);
}

TEST(Odometry, IsInterpolatedToTheScan) {
  LogBuilder log;  // a quarter of the way from (1, 2, 0.2) to (3, 6, 0.6)
  log.add(odometryAt(10, 1, 2, 0.2)).add(scanAt(10.25)).add(odometryAt(11, 3, 6, 0.6));
  expectPose(onlyFrame(log), 1.5, 3.0, 0.3);
}

TEST(Odometry, TurnsTheShorterWay) {
  LogBuilder log;  // from 170° to −170° through 180°
  log.add(odometryAt(0, 0, 0, mrpt::DEG2RAD(170.0)))
      .add(scanAt(0.75))
      .add(odometryAt(1, 0, 0, mrpt::DEG2RAD(-170.0)));
  expectPose(onlyFrame(log), 0, 0, mrpt::DEG2RAD(-175.0));
}

TEST(Odometry, ScanMayComeBehindTheReadingsAroundIt) {
  LogBuilder log;
  log.add(odometryAt(0, 0, 0, 0)).add(odometryAt(1, 1, 0, 0)).add(odometryAt(2, 5, 0, 0)).add(scanAt(0.5));
  expectPose(onlyFrame(log), 0.5, 0, 0);
}

TEST(Odometry, ReadingWithTheVeryStampIsUsedAsItIs) {
  LogBuilder log;
  log.add(odometryAt(0, 0, 0, 0)).add(scanAt(1)).add(odometryAt(1, 7, 8, 0.9)).add(odometryAt(2, 9, 9, 0));
  expectPose(onlyFrame(log), 7, 8, 0.9);
}

TEST(Odometry, LastReadingIsHeldForASecond) {
  LogBuilder within, beyond;
  within.add(odometryAt(0, 1, 0, 0)).add(odometryAt(1, 2, 0, 0)).add(scanAt(1.9));
  beyond.add(odometryAt(0, 1, 0, 0)).add(odometryAt(1, 2, 0, 0)).add(scanAt(2.1));
  expectPose(onlyFrame(within), 2, 0, 0);
  EXPECT_FALSE(onlyFrame(beyond).odometry);
}

TEST(Odometry, FirstReadingHoldsForASecondBeforeIt) {
  LogBuilder within, beyond;
  within.add(scanAt(9.1)).add(odometryAt(10, 1, 2, 0));
  beyond.add(scanAt(8.9)).add(odometryAt(10, 1, 2, 0));
  expectPose(onlyFrame(within), 1, 2, 0);
  EXPECT_FALSE(onlyFrame(beyond).odometry);
}

TEST(Odometry, SurvivesManyReadingsBeforeAnEarlyScanIsComplete) {
  TempFolder temp;
  LogBuilder log;
  log.add(scanAt(0));
  for (int k = 0; k < 5000; ++k) log.add(odometryAt(0.5 + 0.01 * k, k, 0, 0));
  log.add(scanAt(100));
  const auto frames = framesOf(log.saveGz(temp.file("a.rawlog")));
  ASSERT_EQ(frames.size(), 2u);
  expectPose(frames[0], 0, 0, 0);
  EXPECT_FALSE(frames[1].odometry);
}

TEST(Odometry, IsNotInterpolatedAcrossAClockThatJumpsBack) {
  TempFolder temp;
  LogBuilder log;
  log.add(odometryAt(100, 1, 0, 0)).add(scanAt(100.5));  // waits for the next reading …
  log.add(odometryAt(50, 2, 0, 0)).add(scanAt(50.5)).add(odometryAt(51, 4, 0, 0));  // … which never comes
  const auto frames = framesOf(log.savePlain(temp.file("a.rawlog")));
  ASSERT_EQ(frames.size(), 2u);
  expectPose(frames[0], 1, 0, 0);
  expectPose(frames[1], 3, 0, 0);
}

TEST(Odometry, ReadingsWithTheSameStampDivideNothingByZero) {
  LogBuilder log;
  log.add(odometryAt(0, 0, 0, 0)).add(odometryAt(0, 1, 0, 0)).add(scanAt(0.5)).add(odometryAt(1, 3, 0, 0));
  expectPose(onlyFrame(log), 2, 0, 0);
}

TEST(Odometry, IncrementsAreChained) {
  TempFolder temp;
  LogBuilder log;  // forward, a quarter turn to the left, forward
  log.addFrame({scanAt(0)}).add(movement(1, 0, M_PI / 2)).addFrame({scanAt(1)});
  log.add(movement(2, 0, 0)).add(movement(1, 0, 0)).addFrame({scanAt(2)});
  const auto frames = framesOf(log.savePlain(temp.file("a.rawlog")));
  ASSERT_EQ(frames.size(), 3u);
  expectPose(frames[0], 0, 0, 0);
  expectPose(frames[1], 1, 0, M_PI / 2);
  expectPose(frames[2], 1, 3, M_PI / 2);
}

TEST(Odometry, RandomMotionModelDoesNotTouchTheIncrements) {
  TempFolder temp;
  mrpt::obs::CActionRobotMovement2D action;
  mrpt::obs::CActionRobotMovement2D::TMotionModelOptions options;
  options.modelSelection =
      mrpt::obs::CActionRobotMovement2D::mmThrun;  // its pose change is a set of random samples
  action.computeFromOdometry(mrpt::poses::CPose2D(1, 0, 0.5), options);
  LogBuilder log;
  log.add(mrpt::obs::CActionCollection(action)).addFrame({scanAt(0)});
  expectPose(onlyFrame(log), 1, 0, 0.5);
}

TEST(Odometry, ScanMatchingIncrementsAreUsedAndReportedIfThereIsNothingElse) {
  TempFolder temp;
  mrpt::obs::CActionRobotMovement2D matched;
  matched.computeFromOdometry(mrpt::poses::CPose2D(2, 0, 0), {});
  matched.estimationMethod = mrpt::obs::CActionRobotMovement2D::emScan2DMatching;
  auto both = movement(1, 0, 0);
  mrpt::obs::CActionCollection alone(matched);
  both.insert(matched);
  LogBuilder log;
  log.add(alone).addFrame({scanAt(0)}).add(both).addFrame({scanAt(1)});
  RawlogReader reader(log.savePlain(temp.file("a.rawlog")));
  const auto frames = allFrames(reader);
  ASSERT_EQ(frames.size(), 2u);
  expectPose(frames[0], 2, 0, 0);
  expectPose(frames[1], 3, 0, 0);
  EXPECT_EQ(reader.report().matched_increments, 1u);
}

TEST(Odometry, ThePartThatComesFirstIsUsedWhereALogHasBothKinds) {
  TempFolder temp;
  LogBuilder log;
  log.add(movement(1, 0, 0)).add(odometryAt(0, 50, 0, 0)).addFrame({scanAt(0)});
  RawlogReader reader(log.savePlain(temp.file("a.rawlog")));
  const auto frames = allFrames(reader);
  expectPose(frames.at(0), 1, 0, 0);
  EXPECT_EQ(reader.report().ignored_odometry, 1u);
}

TEST(Odometry, ReadingsThatAreNotFiniteAreIgnored) {
  LogBuilder log;
  log.add(odometryAt(0, 1, 0, 0))
      .add(odometryAt(0.5, std::nan(""), 0, 0))
      .add(scanAt(0.5))
      .add(odometryAt(1, 3, 0, 0));
  expectPose(onlyFrame(log), 2, 0, 0);
}

}  // namespace
}  // namespace submap_slam
