#pragma once

#include <submap_slam/core/frame.h>
#include <submap_slam/core/parameters.h>
#include <submap_slam/core/vehicle_model.h>
#include <submap_slam/rawlog/log_report.h>

#include <memory>
#include <optional>
#include <string>

namespace submap_slam {

/** Parameters of RawlogReader, ini sections `[reader]` and `[vehicle]`. */
struct ReaderParams {
  /** Sensor labels of the scanners to use, separated by commas; empty: all 2D scanners. */
  std::string sensor_labels;

  /** Sensor labels of the landmark observations to use, separated by commas; empty: all. */
  std::string landmark_labels;

  /** Ranges below this are invalid (m): the robot's own body, or a zero that marks an error. */
  double min_range = 0.05;

  /** First and last rawlog entry to use ("1200"), or seconds from the first stamp ("60s"); empty: the whole
   * log. */
  std::string from, to;

  VehicleParams vehicle;

  /** What makes frames; no ini keys, but decided by what becomes of the log. */
  bool use_scans = true, use_landmarks = true;
};

/** Adds sections `[reader]` and `[vehicle]`. */
void describe(ParameterTable& table, ReaderParams& params);

/** Reads a rawlog frame by frame, in memory that does not grow with its length.
 *
 * Reads plain and gzip files and both forms, time-stamped observations and pairs of actions and sensory
 * frames.
 *
 * **Frames.** Scans keep the order of the file, whatever their stamps say. Scans of different sensors with
 * the same stamp become one frame; so do all scans of one sensory frame that have the same stamp. Landmark
 * observations do the same, also together with scans.
 * Frame::index counts the frames of the whole log, also with `from`. `from` … `to` choose one part of the
 * file: it starts with the first frame at or after `from` and ends before the first frame after `to`. Where
 * `to` is a time, it takes ten frames in a row behind it to end; fewer have wrong stamps and are left out, as
 * if the log did not have them.
 *
 * **Odometry.** In an observation log it is interpolated linearly (heading along the shorter way) between the
 * readings before and after the stamp; a reading with the very stamp is used as it is. Outside of all
 * readings (start and end of the log, or where odometry stamps jump back) the nearest reading is used if it
 * is at most 1 s away, else the frame has no odometry. In a log of actions the increments are chained from
 * the identity and all scans of a sensory frame get the pose reached there; increments that scan matching
 * made are used if the log has no others and are reported. If a log holds both kinds, the kind that comes
 * first is used for all of it. No odometry at all leaves Frame::odometry empty.
 *
 * If `[vehicle]` asks for velocities, they are integrated, from the identity at the first reading, each being
 * held until the next one but for at most 1 s; the logged poses are not used then. Frame::motion_covariance
 * follows from the noise of the controls between this frame and the one delivered before; it stays empty for
 * the first frame, where stamps don't increase and where velocities are missing.
 *
 * **Scans.** NaN, infinite and negative ranges become 0 and invalid; ranges below `min_range` and at or above
 * the scanner's maximum (no return) keep their value and become invalid. Scans without beams, with a
 * senseless geometry or from a scanner tilted by more than 5° are left out; one mounted upside down (roll =
 * π) is not tilted. All of it is counted in the report.
 *
 * **Landmarks** (CObservationBearingRange). Measurements are projected to the plane of the robot by the full
 * sensor pose and the pitch. Left out and counted are those with a range or an angle that is NaN or infinite,
 * those with a range that is not positive or below `min_range`. Negative ids mean "not known". Observations
 * without any usable measurement stay: that nothing was seen is knowledge too. Where measurements bring
 * covariances of their own, the sensor gets the root mean square of their standard deviations. Observations
 * that have an id twice cannot be read by MRPT, so that the log counts as damaged there.
 */
class RawlogReader {
 public:
  /** Throws InputError if the file does not exist or is no file, ConfigError for bad `from`, `to`,
   * `min_range` or vehicle. */
  explicit RawlogReader(const std::string& file, const ReaderParams& params = {});
  ~RawlogReader();
  RawlogReader(RawlogReader&&) noexcept;
  RawlogReader& operator=(RawlogReader&&) noexcept;

  /** The next frame, or nothing at the end. Throws ConfigError if the vehicle needs velocities that the log
   * does not have, and InputError once, after the last valid frame, if the file
   * is damaged (with what and where), is no rawlog, or gave no frame at all; further calls return nothing. */
  std::optional<Frame> next();

  /** Share of the file that was read, in [0, 1]. */
  double fractionRead() const;

  /** Counts so far; complete, with findings, once next() has returned nothing or thrown. */
  const LogReport& report() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/** Reads the whole log and reports on it. Throws InputError only if the file cannot be opened, and
 * ConfigError; damaged and senseless content becomes a finding. */
LogReport checkLog(const std::string& file, const ReaderParams& params = {});

}  // namespace submap_slam
