#pragma once

#include <mrpt/math/TPose2D.h>
#include <submap_slam/import/import.h>

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace submap_slam {

/** The stamps of a CARMEN line, s. */
struct CarmenStampPair {
  double ipc = 0;     ///< when the message was made
  double logger = 0;  ///< when it was written, from the start of the logger; ipc if the line has none
};

/** A scan of any of CARMEN's forms. */
struct CarmenScan {
  /** From the one that says most to the one that says least. */
  enum class Kind {
    kRobotLaser,  ///< ROBOTLASERn: configuration, poses of laser and robot
    kOld,         ///< FLASER and RLASER: poses only
    kRaw          ///< RAWLASERn: configuration only
  };
  Kind kind = Kind::kOld;
  uint32_t laser = 1;  ///< number of the scanner: FLASER 1, RLASER 2
  std::vector<double> ranges_m;
  std::optional<BeamAngles> angles;                            ///< empty for kOld
  double max_range = 0;                                        ///< m; 0: the line does not say
  std::optional<mrpt::math::TPose2D> T_w_laser, T_odom_robot;  ///< empty for kRaw
  CarmenStampPair stamps;
};

/** ODOM. */
struct CarmenOdometry {
  mrpt::math::TPose2D T_odom_robot;
  CarmenStampPair stamps;
};

/** PARAM; the value is text. */
struct CarmenParam {
  std::string name, value;
};

/** Other lines. */
struct CarmenOther {};

using CarmenMessage = std::variant<CarmenOther, CarmenScan, CarmenOdometry, CarmenParam>;

/** Reads one line. Throws LineError if a line of a known kind is damaged. */
CarmenMessage parseCarmenLine(std::string_view line);

/** True for the first word of lines that CARMEN logs have. */
bool isCarmenKeyword(std::string_view word);

}  // namespace submap_slam
