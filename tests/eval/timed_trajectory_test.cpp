#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/core/Clock.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/eval/timed_trajectory.h>

#include <cmath>

#include "../support/temp_folder.h"

namespace submap_slam {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

TimedPose planar(double t, double x, double y, double yaw) { return {t, poseFromRpy(x, y, 0, 0, 0, yaw)}; }

double yawOf(const Pose3D& pose) { return toPose2D(pose).phi; }

}  // namespace

TEST(Pose3D, RollPitchYawTurnAboutXThenYThenZ) {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                        z = Eigen::Vector3d::UnitZ();
  const double quarter = M_PI / 2;
  EXPECT_TRUE((poseFromRpy(0, 0, 0, quarter, 0, 0).rotation * y).isApprox(z));
  EXPECT_TRUE((poseFromRpy(0, 0, 0, 0, quarter, 0).rotation * z).isApprox(x));
  EXPECT_TRUE((poseFromRpy(0, 0, 0, 0, 0, quarter).rotation * x).isApprox(y));
  EXPECT_TRUE((poseFromRpy(0, 0, 0, quarter, 0, quarter).rotation * y).isApprox(z));
}

TEST(Pose3D, ComposeAndInvert) {
  const Pose3D T_a_b = poseFromRpy(1, 2, 0, 0, 0, M_PI / 2), T_b_c = poseFromRpy(3, 0, 1, 0, 0, 0);
  const Pose3D T_a_c = T_a_b * T_b_c;
  EXPECT_TRUE(T_a_c.translation.isApprox(Eigen::Vector3d(1, 5, 1)));
  EXPECT_NEAR((T_a_b.inverse() * T_a_c).translation.x(), 3, 1e-12);
  EXPECT_NEAR(T_a_c.angle(), M_PI / 2, 1e-12);
  EXPECT_NEAR(poseFromRpy(0, 0, 0, 0, 0, -3.5).angle(), 2 * M_PI - 3.5, 1e-12);
}

TEST(TimedTrajectory, InterpolatesPositionAndHeadingTheShortWay) {
  const TimedTrajectory trajectory({planar(10, 0, 0, M_PI - 0.2), planar(13, 3, 6, -M_PI + 0.1)});
  const auto pose = trajectory.at(11, 1e-3, 5).value();
  EXPECT_NEAR(pose.translation.x(), 1, 1e-12);
  EXPECT_NEAR(pose.translation.y(), 2, 1e-12);
  EXPECT_NEAR(yawOf(pose), M_PI - 0.1, 1e-9);
}

TEST(TimedTrajectory, TakesANearPoseWithoutInterpolation) {
  const TimedTrajectory trajectory({planar(10, 0, 0, 0), planar(11, 1, 0, 0)});
  EXPECT_EQ(trajectory.at(10.0009, 1e-3, 5)->translation.x(), 0);
  EXPECT_EQ(trajectory.at(10.9992, 1e-3, 5)->translation.x(), 1);
  EXPECT_NEAR(trajectory.at(10.002, 1e-3, 5)->translation.x(), 0.002, 1e-9);
  EXPECT_EQ(trajectory.at(9.9995, 1e-3, 5)->translation.x(), 0);
  EXPECT_EQ(trajectory.at(11.0005, 1e-3, 5)->translation.x(), 1);
}

TEST(TimedTrajectory, NothingOutsideOrInALongGap) {
  const TimedTrajectory trajectory({planar(10, 0, 0, 0), planar(15, 1, 0, 0), planar(20.5, 2, 0, 0)});
  EXPECT_FALSE(trajectory.at(9.9, 1e-3, 5));
  EXPECT_FALSE(trajectory.at(20.6, 1e-3, 5));
  EXPECT_TRUE(trajectory.at(12, 1e-3, 5));
  EXPECT_FALSE(trajectory.at(16, 1e-3, 5));
  EXPECT_FALSE(TimedTrajectory().at(0, 1e-3, 5));
}

TEST(TimedTrajectory, SortsAndKeepsTheLastOfEqualTimes) {
  const TimedTrajectory trajectory(
      {planar(2, 1, 0, 0), planar(1, 2, 0, 0), planar(2, 3, 0, 0), planar(1.5, 4, 0, 0)});
  ASSERT_EQ(trajectory.poses().size(), 3u);
  EXPECT_EQ(trajectory.poses()[0].pose.translation.x(), 2);
  EXPECT_EQ(trajectory.poses()[1].pose.translation.x(), 4);
  EXPECT_EQ(trajectory.poses()[2].pose.translation.x(), 3);
}

TEST(TimedTrajectory, FromAPlanarTrajectory) {
  const TimedTrajectory trajectory(Trajectory{{mrpt::Clock::fromDouble(1000.5), {1, 2, -0.7}}});
  ASSERT_EQ(trajectory.poses().size(), 1u);
  EXPECT_NEAR(trajectory.poses()[0].t, 1000.5, 1e-6);
  const auto pose = toPose2D(trajectory.poses()[0].pose);
  EXPECT_NEAR(pose.x, 1, 1e-12);
  EXPECT_NEAR(pose.y, 2, 1e-12);
  EXPECT_NEAR(pose.phi, -0.7, 1e-12);
}

TEST(ReadTum, CommentsCommasBlanksAndUnnormalisedQuaternions) {
  const TempFolder folder;
  const auto file = folder.write("a.tum",
                                 "# header\r\n"
                                 "\n"
                                 "976052890.244111,1.5,-2,0.25,0,0,2,2\r\n"
                                 "  \t+976052891.5 1e0 .5 0 0 0 0 1 further # end\n");
  const auto trajectory = readTum(file);
  ASSERT_EQ(trajectory.poses().size(), 2u);
  const auto& first = trajectory.poses()[0];
  EXPECT_EQ(first.t, 976052890.244111);
  EXPECT_EQ(first.pose.translation, Eigen::Vector3d(1.5, -2, 0.25));
  EXPECT_NEAR(yawOf(first.pose), M_PI / 2, 1e-12);
  EXPECT_EQ(trajectory.poses()[1].pose.translation.y(), 0.5);
}

TEST(ReadTum, BadInputNamesFileAndLine) {
  const TempFolder folder;
  const std::string good = "1 0 0 0 0 0 0 1\n";
  const std::pair<std::string, std::string> cases[] = {
      {good + "2 0 0 0 0 0 1\n", ":2: 7 columns, expected 8"},
      {good + "\n2 0 nan 0 0 0 0 1\n", ":3: 'nan' is not a finite number"},
      {"1 0 inf 0 0 0 0 1\n", ":1: 'inf' is not a finite number"},
      {"1 0 1e999 0 0 0 0 1\n", ":1: '1e999' is not a finite number"},
      {"1 0 1.5x 0 0 0 0 1\n", ":1: '1.5x' is not a finite number"},
      {"timestamp x y z qx qy qz qw\n", ":1: 'timestamp' is not a finite number"},
      {good + "2 0 0 0 0 0 0 0\n", ":2: the quaternion is zero"},
      {"", ": holds no data"},
      {"# nothing\n\n", ": holds no data"},
  };
  for (const auto& [text, message] : cases) {
    const auto file = folder.write("bad.tum", text);
    EXPECT_THAT([&] { readTum(file); }, ThrowsMessage<InputError>(HasSubstr(file + message)));
  }
  const auto missing = folder.file("missing.tum");
  EXPECT_THAT([&] { readTum(missing); },
              ThrowsMessage<InputError>(HasSubstr(missing + ": cannot be opened")));
}

}  // namespace submap_slam
