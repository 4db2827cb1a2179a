#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TTwist2D.h>
#include <submap_slam/core/frame.h>
#include <submap_slam/core/joined_map.h>
#include <submap_slam/simulation/path.h>
#include <submap_slam/simulation/sensors.h>
#include <submap_slam/simulation/world.h>

#include <cstdint>
#include <string>
#include <vector>

namespace submap_slam {

/** Where a landmark really is. */
struct TrueLandmark {
  uint32_t id;
  mrpt::math::TPoint2D position;  ///< m, world frame
};

/** Odometry that tells how the robot is driven. */
struct VelocityReading {
  mrpt::Clock::time_point stamp;
  mrpt::math::TPose2D pose;       ///< T_odom_robot (m, rad)
  mrpt::math::TTwist2D velocity;  ///< from now to the next reading, in the robot frame (m/s, rad/s)
};

/** What the sensors measured, and the truth. */
struct SimulatedLog {
  std::vector<Frame> frames;                ///< one scan each, odometry starting at the identity
  Trajectory truth;                         ///< T_world_robot at each frame
  std::vector<VelocityReading> velocities;  ///< if odometry is read more often than at each frame
  std::vector<TrueLandmark> landmarks;      ///< if the world has any
};

/** Drives a robot with a laser scanner and odometry along a path.
 *
 * Frame k has the stamp 2020-01-01 00:00 UTC + k · period. Laser and odometry have random streams of their
 * own: changing one model does not change the noise of the other sensor. The same arguments give the same
 * log, bit for bit. Odometry is rounded to 1 µm and 1 µrad, so that the last bits of a platform's sine do not
 * show in files. Throws ConfigError if a model holds an impossible value or the path is empty. */
SimulatedLog simulate(const World& world, const Path& path, const LaserModel& laser,
                      const OdometryModel& odometry, uint64_t seed);

/** The two forms of MRPT rawlogs. */
enum class RawlogForm {
  kObservations,  ///< time-stamped CObservationOdometry and CObservation2DRangeScan or
                  ///< CObservationBearingRange
  kActions  ///< pairs of CActionCollection (odometry increment since the last pair) and CSensoryFrame (scan)
};

/** Writes a gzip-compressed rawlog; the same log gives the same bytes. Throws OutputError naming the file. */
void writeRawlog(const std::string& file, const SimulatedLog& log, RawlogForm form);

/** Writes the truth in the TUM format: `stamp(s) x y z qx qy qz qw`, one pose a line. Throws OutputError
 * naming the file. */
void writeTruth(const std::string& file, const Trajectory& truth);

/** Writes true landmarks: `id,x,y` (m), one a line below this head. Throws OutputError naming the file. */
void writeTrueLandmarks(const std::string& file, const std::vector<TrueLandmark>& landmarks);

/** Writes the example logs of this project into an existing folder: room.rawlog, loop.rawlog,
 * non_convex.rawlog, long_corridors.rawlog and landmarks.rawlog (observations), corridor_sf.rawlog (actions),
 * each with its .truth.tum, landmarks also with .landmarks.csv. Throws OutputError naming the file. */
void writeExampleLogs(const std::string& folder);

}  // namespace submap_slam
