#include "carmen_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "words.h"

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;

constexpr uint32_t kMostBeams = 100000;
constexpr std::size_t kStampWords = 3;                     // ipc_timestamp ipc_hostname logger_timestamp
constexpr std::size_t kRobotLaserTail = 11 + kStampWords;  // two poses, five numbers of motion and safety

bool takePrefix(std::string_view& word, std::string_view prefix) {
  if (word.substr(0, prefix.size()) != prefix) return false;
  word.remove_prefix(prefix.size());
  return true;
}

TPose2D readPose(Words& words, const char* what) {
  TPose2D pose;
  pose.x = words.number(what);
  pose.y = words.number(what);
  pose.phi = words.number(what);
  return pose;
}

/** `ipc_timestamp ipc_hostname logger_timestamp`; some writers leave out the last one, or the last two. */
CarmenStampPair readStamps(Words& words) {
  CarmenStampPair stamps;
  stamps.ipc = stamps.logger = words.number("ipc_timestamp");
  words.next();  // host
  if (words.left() > 0) stamps.logger = words.number("logger_timestamp");
  words.requireEnd();
  return stamps;
}

std::vector<double> readRanges(Words& words) {
  const uint32_t count = words.wholeNumber("num_readings");
  if (count == 0 || count > kMostBeams)
    throw LineError(fmt::format("num_readings is {}: expected 1 to {}", count, kMostBeams));
  std::vector<double> ranges(count);
  for (auto& range : ranges) range = words.anyNumber("a range");
  return ranges;
}

/** `laser_type start_angle field_of_view angular_resolution maximum_range accuracy remission_mode
 * num_readings [readings]` */
void readConfiguredRanges(Words& words, CarmenScan& scan) {
  words.number("laser_type");
  BeamAngles angles;
  angles.first = words.number("start_angle");
  const double field_of_view = words.number("field_of_view");
  angles.step = words.number("angular_resolution");
  scan.max_range = words.number("maximum_range");
  words.number("accuracy");
  words.number("remission_mode");
  scan.ranges_m = readRanges(words);
  if (angles.step == 0 && scan.ranges_m.size() > 1)
    angles.step = field_of_view / static_cast<double>(scan.ranges_m.size() - 1);
  const double span = std::abs(angles.step) * static_cast<double>(scan.ranges_m.size() - 1);
  if (span > 2 * M_PI + 1e-3)
    throw LineError(fmt::format("{} readings {:.4g} rad apart are more than a full circle",
                                scan.ranges_m.size(), angles.step));
  scan.angles = angles;
}

/** `num_remissions [remissions]` where the line has them; the first writers of ROBOTLASER did not. */
void skipRemissions(Words& words, std::size_t words_behind) {
  if (words.left() <= words_behind) return;
  const uint32_t count = words.wholeNumber("num_remissions");
  for (uint32_t i = 0; i < count; ++i) words.anyNumber("a remission");
}

CarmenScan readRobotLaser(Words& words, uint32_t laser) {
  CarmenScan scan;
  scan.kind = CarmenScan::Kind::kRobotLaser;
  scan.laser = laser;
  readConfiguredRanges(words, scan);
  skipRemissions(words, kRobotLaserTail);
  scan.T_w_laser = readPose(words, "laser_pose");
  scan.T_odom_robot = readPose(words, "robot_pose");
  for (const char* what : {"laser_tv", "laser_rv", "forward_safety_dist", "side_safety_dist", "turn_axis"})
    words.anyNumber(what);
  scan.stamps = readStamps(words);
  return scan;
}

CarmenScan readRawLaser(Words& words, uint32_t laser) {
  CarmenScan scan;
  scan.kind = CarmenScan::Kind::kRaw;
  scan.laser = laser;
  readConfiguredRanges(words, scan);
  skipRemissions(words, kStampWords);
  scan.stamps = readStamps(words);
  return scan;
}

CarmenScan readOldLaser(Words& words, uint32_t laser) {
  CarmenScan scan;
  scan.laser = laser;
  scan.ranges_m = readRanges(words);
  scan.T_w_laser = readPose(words, "x, y, theta");
  scan.T_odom_robot = readPose(words, "odom_x, odom_y, odom_theta");
  scan.stamps = readStamps(words);
  return scan;
}

/** `x y theta tv rv accel ipc_timestamp …` */
CarmenOdometry readOdometry(Words& words) {
  CarmenOdometry odometry;
  odometry.T_odom_robot = readPose(words, "x, y, theta");
  for (const char* what : {"tv", "rv", "accel"}) words.anyNumber(what);
  odometry.stamps = readStamps(words);
  return odometry;
}

uint32_t laserNumber(std::string_view digits) {
  Words words(digits);
  return words.wholeNumber("the number of the laser");
}

}  // namespace

CarmenMessage parseCarmenLine(std::string_view line) {
  Words words(line);
  std::string_view keyword = words.next();
  if (keyword == "FLASER") return readOldLaser(words, 1);
  if (keyword == "RLASER") return readOldLaser(words, 2);
  if (keyword == "ODOM") return readOdometry(words);
  if (keyword == "PARAM") return CarmenParam{std::string(words.next()), std::string(words.next())};
  if (takePrefix(keyword, "ROBOTLASER")) return readRobotLaser(words, laserNumber(keyword));
  if (takePrefix(keyword, "RAWLASER")) return readRawLaser(words, laserNumber(keyword));
  return CarmenOther{};
}

bool isCarmenKeyword(std::string_view word) {
  constexpr std::array<std::string_view, 12> kKeywords = {"FLASER",  "RLASER", "ODOM",    "PARAM",
                                                          "TRUEPOS", "SYNC",   "MARKER",  "POSITION",
                                                          "COMMENT", "GPSLOC", "NMEAGGA", "IMU"};
  return std::find(kKeywords.begin(), kKeywords.end(), word) != kKeywords.end() ||
         takePrefix(word, "ROBOTLASER") || takePrefix(word, "RAWLASER");
}

}  // namespace submap_slam
