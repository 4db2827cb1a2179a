#include "carmen_survey.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "words.h"

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;

constexpr double kSamePosition_m = 0.02, kSameHeading_rad = 0.02;  // logs round poses
constexpr double kSameReading_m = 0.01;

bool same(const TPose2D& a, const TPose2D& b) {
  return std::hypot(a.x - b.x, a.y - b.y) < kSamePosition_m &&
         std::abs(std::remainder(a.phi - b.phi, 2 * M_PI)) < kSameHeading_rad;
}

void addReading(CarmenLaserSurvey& laser, double range) {
  if (!std::isfinite(range)) return;
  ++laser.readings;
  if (range > laser.greatest_m + kSameReading_m) laser.greatest_count = 0;
  laser.greatest_m = std::max(laser.greatest_m, range);
  if (range > laser.greatest_m - kSameReading_m) ++laser.greatest_count;
}

void addScan(CarmenLaserSurvey& laser, const CarmenScan& scan) {
  laser.stamps.push_back(scan.stamps);
  for (const double range : scan.ranges_m) addReading(laser, range);
  if (!scan.T_w_laser || !scan.T_odom_robot) return;
  const TPose2D T_robot_laser = *scan.T_w_laser - *scan.T_odom_robot;
  if (!laser.T_robot_laser) laser.T_robot_laser = T_robot_laser;
  laser.steady = laser.steady && same(*laser.T_robot_laser, T_robot_laser);
}

}  // namespace

void CarmenSurvey::add(const CarmenMessage& message) {
  if (const auto* scan = std::get_if<CarmenScan>(&message)) addScan(lasers[scan->kind][scan->laser], *scan);
  if (const auto* reading = std::get_if<CarmenOdometry>(&message)) odometry.push_back(reading->stamps);
  if (const auto* given = std::get_if<CarmenParam>(&message)) params[given->name] = given->value;
}

std::optional<double> CarmenSurvey::param(const std::string& name) const {
  const auto found = params.find(name);
  if (found == params.end() || !isNumber(found->second)) return std::nullopt;
  return Words(found->second).number(name.c_str());
}

std::optional<double> maxRangeOf(const CarmenLaserSurvey& laser) {
  // SICK LMS: 13 bits in cm or mm; 14 and 15 bits in mm. The last nine values are codes, not ranges.
  struct SickMode {
    double first_code_m, last_code_m, max_range;
  };
  constexpr std::array<SickMode, 4> kSick = {
      SickMode{81.83, 81.91, 80}, {8.183, 8.191, 8}, {16.375, 16.383, 16}, {32.759, 32.767, 32}};
  for (const auto& mode : kSick)
    if (laser.greatest_m > mode.first_code_m - 5e-3 && laser.greatest_m < mode.last_code_m + 5e-3)
      return mode.max_range;
  constexpr uint64_t kLeastCount = 20;
  constexpr double kLeastShare = 1e-3, kMostShare = 0.9;
  const double share = static_cast<double>(laser.greatest_count) / static_cast<double>(laser.readings);
  if (laser.greatest_count < kLeastCount || share < kLeastShare || share > kMostShare) return std::nullopt;
  return std::floor(laser.greatest_m * 100 + 1e-6) / 100;
}

}  // namespace submap_slam
