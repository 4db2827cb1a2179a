#include <gmock/gmock.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <submap_slam/core/errors.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "../support/temp_folder.h"
#include "log_builder.h"

namespace submap_slam {
namespace {

using mrpt::math::TTwist2D;
using testing::AllOf;
using testing::HasSubstr;

/** A reading whose pose has nothing to do with its velocity. */
mrpt::obs::CObservationOdometry velocityAt(double seconds, double v, double omega) {
  auto odometry = odometryAt(seconds, 77, 77, 1);
  odometry.hasVelocities = true;
  odometry.velocityLocal = TTwist2D(v, 0, omega);
  return odometry;
}

ReaderParams driven(const std::string& model) {
  ReaderParams params;
  params.vehicle.model = model;
  return params;
}

std::vector<Frame> framesOf(const LogBuilder& log, const ReaderParams& params) {
  TempFolder temp;
  return framesOf(log.savePlain(temp.file("a.rawlog")), params);
}

TEST(VelocityOdometry, HoldsEachVelocityUntilTheNext) {
  LogBuilder log;
  log.add(velocityAt(0, 1, 0)).add(velocityAt(0.5, 2, 0)).add(scanAt(0.75)).add(velocityAt(1, 4, 0));
  log.add(velocityAt(1.5, 0, 0)).add(scanAt(2));
  const auto frames = framesOf(log, driven("velocity"));
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_NEAR(frames[0].odometry->x, 0.5 + 0.5, 1e-9);
  EXPECT_NEAR(frames[1].odometry->x, 0.5 + 1 + 2, 1e-9);
  EXPECT_FALSE(frames[0].motion_covariance);  // no frame before it
  EXPECT_TRUE(frames[1].motion_covariance);
}

TEST(VelocityOdometry, CovarianceIsThatOfTheStepsBetweenFrames) {
  LogBuilder log;
  for (int k = 0; k <= 40; ++k) {
    log.add(velocityAt(0.025 * k, 3, 0.2));
    if (k % 20 == 10) log.add(scanAt(0.025 * k + 0.01));
  }
  const ReaderParams params = driven("ackermann");
  const auto frames = framesOf(log, params);
  ASSERT_EQ(frames.size(), 2u);
  UncertainMotion expected(params.vehicle);
  for (int k = 0; k < 20; ++k) expected.step({3, 0, 0.2}, 0.025, 0.025);
  const auto& P = *frames[1].motion_covariance;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      EXPECT_NEAR(P(i, j), expected.covariance()(i, j), 0.01 * expected.covariance()(0, 0)) << i << j;
  EXPECT_NEAR(P(2, 2), expected.covariance()(2, 2), 1e-9);
}

TEST(VelocityOdometry, PosesAsLoggedHaveNoCovariance) {
  LogBuilder log;
  log.add(velocityAt(0, 1, 0)).add(scanAt(0)).add(velocityAt(1, 1, 0)).add(scanAt(1));
  for (const Frame& frame : framesOf(log, {})) {
    EXPECT_EQ(frame.odometry->x, 77);
    EXPECT_FALSE(frame.motion_covariance);
  }
}

TEST(VelocityOdometry, WhatIsNotKnownHasNoCovariance) {
  LogBuilder log;  // a gap of 3 s, and a clock that jumps back
  log.add(velocityAt(0, 1, 0)).add(scanAt(0)).add(velocityAt(3, 1, 0)).add(scanAt(3));
  log.add(velocityAt(3.5, 1, 0)).add(scanAt(3.5)).add(velocityAt(2, 1, 0)).add(scanAt(2));
  log.add(velocityAt(2.5, 1, 0)).add(scanAt(2.5));
  const auto frames = framesOf(log, driven("velocity"));
  ASSERT_EQ(frames.size(), 5u);
  EXPECT_NEAR(frames[1].odometry->x, 1, 1e-9);  // held for one second
  EXPECT_FALSE(frames[1].motion_covariance);
  EXPECT_TRUE(frames[2].motion_covariance);
  EXPECT_FALSE(frames[3].motion_covariance);
  EXPECT_TRUE(frames[4].motion_covariance);
}

TEST(VelocityOdometry, LogsWithoutVelocitiesAreRefused) {
  const auto errorOf = [](const LogBuilder& log) -> std::string {
    try {
      framesOf(log, driven("ackermann"));
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_THAT(errorOf(LogBuilder().add(scanAt(0)).add(odometryAt(1, 0, 0, 0))),
              AllOf(HasSubstr("[vehicle] model = ackermann needs velocities"), HasSubstr("entry 1")));
  EXPECT_THAT(errorOf(LogBuilder().add(movement(1, 0, 0)).addFrame({scanAt(0)})), HasSubstr("entry 0"));
}

TEST(VelocityOdometry, VelocitiesThatAreNotFiniteAreIgnored) {
  LogBuilder log;
  log.add(velocityAt(0, 1, 0)).add(velocityAt(0.5, std::nan(""), 0)).add(velocityAt(1, 1, 0)).add(scanAt(1));
  EXPECT_NEAR(framesOf(log, driven("velocity")).at(0).odometry->x, 1, 1e-9);
}

// Victoria Park: the log holds velocities of the rear axle, from which the raw readings follow.

struct RawControl {
  double time, encoder_speed, steering;
};

std::vector<RawControl> readControls(const std::string& file) {
  std::vector<RawControl> controls;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    RawControl c{};
    if (line[0] != '#' && std::istringstream(line) >> c.time >> c.encoder_speed >> c.steering)
      controls.push_back(c);
  }
  return controls;
}

TEST(VictoriaPark, RawControlsFollowFromTheLoggedVelocities) {
  const std::string folder = SHARED_DATA "/victoria_park/";
  if (!std::filesystem::exists(folder + "controls.txt")) GTEST_SKIP() << "no " << folder;
  const auto raw = readControls(folder + "controls.txt");
  const VehicleParams params = driven("ackermann").vehicle;
  mrpt::io::CFileGZInputStream in(folder + "victoria_park_observations.rawlog");
  auto archive = mrpt::serialization::archiveFrom(in);
  std::size_t compared = 0;
  while (compared < 5000) {
    const auto reading = std::dynamic_pointer_cast<mrpt::obs::CObservationOdometry>(archive.ReadObject());
    if (!reading) continue;
    const CarControl control = controlOf(reading->velocityLocal, params);
    const RawControl& expected = raw.at(compared++);
    ASSERT_NEAR(mrpt::Clock::toDouble(reading->timestamp), expected.time, 1e-4);
    ASSERT_NEAR(control.encoder_speed, expected.encoder_speed, 2e-6);
    if (expected.encoder_speed > 0) {
      ASSERT_NEAR(control.steering, expected.steering, 1e-6);
    }
  }
}

}  // namespace
}  // namespace submap_slam
