#include <fmt/format.h>
#include <submap_slam/core/errors.h>

#include <cmath>
#include <map>
#include <optional>

#include "carmen_survey.h"
#include "forms.h"
#include "laser_scan.h"
#include "rawlog_output.h"
#include "stamp_repair.h"
#include "text_lines.h"
#include "words.h"

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;

constexpr double kDegree = M_PI / 180;

std::string nameOf(CarmenScan::Kind kind) {
  switch (kind) {
    case CarmenScan::Kind::kRobotLaser:
      return "ROBOTLASER";
    case CarmenScan::Kind::kOld:
      return "FLASER/RLASER";
    case CarmenScan::Kind::kRaw:
      return "RAWLASER";
  }
  return "";
}

std::string labelOf(uint32_t laser) { return laser == 1 ? "LASER" : fmt::format("LASER_{}", laser); }

// Stamps

std::vector<double> pick(const std::vector<CarmenStampPair>& pairs, double CarmenStampPair::*which) {
  std::vector<double> stamps;
  stamps.reserve(pairs.size());
  for (const auto& pair : pairs) stamps.push_back(pair.*which);
  return stamps;
}

/** The increasing stamps of the messages of one sensor; says in the report what was done. */
std::vector<double> stampsOf(const std::string& sensor, const std::vector<CarmenStampPair>& pairs,
                             const ImportJob& job) {
  RepairedStamps ipc = repairStamps(pick(pairs, &CarmenStampPair::ipc));
  RepairedStamps logger = repairStamps(pick(pairs, &CarmenStampPair::logger));
  bool take_logger = job.options.stamps == CarmenStamps::kLogger;
  if (job.options.stamps == CarmenStamps::kAuto)
    take_logger = 2 * ipc.replaced > pairs.size() && logger.replaced < ipc.replaced;
  RepairedStamps& chosen = take_logger ? logger : ipc;
  const char* const name = take_logger ? "logger" : "ipc";
  if (take_logger && job.options.stamps == CarmenStamps::kAuto)
    job.report.warnings.push_back(fmt::format(
        "{}: ipc_timestamp runs backwards in more than half of the lines; logger_timestamp is taken",
        sensor));
  if (chosen.replaced > 0)
    job.report.warnings.push_back(
        fmt::format("{}: {} of {} {}_timestamps do not increase; they were replaced by ones between their "
                    "neighbours, by up to {:.3f} s",
                    sensor, chosen.replaced, pairs.size(), name, chosen.largest_shift_s));
  return std::move(chosen.stamps_s);
}

// Scanners

/** Beams of FLASER and RLASER, which do not say their angles, by their number: SICK's modes. */
std::optional<BeamAngles> sickAngles(std::size_t beams) {
  if (beams == 180 || beams == 181) return BeamAngles{-90 * kDegree, 1 * kDegree};
  if (beams == 360 || beams == 361) return BeamAngles{-90 * kDegree, 0.5 * kDegree};
  if (beams == 400 || beams == 401) return BeamAngles{-50 * kDegree, 0.25 * kDegree};
  return std::nullopt;
}

/** Pose of the laser by the parameters of the robot; the rear one looks back. */
TPose2D poseByParams(const CarmenSurvey& survey, uint32_t laser) {
  const bool rear = laser == 2;
  const std::string prefix = rear ? "robot_rearlaser_" : "robot_frontlaser_";
  TPose2D pose(0, 0, rear ? M_PI : 0);
  if (laser > 2) return pose;
  pose.x = survey.param(prefix + "offset").value_or(0);
  pose.y = survey.param(prefix + "side_offset").value_or(0);
  const double angle = survey.param(prefix + "angular_offset").value_or(pose.phi);
  pose.phi = std::abs(angle) > 2 * M_PI ? angle * kDegree : angle;  // some logs have degrees
  return pose;
}

/** Poses of old lines are those of laser and robot; where they coincide, or one is corrected, the parameters
 * know better. */
TPose2D poseOnRobot(const CarmenSurvey& survey, const CarmenLaserSurvey& laser, uint32_t number) {
  const bool says = laser.steady && laser.T_robot_laser &&
                    (std::abs(laser.T_robot_laser->x) > 1e-3 || std::abs(laser.T_robot_laser->y) > 1e-3 ||
                     std::abs(laser.T_robot_laser->phi) > 1e-3);
  return says ? *laser.T_robot_laser : poseByParams(survey, number);
}

/** What is known of a scanner before its lines are read; zero maximum range: each line says it. */
Scanner scannerOf(const CarmenSurvey& survey, CarmenScan::Kind kind, uint32_t number, const ImportJob& job) {
  const CarmenLaserSurvey& laser = survey.lasers.at(kind).at(number);
  Scanner scanner;
  scanner.label = labelOf(number);
  scanner.T_robot_sensor = job.options.T_robot_sensor.value_or(poseOnRobot(survey, laser, number));
  const auto by_readings = maxRangeOf(laser);
  const auto by_param = survey.param(number == 2 ? "robot_rear_laser_max" : "robot_front_laser_max");
  if (job.options.max_range) {
    scanner.max_range = *job.options.max_range;
  } else if (kind == CarmenScan::Kind::kOld) {
    scanner.max_range = std::min(by_readings.value_or(by_param.value_or(laser.greatest_m + 1)),
                                 by_param.value_or(laser.greatest_m + 1));
    if (!by_readings && !by_param)
      job.report.warnings.push_back(
          fmt::format("{}: the log does not say which ranges are no return; all up to {:.2f} m are taken for "
                      "hits. If that is wrong: --max-range",
                      scanner.label, laser.greatest_m));
  }
  return scanner;
}

void noteScanner(const Scanner& scanner, const ImportJob& job) {
  const TPose2D& pose = scanner.T_robot_sensor;
  const std::string range = scanner.max_range > 0
                                ? fmt::format("from {:.2f} m on beams count as no return", scanner.max_range)
                                : "no return as each line says";
  job.report.notes.push_back(fmt::format("{}: at x {:.3f} y {:.3f} m, yaw {:.2f} deg on the robot; {}",
                                         scanner.label, pose.x, pose.y, pose.phi / kDegree, range));
}

/** Second pass: writes the messages of one kind of scans. */
class CarmenWriter {
 public:
  CarmenWriter(const CarmenSurvey& survey, CarmenScan::Kind kind, const ImportJob& job)
      : kind_(kind), job_(job), out_(job.output) {
    for (const auto& [number, laser] : survey.lasers.at(kind)) {
      Stream& stream = lasers_[number];
      stream.scanner = scannerOf(survey, kind, number, job);
      stream.stamps_s = stampsOf(stream.scanner.label, laser.stamps, job);
      noteScanner(stream.scanner, job);
    }
    if (kind == CarmenScan::Kind::kRaw) odometry_.stamps_s = stampsOf("ODOM", survey.odometry, job);
  }

  void write(const CarmenMessage& message) {
    if (const auto* scan = std::get_if<CarmenScan>(&message); scan != nullptr && scan->kind == kind_)
      writeScan(*scan);
    const auto* reading = std::get_if<CarmenOdometry>(&message);
    if (reading != nullptr && kind_ == CarmenScan::Kind::kRaw)
      writeOdometry(odometry_.nextStamp(), reading->T_odom_robot);
  }

  void close() { out_.close(); }

 private:
  struct Stream {
    Scanner scanner;
    std::vector<double> stamps_s;
    std::size_t used = 0;
    double nextStamp() { return stamps_s.at(used++); }
  };

  void writeScan(const CarmenScan& scan) {
    Stream& stream = lasers_.at(scan.laser);
    const double stamp_s = stream.nextStamp();
    Scanner scanner = stream.scanner;
    const auto angles = scan.angles ? scan.angles : sickAngles(scan.ranges_m.size());
    if (!angles && !job_.options.beam_angles)
      throw LineError(
          fmt::format("{} readings: the line does not say at which angles; give --beams FIRST,STEP",
                      scan.ranges_m.size()));
    scanner.angles = job_.options.beam_angles.value_or(angles.value_or(BeamAngles{}));
    if (scanner.max_range <= 0) scanner.max_range = scan.max_range;
    if (scan.kind == CarmenScan::Kind::kRobotLaser && !job_.options.T_robot_sensor)
      scanner.T_robot_sensor = *scan.T_w_laser - *scan.T_odom_robot;
    if (scan.T_odom_robot) writeOdometry(stamp_s, *scan.T_odom_robot);
    out_.write(makeScan(scanner, stamp_s, scan.ranges_m));
    ++job_.report.written["scans of " + scanner.label];
  }

  void writeOdometry(double stamp_s, const TPose2D& pose) {
    out_.write(makeOdometry(stamp_s, pose));
    ++job_.report.written["odometry readings"];
  }

  CarmenScan::Kind kind_;
  ImportJob job_;
  RawlogOutput out_;
  std::map<uint32_t, Stream> lasers_;
  Stream odometry_;
};

void noteUnusedKinds(const CarmenSurvey& survey, const ImportJob& job) {
  for (auto kind = std::next(survey.lasers.begin()); kind != survey.lasers.end(); ++kind)
    job.report.notes.push_back(fmt::format("the {} lines are left out: {} lines say more of the same scans",
                                           nameOf(kind->first), nameOf(survey.lasers.begin()->first)));
}

}  // namespace

void importCarmen(const ImportJob& job) {
  CarmenSurvey survey;
  forEachLine(
      job.file, [&](std::string_view line) { survey.add(parseCarmenLine(line)); }, nullptr,
      [&](double share, const std::string&) { return job.progress(share, "looking through the log"); });
  if (survey.lasers.empty()) throw InputError(fmt::format("{}: holds no laser scan", job.file));
  noteUnusedKinds(survey, job);
  CarmenWriter writer(survey, survey.lasers.begin()->first, job);
  forEachLine(
      job.file, [&](std::string_view line) { writer.write(parseCarmenLine(line)); }, &job.report,
      [&](double share, const std::string&) { return job.progress(share, "writing the rawlog"); });
  writer.close();
}

}  // namespace submap_slam
