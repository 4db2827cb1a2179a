#pragma once

#include <mrpt/core/Clock.h>
#include <mrpt/math/TPose2D.h>
#include <mrpt/math/TPose3D.h>
#include <submap_slam/core/vehicle_model.h>

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace submap_slam {

/** How much a finding matters: kInfo is good to know, kWarning may spoil a map, kError means data are lost or
 * unusable. */
enum class Severity { kInfo, kWarning, kError };
const char* toString(Severity severity);

/** Something the user should know about a log: what it is, what it means and what to do. */
struct Finding {
  Severity severity = Severity::kInfo;
  std::string text;
};

/** Where and why a log cannot be read any further. */
struct LogDamage {
  uint64_t entry = 0;      ///< rawlog entry that could not be read, from 0
  uint64_t data_byte = 0;  ///< where that entry starts in the (unpacked) data
  uint64_t file_byte = 0;  ///< how far the file was used; the same scale as its size on disk
  bool truncated = false;  ///< the file ends too early; false: its content is corrupt or unknown
  std::string text;        ///< one line with file, entry, offset and what was expected
};

/** The scans of one sensor label. */
struct ScannerReport {
  uint64_t scans = 0;

  // geometry of the first scan
  uint64_t beams = 0;
  double aperture = 0;              ///< angle from the first to the last beam (rad)
  double max_range = 0;             ///< m
  mrpt::math::TPose3D sensor_pose;  ///< T_robot_sensor (m, rad)
  uint64_t geometry_changes = 0;    ///< scans whose geometry differs from that of the scan before

  // beams of all scans; the three kinds below do not overlap
  uint64_t beams_total = 0;
  uint64_t beams_no_return = 0;  ///< range ≥ max_range
  uint64_t beams_broken = 0;     ///< NaN, infinite or negative range
  uint64_t beams_invalid = 0;    ///< nearer than `min_range`, or marked invalid in the log

  uint64_t burst_steps = 0;  ///< steps shorter than 10 ms to the scan before of this sensor
};

/** The landmark observations of one sensor label. */
struct LandmarkSensorReport {
  uint64_t observations = 0;
  uint64_t empty = 0;  ///< observations without a usable measurement
  uint64_t measurements = 0;
  uint64_t with_id = 0;             ///< measurements that tell which landmark it is
  std::set<uint32_t> ids;           ///< all of them
  double largest_range = 0;         ///< of a measurement (m)
  double max_range = 0;             ///< of the sensor, by its first observation (m); 0: not known
  double sigma_range = 0;           ///< by the first observation (m); 0: not known
  double sigma_bearing = 0;         ///< by the first observation (rad); 0: not known
  mrpt::math::TPose2D sensor_pose;  ///< T_robot_sensor, by the first observation (m, rad)

  // measurements that were left out, of everything that was read
  uint64_t broken = 0;  ///< NaN, infinite or not positive
  uint64_t near = 0;    ///< nearer than `min_range`
};

/** What a log holds and what is remarkable about it. Counts of frames, scans, beams, landmarks and odometry
 * steps are those of the frames that were delivered; counts of classes are those of everything that was read.
 */
struct LogReport {
  std::string file;
  uint64_t file_bytes = 0;                  ///< size on disk
  uint64_t bytes_read = 0;                  ///< of the file on disk
  uint64_t entries = 0;                     ///< objects in the rawlog (actions, sensory frames, observations)
  std::map<std::string, uint64_t> classes;  ///< objects by class, also those inside sensory frames

  uint64_t frames = 0;
  std::map<std::string, ScannerReport> scanners;                 ///< by sensor label
  std::map<std::string, LandmarkSensorReport> landmark_sensors;  ///< by sensor label
  mrpt::Clock::time_point first_stamp{}, last_stamp{};  ///< of the frames; equal if there is at most one
  double largest_gap_s = 0;                             ///< between consecutive frames
  uint64_t backward_stamps = 0;                         ///< frames stamped earlier than the one before
  uint64_t equal_stamps = 0;                            ///< frames stamped as the one before
  uint64_t stampless_scans = 0;                         ///< scans without any stamp

  uint64_t odometry_readings = 0;  ///< CObservationOdometry, or increments in actions
  uint64_t frames_with_odometry = 0;
  uint64_t sparse_steps = 0;    ///< steps of more than 1 m or 45° that take longer than 0.5 s
  uint64_t odometry_jumps = 0;  ///< steps of more than 1 m or 45° beyond twice what the recent speed explains
  double largest_step_m = 0, largest_step_rad = 0;
  double path_length_m = 0;         ///< by odometry
  uint64_t matched_increments = 0;  ///< increments in actions that scan matching made, not odometry
  uint64_t ignored_odometry = 0;    ///< readings of the second kind where a log has both kinds, or not finite

  uint64_t skipped_scans_label = 0;                ///< not in `sensor_labels`
  uint64_t skipped_landmarks_label = 0;            ///< landmark observations, not in `landmark_labels`
  uint64_t skipped_landmarks_bad = 0;              ///< landmark observations whose sensor pose makes no sense
  uint64_t skipped_scans_tilted = 0;               ///< scan plane more than 5° off the horizontal
  uint64_t skipped_scans_empty = 0;                ///< no beams
  uint64_t skipped_scans_bad = 0;                  ///< aperture, maximum range or sensor pose make no sense
  uint64_t skipped_frames_stamp = 0;               ///< stamped behind `to`, but followed by frames before it
  std::map<std::string, uint64_t> skipped_labels;  ///< sensor labels that were left out, with counts
  uint64_t nested_logs = 0;                        ///< CRawlog objects inside the rawlog

  std::optional<LogDamage> damage;
  std::vector<Finding> findings;  ///< filled when reading has ended

  double duration_s() const;
  bool hasErrors() const;

  /** The report for people, several lines ending with a newline. */
  std::string asText() const;
};

/** The findings that follow from the counts, and from what the vehicle needs of the log, most severe first.
 */
std::vector<Finding> assess(const LogReport& report, const VehicleParams& vehicle = {});

}  // namespace submap_slam
