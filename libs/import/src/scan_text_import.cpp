#include <fmt/format.h>
#include <submap_slam/core/errors.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "forms.h"
#include "laser_scan.h"
#include "rawlog_output.h"
#include "text_lines.h"
#include "words.h"

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;

constexpr std::array<std::string_view, 6> kKeys = {"angle_min",   "angle_increment", "range_max",
                                                   "sensor_pose", "sensor_label",    "odometry"};

/** Reads the header, then writes the scans. */
class ScanText {
 public:
  explicit ScanText(const ImportJob& job) : job_(job), out_(job.output) { scanner_.label = "LASER"; }

  void readLine(std::string_view line) {
    Words words(line);
    Words ahead(line);
    if (isNumber(ahead.next()))
      writeScan(words);
    else
      readHeader(words);
  }

  void close() { out_.close(); }

 private:
  void readHeader(Words& words) {
    const std::string_view key = words.next();
    if (!isScanTextKey(key))
      throw LineError(
          fmt::format("'{}': expected a stamp or one of {}", key.substr(0, 40), fmt::join(kKeys, ", ")));
    if (in_scans_) throw LineError(fmt::format("{} behind the first scan", key));
    if (key == "angle_min") angle_min_ = words.number("angle_min");
    if (key == "angle_increment") angle_increment_ = words.number("angle_increment");
    if (key == "range_max") scanner_.max_range = words.number("range_max");
    if (key == "sensor_label") scanner_.label = std::string(words.next());
    if (key == "odometry") readOdometryKey(words);
    if (key == "sensor_pose") {
      scanner_.T_robot_sensor.x = words.number("x of the sensor");
      scanner_.T_robot_sensor.y = words.number("y of the sensor");
      scanner_.T_robot_sensor.phi = words.number("yaw of the sensor");
    }
    words.requireEnd();
  }

  void readOdometryKey(Words& words) {
    const std::string_view value = words.next();
    if (value != "none" && value != "pose")
      throw LineError(fmt::format("odometry '{}': expected pose or none", value.substr(0, 40)));
    has_odometry_ = value == "pose";
  }

  /** The header is complete, or nothing of the file can be used. */
  void beginScans() {
    in_scans_ = true;
    if (job_.options.max_range) scanner_.max_range = *job_.options.max_range;
    if (job_.options.T_robot_sensor) scanner_.T_robot_sensor = *job_.options.T_robot_sensor;
    if (job_.options.beam_angles) {
      scanner_.angles = *job_.options.beam_angles;
    } else if (angle_min_ && angle_increment_) {
      scanner_.angles = {*angle_min_, *angle_increment_};
    } else {
      throw InputError(fmt::format("{}: no {} before the first scan", job_.file,
                                   angle_min_ ? "angle_increment" : "angle_min"));
    }
    if (!(scanner_.max_range > 0))
      throw InputError(fmt::format("{}: no range_max above 0 before the first scan", job_.file));
    if (scanner_.angles.step == 0) throw InputError(fmt::format("{}: angle_increment is 0", job_.file));
  }

  void writeScan(Words& words) {
    if (!in_scans_) beginScans();
    const double stamp_s = words.number("the stamp");
    TPose2D odometry;
    if (has_odometry_) {
      odometry.x = words.number("x by odometry");
      odometry.y = words.number("y by odometry");
      odometry.phi = words.number("theta by odometry");
    }
    std::vector<double> ranges(words.left());
    if (ranges.empty()) throw LineError("the line ends before the first range");
    if (beams_ == 0) beams_ = ranges.size();
    if (ranges.size() != beams_)
      throw LineError(fmt::format("{} ranges: expected {} as in the first scan", ranges.size(), beams_));
    for (auto& range : ranges) range = words.anyNumber("a range");
    if (has_odometry_) {
      out_.write(makeOdometry(stamp_s, odometry));
      ++job_.report.written["odometry readings"];
    }
    out_.write(makeScan(scanner_, stamp_s, ranges));
    ++job_.report.written["scans of " + scanner_.label];
  }

  ImportJob job_;
  RawlogOutput out_;
  Scanner scanner_;
  std::optional<double> angle_min_, angle_increment_;
  bool has_odometry_ = true, in_scans_ = false;
  std::size_t beams_ = 0;
};

}  // namespace

bool isScanTextKey(std::string_view word) {
  return std::find(kKeys.begin(), kKeys.end(), word) != kKeys.end();
}

void importScanText(const ImportJob& job) {
  ScanText text(job);
  forEachLine(
      job.file, [&](std::string_view line) { text.readLine(line); }, &job.report, job.progress);
  text.close();
}

}  // namespace submap_slam
