#include <fmt/format.h>
#include <mrpt/core/bits_math.h>
#include <mrpt/system/datetime.h>
#include <submap_slam/rawlog/log_report.h>

#include <algorithm>

#include "odometry_track.h"

namespace submap_slam {
namespace {

constexpr double kLargeGap_s = 5.0;
constexpr double kSparseShare = 0.1;  // share of long steps from which the log is sparse
constexpr double kBurstShare = 0.05;  // share of steps in bursts worth a word
constexpr double kNoReturnShare = 0.5;

class Findings {
 public:
  explicit Findings(std::vector<Finding>& list) : list_(list) {}

  template <typename... Args>
  void add(bool condition, Severity severity, fmt::format_string<Args...> text, const Args&... args) {
    if (condition) list_.push_back({severity, fmt::format(text, args...)});
  }

 private:
  std::vector<Finding>& list_;
};

double share(uint64_t part, uint64_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

std::string percent(uint64_t part, uint64_t whole) {
  return fmt::format("{:.1f} %", 100 * share(part, whole));
}

void assessContent(const LogReport& r, Findings& add) {
  if (r.damage)
    add.add(
        true, Severity::kError, "{}. {}", r.damage->text,
        r.frames == 0
            ? "Nothing of it can be used."
            : fmt::format("The {} frames before it are good and are used; what follows is lost.", r.frames));
  add.add(r.nested_logs > 0, Severity::kWarning,
          "{} rawlogs are stored inside this rawlog and were skipped; extract them to files of their own.",
          r.nested_logs);
  add.add(
      r.skipped_scans_tilted > 0, Severity::kWarning,
      "{} scans of scanners tilted by more than 5 deg were skipped: a 2D map needs a horizontal scan plane.",
      r.skipped_scans_tilted);
  add.add(r.skipped_scans_empty > 0, Severity::kWarning, "{} scans without beams were skipped.",
          r.skipped_scans_empty);
  add.add(r.skipped_scans_bad > 0, Severity::kWarning,
          "{} scans whose aperture, maximum range or sensor pose make no sense were skipped; check how the "
          "log was "
          "converted.",
          r.skipped_scans_bad);
  add.add(
      r.skipped_frames_stamp > 0, Severity::kWarning,
      "{} frames were skipped: they are stamped behind [reader] to, but frames before it follow, so their "
      "stamps are wrong.",
      r.skipped_frames_stamp);
  add.add(r.skipped_scans_label > 0, Severity::kInfo, "{} scans were skipped because of sensor_labels.",
          r.skipped_scans_label);
  add.add(r.skipped_landmarks_label > 0, Severity::kInfo,
          "{} landmark observations were skipped because of landmark_labels.", r.skipped_landmarks_label);
  add.add(r.skipped_landmarks_bad > 0, Severity::kWarning,
          "{} landmark observations whose sensor pose makes no sense were skipped; check how the log was "
          "converted.",
          r.skipped_landmarks_bad);
}

void assessStamps(const LogReport& r, Findings& add) {
  add.add(r.backward_stamps > 0, Severity::kWarning,
          "{} frames are stamped earlier than the frame before. The order of the file is kept; odometry with "
          "stamps of "
          "its own may be interpolated wrongly there.",
          r.backward_stamps);
  add.add(r.equal_stamps > 0, Severity::kInfo, "{} frames have the same stamp as the frame before.",
          r.equal_stamps);
  add.add(r.stampless_scans > 0, Severity::kWarning,
          "{} scans have no stamp; trajectories and evaluations by time are of no use.", r.stampless_scans);
  add.add(
      r.largest_gap_s > kLargeGap_s, Severity::kInfo,
      "The largest gap between frames is {:.1f} s; if the robot moved during it, only odometry bridges it.",
      r.largest_gap_s);
}

void assessOdometry(const LogReport& r, Findings& add) {
  const uint64_t without = r.frames - r.frames_with_odometry;
  const bool no_odometry = r.frames > 0 && r.frames_with_odometry == 0;
  add.add(no_odometry && !r.scanners.empty(), Severity::kWarning,
          "There is no odometry; grids are tracked by scan matching alone, which long corridors and fast "
          "turns can break.");
  add.add(no_odometry && (r.scanners.empty() || !r.landmark_sensors.empty()), Severity::kWarning,
          "There is no odometry; for landmarks the robot is taken to go on as before, with wide uncertainty, "
          "from one observation to the next, which turns and places with few landmarks can break.");
  add.add(r.frames_with_odometry > 0 && without > 0, Severity::kWarning,
          "{} of {} frames have no odometry reading within {} s.", without, r.frames,
          OdometryTrack::kHoldSeconds);
  add.add(
      share(r.sparse_steps, r.frames) > kSparseShare, Severity::kInfo,
      "The log is sparse: {} of {} steps between frames take more than 0.5 s and are longer than 1 m or 45 "
      "deg; matching needs a wide search.",
      r.sparse_steps, r.frames);
  add.add(
      r.odometry_jumps > 0, Severity::kWarning,
      "Odometry jumps at {} frames, by more than 1 m or 45 deg beyond the speed before (the largest step is "
      "{:.2f} m, {:.0f} deg): lost data or a reset of the odometry.",
      r.odometry_jumps, r.largest_step_m, mrpt::RAD2DEG(r.largest_step_rad));
  add.add(r.matched_increments > 0, Severity::kWarning,
          "{} movement increments were made by scan matching, not odometry; their errors repeat those of the "
          "scans.",
          r.matched_increments);
  add.add(r.ignored_odometry > 0, Severity::kInfo,
          "{} odometry readings were ignored: not finite, or of the second kind in a log with both "
          "increments and "
          "absolute readings.",
          r.ignored_odometry);
}

void assessScanner(const std::string& label, const ScannerReport& s, Findings& add) {
  add.add(s.geometry_changes > 0, Severity::kInfo,
          "Scanner '{}' changes its number of beams, aperture, maximum range or pose {} times.", label,
          s.geometry_changes);
  add.add(s.beams_broken > 0, Severity::kWarning,
          "Scanner '{}': {} beams ({}) are NaN, infinite or negative; they are treated as invalid.", label,
          s.beams_broken, percent(s.beams_broken, s.beams_total));
  add.add(share(s.beams_no_return, s.beams_total) > kNoReturnShare, Severity::kWarning,
          "Scanner '{}': {} of the beams have no return (at or above {:.1f} m); the place is too open for "
          "it, or the "
          "maximum range in the log is too small.",
          label, percent(s.beams_no_return, s.beams_total), s.max_range);
  add.add(
      share(s.burst_steps, s.scans) > kBurstShare, Severity::kInfo,
      "Scanner '{}': {} of the scans follow the one before within 10 ms. If it is not that fast, scans were "
      "stamped on arrival, in bursts: do not compute speeds from their stamps.",
      label, percent(s.burst_steps, s.scans));
}

void assessLandmarks(const std::string& label, const LandmarkSensorReport& s, Findings& add) {
  add.add(s.broken > 0, Severity::kWarning,
          "Landmarks '{}': {} measurements are NaN, infinite or not positive; they are left out.", label,
          s.broken);
  add.add(s.near > 0, Severity::kInfo,
          "Landmarks '{}': {} measurements are nearer than [reader] min_range; they are left out.", label,
          s.near);
  add.add(s.observations > 0 && s.measurements == 0, Severity::kWarning,
          "Landmarks '{}': no observation has any usable measurement.", label);
  add.add(s.with_id > 0 && s.with_id < s.measurements, Severity::kInfo,
          "Landmarks '{}': {} of the measurements have an id, the others have none.", label,
          percent(s.with_id, s.measurements));
}

std::string landmarkText(const std::string& label, const LandmarkSensorReport& s) {
  const auto orUnknown = [](double value, const char* unit) {
    return value > 0 ? fmt::format("{:.2f} {}", value, unit) : std::string("not given");
  };
  const auto& p = s.sensor_pose;
  const std::string ids =
      s.with_id == 0 ? "none with id" : fmt::format("{} with id of {} landmarks", s.with_id, s.ids.size());
  return fmt::format(
      "  landmarks '{}': {} observations ({} empty) with {} measurements, {}, at x {:.3f} y {:.3f} m, yaw "
      "{:.2f} deg\n    farthest {:.2f} m, max. range {}, sigma {} and {}\n",
      label, s.observations, s.empty, s.measurements, ids, p.x, p.y, mrpt::RAD2DEG(p.phi), s.largest_range,
      orUnknown(s.max_range, "m"), orUnknown(s.sigma_range, "m"),
      orUnknown(mrpt::RAD2DEG(s.sigma_bearing), "deg"));
}

std::string scannerText(const std::string& label, const ScannerReport& s) {
  const auto& p = s.sensor_pose;
  return fmt::format(
      "  scanner '{}': {} scans, {} beams over {:.2f} deg, max. range {:.2f} m, at x {:.3f} y {:.3f} z "
      "{:.3f} m, yaw "
      "{:.2f} deg\n    beams without return {}, below min_range or marked invalid {}, broken {}\n",
      label, s.scans, s.beams, mrpt::RAD2DEG(s.aperture), s.max_range, p.x, p.y, p.z, mrpt::RAD2DEG(p.yaw),
      percent(s.beams_no_return, s.beams_total), percent(s.beams_invalid, s.beams_total),
      percent(s.beams_broken, s.beams_total));
}

}  // namespace

const char* toString(Severity severity) {
  switch (severity) {
    case Severity::kInfo:
      return "info";
    case Severity::kWarning:
      return "warning";
    case Severity::kError:
      break;
  }
  return "error";
}

double LogReport::duration_s() const { return secondsBetween(first_stamp, last_stamp); }

bool LogReport::hasErrors() const {
  return std::any_of(findings.begin(), findings.end(),
                     [](const Finding& finding) { return finding.severity == Severity::kError; });
}

std::string LogReport::asText() const {
  std::string text =
      fmt::format("{}\n  {} of {} bytes read, {} entries\n", file, bytes_read, file_bytes, entries);
  for (const auto& [name, count] : classes) text += fmt::format("  {:8} {}\n", count, name);
  text += fmt::format("  {} frames", frames);
  if (frames > 0)
    text += fmt::format(" in {:.1f} s from {} UTC, largest gap {:.2f} s", duration_s(),
                        mrpt::system::dateTimeToString(first_stamp), largest_gap_s);
  text += "\n";
  for (const auto& [label, scanner] : scanners) text += scannerText(label, scanner);
  for (const auto& [label, sensor] : landmark_sensors) text += landmarkText(label, sensor);
  if (frames_with_odometry > 0)
    text += fmt::format("  odometry: {} readings, path {:.1f} m, largest step {:.3f} m, {:.1f} deg\n",
                        odometry_readings, path_length_m, largest_step_m, mrpt::RAD2DEG(largest_step_rad));
  for (const auto& finding : findings)
    text += fmt::format("  {}: {}\n", toString(finding.severity), finding.text);
  return text;
}

std::vector<Finding> assess(const LogReport& report, const VehicleParams& vehicle) {
  std::vector<Finding> findings;
  Findings add(findings);
  assessContent(report, add);
  assessStamps(report, add);
  assessOdometry(report, add);
  for (const auto& [label, scanner] : report.scanners) assessScanner(label, scanner, add);
  for (const auto& [label, sensor] : report.landmark_sensors) assessLandmarks(label, sensor, add);
  add.add(vehicle.usesVelocities() && report.odometry_readings == 0, Severity::kWarning,
          "[vehicle] model = {} needs velocities, but the log has no odometry.", vehicle.model);
  std::stable_sort(findings.begin(), findings.end(),
                   [](const Finding& a, const Finding& b) { return a.severity > b.severity; });
  return findings;
}

}  // namespace submap_slam
