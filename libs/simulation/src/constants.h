#pragma once

#include <cstdint>

namespace submap_slam {

constexpr double kPi = 3.141592653589793;

/** What odometry is written in: m, rad, m/s, rad/s. */
constexpr double kOdometryStep = 1e-6;

/** Streams of random numbers of one seed. */
enum Stream : uint32_t {
  kOdometryStream = 1,
  kLaserStream = 2,
  kControlStream = 3,
  kSensorStream = 4,
  kPlaceStream = 5
};

}  // namespace submap_slam
