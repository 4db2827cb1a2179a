#include <fmt/format.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/system/string_utils.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/rawlog/rawlog_reader.h>

#include <charconv>
#include <cmath>
#include <set>
#include <utility>

#include "frame_assembler.h"
#include "landmark_scan.h"
#include "log_statistics.h"
#include "no_frames.h"
#include "object_stream.h"
#include "scan_check.h"
#include "velocity_odometry.h"

namespace submap_slam {
namespace {

using mrpt::obs::CActionRobotMovement2D;
using mrpt::obs::CObservation2DRangeScan;
using mrpt::obs::CObservationBearingRange;

/** A place in the log: an entry, or seconds from the first stamp. */
struct LogPlace {
  std::optional<uint64_t> entry;
  std::optional<double> seconds;
};

LogPlace parsePlace(const std::string& key, const std::string& text) {
  LogPlace place;
  if (text.empty()) return place;
  const bool timed = text.back() == 's';
  const char *begin = text.data(), *end = begin + text.size() - (timed ? 1 : 0);
  const auto parse = [&](auto& value) {
    const auto [rest, error] = std::from_chars(begin, end, value);
    return error == std::errc() && rest == end && begin != end;
  };
  const bool good =
      timed ? parse(place.seconds.emplace()) && std::isfinite(*place.seconds) && *place.seconds >= 0
            : parse(place.entry.emplace());
  if (!good)
    throw ConfigError(
        fmt::format("[reader] {} = {}: expected an entry number such as 1200, or seconds from the first "
                    "stamp such as 60s",
                    key, text));
  return place;
}

std::set<std::string> parseLabels(const std::string& list) {
  std::vector<std::string> labels;
  mrpt::system::tokenize(list, ",", labels);
  std::set<std::string> result;
  for (const auto& label : labels)
    if (const auto trimmed = mrpt::system::trim(label); !trimmed.empty()) result.insert(trimmed);
  return result;
}

bool isFinite(const mrpt::math::TPose2D& pose) {
  return std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.phi);
}

/** The movement to use of those in an action collection: odometry before estimates by scan matching. */
CActionRobotMovement2D::Ptr chooseMovement(const mrpt::obs::CActionCollection& actions) {
  CActionRobotMovement2D::Ptr chosen;
  for (const auto& action : actions) {
    auto movement = std::dynamic_pointer_cast<CActionRobotMovement2D>(action.get_ptr());
    if (!movement) continue;
    if (movement->estimationMethod == CActionRobotMovement2D::emOdometry) return movement;
    if (!chosen) chosen = movement;
  }
  return chosen;
}

/** So many frames in a row stamped behind `to` are the end; fewer have wrong stamps. */
constexpr uint64_t kFramesBehindTo = 10;

std::string nameOf(const mrpt::rtti::CObject& object) { return object.GetRuntimeClass()->className; }

}  // namespace

void describe(ParameterTable& table, ReaderParams& params) {
  table.section("reader", "Reading rawlogs");
  table.add("sensor_labels", params.sensor_labels,
            "Sensor labels of the scanners to use, separated by commas; empty: all 2D scanners");
  table.add("landmark_labels", params.landmark_labels,
            "Sensor labels of the landmark observations (range and bearing) to use, separated by commas; "
            "empty: all");
  table.add("min_range", params.min_range, "m", {0, 1e3},
            "Ranges below this are invalid: the robot's own body, or a zero that marks an error; also of "
            "landmarks");
  table.add("from", params.from,
            "Where to start: a rawlog entry such as 1200, or seconds from the first stamp such as 60s; "
            "empty: at the "
            "start");
  table.add("to", params.to, "Last rawlog entry, or seconds from the first stamp, to use; empty: to the end");
  describe(table, params.vehicle);
}

struct RawlogReader::Impl {
  Impl(const std::string& file, const ReaderParams& reader_params)
      : params(reader_params),
        labels(parseLabels(params.sensor_labels)),
        landmark_labels(parseLabels(params.landmark_labels)),
        from(parsePlace("from", params.from)),
        to(parsePlace("to", params.to)),
        stream(file),
        velocities(params.vehicle) {
    validate(params.vehicle);
    if (!(params.min_range >= 0))
      throw ConfigError(fmt::format("[reader] min_range = {}: must not be negative", params.min_range));
    report.file = file;
    report.file_bytes = stream.fileBytes();
  }

  ReaderParams params;
  std::set<std::string> labels, landmark_labels;
  LogPlace from, to;
  ObjectStream stream;
  FrameAssembler assembler;
  VelocityOdometry velocities;
  LogStatistics statistics;
  LogReport report;
  std::optional<mrpt::Clock::time_point> first_stamp;
  std::optional<mrpt::Clock::time_point> last_frame_stamp;  ///< of the frames that were delivered
  uint64_t frames_behind_to = 0;                            ///< in a row, up to the last one
  bool started = false;                                     ///< `from` was reached
  bool source_done = false;                                 ///< nothing more to read
  bool ended = false;                                       ///< nothing more to deliver, findings are made

  std::optional<Frame> next();
  void readEntry();
  void take(const mrpt::serialization::CSerializable::Ptr& object);
  void takeActions(const mrpt::obs::CActionCollection& actions);
  void takeSensoryFrame(const mrpt::obs::CSensoryFrame& sensory_frame);
  void takeObservation(const mrpt::obs::CObservation::Ptr& observation);
  void requireVelocities(bool has_velocities) const;
  mrpt::math::TPose2D poseOf(const mrpt::obs::CObservationOdometry& reading);
  void takeReading(const mrpt::obs::CObservationOdometry& reading);
  void takeScan(const CObservation2DRangeScan::Ptr& scan);
  bool accept(const CObservation2DRangeScan& scan);
  void takeLandmarks(const CObservationBearingRange& observation);
  void noteStamp(mrpt::Clock::time_point stamp);
  bool isBehind(const LogPlace& place, const LoggedFrame& logged, bool inclusive) const;
  void end(const std::optional<LogDamage>& found);
};

std::optional<Frame> RawlogReader::Impl::next() {
  while (!ended) {
    if (auto logged = assembler.pop()) {
      if (isBehind(to, *logged, false)) {
        if (!to.entry && ++frames_behind_to < kFramesBehindTo) continue;
        end(std::nullopt);  // what lies behind `to` does not matter, damage included
        break;
      }
      report.skipped_frames_stamp += std::exchange(frames_behind_to, 0);
      logged->frame.index -= report.skipped_frames_stamp;
      started = started || isBehind(from, *logged, true);
      if (!started) continue;
      if (last_frame_stamp && params.vehicle.usesVelocities())
        logged->frame.motion_covariance = velocities.covariance(*last_frame_stamp, logged->frame.stamp);
      last_frame_stamp = logged->frame.stamp;
      statistics.add(logged->frame, params.min_range, report);
      return std::move(logged->frame);
    }
    if (source_done) break;
    readEntry();
  }
  if (!ended) end(frames_behind_to > 0 ? std::nullopt : stream.damage());
  return std::nullopt;
}

/** Whether the frame is behind the place (or, if inclusive, at it). */
bool RawlogReader::Impl::isBehind(const LogPlace& place, const LoggedFrame& logged, bool inclusive) const {
  if (place.entry) return logged.entry > *place.entry || (inclusive && logged.entry == *place.entry);
  if (!place.seconds) return inclusive;  // no `from`: every frame is behind it; no `to`: none is
  const double seconds = secondsBetween(first_stamp.value_or(logged.frame.stamp), logged.frame.stamp);
  return seconds > *place.seconds || (inclusive && seconds == *place.seconds);
}

void RawlogReader::Impl::readEntry() {
  const auto object = stream.next();
  if (object) {
    take(object);
  } else {
    source_done = true;
    assembler.finish();
  }
  report.entries = stream.entries();
  report.bytes_read = stream.fileBytesRead();
}

void RawlogReader::Impl::take(const mrpt::serialization::CSerializable::Ptr& object) {
  if (const auto observation = std::dynamic_pointer_cast<mrpt::obs::CObservation>(object)) {
    takeObservation(observation);
    return;
  }
  ++report.classes[nameOf(*object)];
  if (const auto actions = std::dynamic_pointer_cast<mrpt::obs::CActionCollection>(object))
    takeActions(*actions);
  else if (const auto sensory_frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object))
    takeSensoryFrame(*sensory_frame);
  else if (std::dynamic_pointer_cast<mrpt::obs::CRawlog>(object))
    ++report.nested_logs;
}

void RawlogReader::Impl::takeActions(const mrpt::obs::CActionCollection& actions) {
  const auto movement = chooseMovement(actions);
  if (!movement) return;
  requireVelocities(false);  // increments are all that actions are sure to have
  const bool by_odometry = movement->estimationMethod == CActionRobotMovement2D::emOdometry;
  // With emOdometry the log stores the raw increment; the pose change is drawn anew from the motion model
  // when it is read.
  const auto increment = by_odometry ? movement->rawOdometryIncrementReading.asTPose()
                                     : movement->poseChange->getMeanVal().asTPose();
  if (!isFinite(increment) || !assembler.addIncrement(increment)) {
    ++report.ignored_odometry;
    return;
  }
  ++report.odometry_readings;
  if (!by_odometry) ++report.matched_increments;
}

void RawlogReader::Impl::takeSensoryFrame(const mrpt::obs::CSensoryFrame& sensory_frame) {
  assembler.closeFrame();
  for (const auto& observation : sensory_frame) takeObservation(observation);
  assembler.closeFrame();
}

void RawlogReader::Impl::takeObservation(const mrpt::obs::CObservation::Ptr& observation) {
  ++report.classes[nameOf(*observation)];
  if (const auto scan = std::dynamic_pointer_cast<CObservation2DRangeScan>(observation))
    takeScan(scan);
  else if (const auto landmarks = std::dynamic_pointer_cast<CObservationBearingRange>(observation))
    takeLandmarks(*landmarks);
  else if (const auto reading = std::dynamic_pointer_cast<mrpt::obs::CObservationOdometry>(observation))
    takeReading(*reading);
}

void RawlogReader::Impl::requireVelocities(bool has_velocities) const {
  if (params.vehicle.usesVelocities() && !has_velocities)
    throw ConfigError(
        fmt::format("{}: [vehicle] model = {} needs velocities, but the odometry of entry {} has none",
                    report.file, params.vehicle.model, stream.entries() - 1));
}

/** T_odom_robot by the logged pose or, if the vehicle is driven by velocities, by these; not finite if they
 * are not. */
mrpt::math::TPose2D RawlogReader::Impl::poseOf(const mrpt::obs::CObservationOdometry& reading) {
  requireVelocities(reading.hasVelocities);
  if (!params.vehicle.usesVelocities()) return reading.odometry.asTPose();
  const auto& v = reading.velocityLocal;
  const mrpt::math::TPose2D as_pose(v.vx, v.vy, v.omega);
  return isFinite(as_pose) ? velocities.add(reading.timestamp, v) : as_pose;
}

void RawlogReader::Impl::takeReading(const mrpt::obs::CObservationOdometry& reading) {
  noteStamp(reading.timestamp);
  const auto pose = poseOf(reading);
  if (isFinite(pose) && assembler.addReading(reading.timestamp, pose))
    ++report.odometry_readings;
  else
    ++report.ignored_odometry;
}

void RawlogReader::Impl::takeScan(const CObservation2DRangeScan::Ptr& scan) {
  if (!params.use_scans || !accept(*scan)) return;
  noteStamp(scan->timestamp);
  if (scan->timestamp == mrpt::Clock::time_point()) ++report.stampless_scans;
  assembler.addScan(scan, stream.entries() - 1);
}

bool RawlogReader::Impl::accept(const CObservation2DRangeScan& scan) {
  if (!labels.empty() && labels.count(scan.sensorLabel) == 0) {
    ++report.skipped_scans_label;
    ++report.skipped_labels[scan.sensorLabel];
    return false;
  }
  switch (judge(scan)) {
    case ScanVerdict::kEmpty:
      ++report.skipped_scans_empty;
      return false;
    case ScanVerdict::kTilted:
      ++report.skipped_scans_tilted;
      return false;
    case ScanVerdict::kBadGeometry:
      ++report.skipped_scans_bad;
      return false;
    case ScanVerdict::kUsable:
      break;
  }
  return true;
}

void RawlogReader::Impl::takeLandmarks(const CObservationBearingRange& observation) {
  if (!params.use_landmarks) return;
  if (!landmark_labels.empty() && landmark_labels.count(observation.sensorLabel) == 0) {
    ++report.skipped_landmarks_label;
    ++report.skipped_labels[observation.sensorLabel];
    return;
  }
  if (!isUsable(observation)) {
    ++report.skipped_landmarks_bad;
    return;
  }
  noteStamp(observation.timestamp);
  if (observation.timestamp == mrpt::Clock::time_point()) ++report.stampless_scans;
  assembler.addLandmarks(
      observation.timestamp,
      toLandmarkScan(observation, params.min_range, report.landmark_sensors[observation.sensorLabel]),
      stream.entries() - 1);
}

void RawlogReader::Impl::noteStamp(mrpt::Clock::time_point stamp) {
  if (!first_stamp && stamp != mrpt::Clock::time_point()) first_stamp = stamp;
}

void RawlogReader::Impl::end(const std::optional<LogDamage>& found) {
  ended = true;
  report.damage = found;
  report.findings = assess(report, params.vehicle);
  if (report.damage) throw InputError(report.damage->text);
  if (report.frames == 0) throw InputError(fmt::format("{}: {}", report.file, whyNoFrames(report, params)));
}

RawlogReader::RawlogReader(const std::string& file, const ReaderParams& params)
    : impl_(std::make_unique<Impl>(file, params)) {}
RawlogReader::~RawlogReader() = default;
RawlogReader::RawlogReader(RawlogReader&&) noexcept = default;
RawlogReader& RawlogReader::operator=(RawlogReader&&) noexcept = default;

std::optional<Frame> RawlogReader::next() { return impl_->next(); }

double RawlogReader::fractionRead() const { return impl_->ended ? 1.0 : impl_->stream.fractionRead(); }

const LogReport& RawlogReader::report() const { return impl_->report; }

LogReport checkLog(const std::string& file, const ReaderParams& params) {
  RawlogReader reader(file, params);
  try {
    while (reader.next()) {
    }
  } catch (const InputError& error) {
    LogReport report = reader.report();
    if (!report.damage) report.findings.insert(report.findings.begin(), {Severity::kError, error.what()});
    return report;
  }
  return reader.report();
}

}  // namespace submap_slam
