#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/poses/CPose2D.h>

#include <cmath>

#include "imported.h"

namespace submap_slam {
namespace {

using mrpt::obs::CObservationBearingRange;
using mrpt::obs::CObservationOdometry;
using testing::HasSubstr;

class LandmarkText : public testing::Test {
 protected:
  Imported read(const std::string& landmarks, const std::string& controls) {
    options_.controls_file = temp_.write("controls.txt", controls);
    return importText(landmarks, options_);
  }

  TempFolder temp_;
  ImportOptions options_;
};

TEST_F(LandmarkText, LinesOfOneStampAreOneObservation) {
  options_.T_robot_sensor = mrpt::math::TPose2D(3.78, 0.5, 0);
  const auto log =
      read("# stamp range bearing id\n10 5 0.1 7\n10 6 -0.2 8\n11\n12 7 0.3 7\n", "9 0 0\n11.5 0 0\n");
  const auto seen = log.all<CObservationBearingRange>();
  ASSERT_EQ(seen.size(), 3u);
  ASSERT_EQ(seen[0]->sensedData.size(), 2u);
  EXPECT_FLOAT_EQ(seen[0]->sensedData[1].range, 6);
  EXPECT_FLOAT_EQ(seen[0]->sensedData[1].yaw, -0.2F);
  EXPECT_EQ(seen[0]->sensedData[1].landmarkID, 8);
  EXPECT_TRUE(seen[1]->sensedData.empty());  // nothing was seen at 11 s
  EXPECT_NEAR(seconds(*seen[1]), 11, 1e-6);
  EXPECT_NEAR(seen[0]->sensorLocationOnRobot.x(), 3.78, 1e-6);
  // in the order of the stamps
  ASSERT_EQ(log.objects.size(), 5u);
  for (std::size_t i = 1; i < 5; ++i) EXPECT_LE(log.objects[i - 1]->timestamp, log.objects[i]->timestamp);
}

TEST_F(LandmarkText, IdsMayBeMissing) {
  const auto log = read("10 5 0.1\n", "9 0 0\n");
  EXPECT_EQ(log.all<CObservationBearingRange>().at(0)->sensedData.at(0).landmarkID,
            mrpt::obs::INVALID_LANDMARK_ID);
}

TEST_F(LandmarkText, YawRateDrivesAnArc) {
  // a quarter of a circle with a radius of 2 m in 2 s
  const double speed = M_PI / 2, turn = M_PI / 4;
  const auto log =
      read("3\n", "0 " + std::to_string(speed) + " " + std::to_string(turn) + "\n2 0 0\n3 0 0\n");
  const auto odometry = log.all<CObservationOdometry>();
  ASSERT_EQ(odometry.size(), 3u);
  EXPECT_NEAR(odometry[2]->odometry.x(), 2, 1e-5);
  EXPECT_NEAR(odometry[2]->odometry.y(), 2, 1e-5);
  EXPECT_NEAR(odometry[2]->odometry.phi(), M_PI / 2, 1e-5);
  ASSERT_TRUE(odometry[0]->hasVelocities);
  EXPECT_NEAR(odometry[0]->velocityLocal.vx, speed, 1e-6);
  EXPECT_NEAR(odometry[0]->velocityLocal.omega, turn, 1e-6);
}

TEST_F(LandmarkText, SteeringFollowsTheModelOfTheVehicle) {
  options_.wheel_base = 2.83;
  options_.encoder_offset = 0.76;
  const auto log = read("1\n", "0 2 0.3\n1 2 0.3\n");
  const auto& velocity = log.all<CObservationOdometry>().at(0)->velocityLocal;
  // v = 2 / (1 − tan 0.3 · 0.76 / 2.83), ω = v tan 0.3 / 2.83; tan 0.3 = 0.30933625
  EXPECT_NEAR(velocity.vx, 2.1811978, 1e-6);
  EXPECT_NEAR(velocity.omega, 0.2384182, 1e-6);
}

TEST_F(LandmarkText, OdometryMayBePosesOrTum) {
  options_.odometry_file =
      temp_.write("o.txt", "1 0.5 -0.5 0.25\n2 1 2 0 0 0 0.7071067811865476 0.7071067811865476\n");
  const auto odometry = importText("1.5 5 0\n", options_).all<CObservationOdometry>();
  ASSERT_EQ(odometry.size(), 2u);
  EXPECT_NEAR(odometry[0]->odometry.phi(), 0.25, 1e-9);
  EXPECT_NEAR(odometry[1]->odometry.phi(), M_PI / 2, 1e-9);
  EXPECT_FALSE(odometry[0]->hasVelocities);
}

TEST_F(LandmarkText, RefusesWhatMakesNoSense) {
  EXPECT_THAT(refusal("1 5 0.1\n"), HasSubstr("either --odometry or --controls"));
  const auto damage = [&](const std::string& line) {
    return read("1 5 0\n" + line + "\n", "0 0 0\n").report.damage.at(0);
  };
  EXPECT_THAT(damage("2 5 0 0.35"),
              HasSubstr("a.log:2: '0.35' for the id of the landmark: expected a whole number"));
  EXPECT_THAT(damage("2 -5 0"), HasSubstr("the range is not above 0"));
  EXPECT_THAT(damage("0.5 5 0"), HasSubstr("the stamp is before"));
  EXPECT_THAT(damage("2 5"), HasSubstr("the line ends before the bearing"));
  EXPECT_THAT(damage("2 5 nan"), HasSubstr("expected a finite number"));
  EXPECT_THAT(damage("2 5 0 3000000000"), HasSubstr("expected at most 2147483647"));
  EXPECT_THAT(read("1 5 0 7\n1 6 0 8\n1 6 0.1 7\n2 5 0 7\n", "0 0 0\n").report.damage,
              testing::ElementsAre(HasSubstr("a.log:3: id 7 stands at this stamp already")));
  const auto controls = read("1 5 0\n", "0 0 0\n1 0\n0.5 0 0\n").report;
  EXPECT_EQ(controls.damaged_lines, 1u);
  EXPECT_THAT(controls.damage.at(0), HasSubstr("controls.txt:2: the line ends before the steering angle"));
}

}  // namespace
}  // namespace submap_slam
