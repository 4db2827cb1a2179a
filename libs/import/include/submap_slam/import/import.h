/** Logs of other programs, text (also gzip) and ROS bags, made into rawlogs. docs/import.md describes the
 * forms. */
#pragma once

#include <mrpt/math/TPose2D.h>
#include <submap_slam/core/progress.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace submap_slam {

enum class ImportForm {
  kCarmen,     ///< CARMEN log: FLASER, RLASER, ROBOTLASERn, RAWLASERn, ODOM, PARAM
  kScans,      ///< header, then lines `stamp x y theta r1 r2 …`
  kLandmarks,  ///< lines `stamp range bearing [id]`, with odometry or controls from a second file
  kGraph,      ///< pose graph of g2o or TORO; becomes a g2o file
  kBag         ///< ROS 1 bag: LaserScan and Odometry
};

/** Names of the forms as users write them: bag, carmen, graph, landmarks, scans. */
const std::map<std::string, ImportForm>& importForms();

/** Angles of the beams of a scanner. */
struct BeamAngles {
  double first = 0, step = 0;  ///< rad, left positive
};

/** Which stamp of a CARMEN line counts. */
enum class CarmenStamps {
  kAuto,   ///< kIpc, unless more than half of those run backwards and fewer of the others do
  kIpc,    ///< when the message was made
  kLogger  ///< when it was written
};

/** What the user knows and the file does not say. */
struct ImportOptions {
  std::optional<ImportForm> form;  ///< empty: recognised by the content

  std::optional<mrpt::math::TPose2D> T_robot_sensor;  ///< m, rad; overrides what the file says
  std::optional<double> max_range;                    ///< m; ranges at or above are no return
  std::optional<BeamAngles> beam_angles;              ///< of CARMEN scans that do not say them
  CarmenStamps stamps = CarmenStamps::kAuto;

  std::vector<std::string>
      topics;  ///< of a bag; empty: all scans, and odometry of the first topic that has any

  std::string odometry_file;  ///< of landmarks: lines `stamp x y theta`, or TUM
  std::string controls_file;  ///< of landmarks: lines `stamp speed turn`
  double wheel_base = 0;      ///< m; above 0, `turn` is the steering angle, otherwise the yaw rate
  double encoder_offset = 0;  ///< m, of the wheel with the encoder to the left of the rear axle's centre
};

/** What an import found and did. */
struct ImportReport {
  ImportForm form = ImportForm::kCarmen;
  uint64_t lines = 0;
  std::map<std::string, uint64_t> written;  ///< objects by what they are, for example "scans of LASER"
  std::vector<std::string> notes;           ///< what was decided: stamps, sensor poses, ranges
  std::vector<std::string> warnings;        ///< what the user should look at
  uint64_t damaged_lines = 0;               ///< left out
  std::vector<std::string> damage;          ///< the first of them: file, line, what was expected

  bool damaged() const { return !damage.empty(); }
  std::string asText() const;
};

/** The form of a file by its content. Throws InputError if it cannot be read or is none of them, saying what
 * it is where that can be told (rawlog, 3D graph). */
ImportForm recogniseForm(const std::string& file);

/** Reads a file and writes a rawlog of time-stamped observations (kGraph: a g2o file) to `output`, replacing
 * it. Memory does not grow with the log but for 16 bytes a scan.
 *
 * Lines that are damaged are left out and reported, as are the bytes behind damaged gzip data. Throws
 * InputError if nothing of the file can be used, ConfigError for options that do not fit the form,
 * OutputError, Interrupted if `progress` says so. */
ImportReport importFile(const std::string& file, const std::string& output, const ImportOptions& options,
                        const ProgressCallback& progress);

}  // namespace submap_slam
