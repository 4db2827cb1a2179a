#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "carmen_line.h"

namespace submap_slam {

/** What the scan lines of one scanner say in all. */
struct CarmenLaserSurvey {
  std::vector<CarmenStampPair> stamps;
  std::optional<mrpt::math::TPose2D> T_robot_laser;  ///< of the first line with both poses
  bool steady = true;                                ///< all lines have it
  double greatest_m = 0;                             ///< reading
  uint64_t readings = 0, greatest_count = 0;         ///< in all; within 1 cm of the greatest one
};

/** First pass over a CARMEN log: what must be known before the first scan is written. */
struct CarmenSurvey {
  using Scanners = std::map<uint32_t, CarmenLaserSurvey>;  ///< by number
  std::map<CarmenScan::Kind, Scanners> lasers;
  std::vector<CarmenStampPair> odometry;
  std::map<std::string, std::string> params;  ///< the last value of each

  void add(const CarmenMessage& message);

  /** A parameter as a number, if it is there and is one. */
  std::optional<double> param(const std::string& name) const;
};

/** Highest range that counts as a return, by the readings: scanners report a beam without return as one and
 * the same greatest value, SICK's by codes of error just above their maximum. Empty: no such value stands
 * out. */
std::optional<double> maxRangeOf(const CarmenLaserSurvey& laser);

}  // namespace submap_slam
