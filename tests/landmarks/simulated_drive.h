#pragma once

#include <submap_slam/core/local_mapper.h>

#include <cstdint>
#include <vector>

namespace submap_slam::testing {

/** A short drive past landmarks, with truth. */
struct Drive {
  Stretch stretch;
  std::vector<mrpt::math::TPose2D> path;        ///< true T_start_robot of each frame
  std::vector<mrpt::math::TPoint2D> landmarks;  ///< true, in the frame of the start; id = position + 1
};

struct DriveOptions {
  int frames = 40;
  double step_m = 0.5, turn_rad = 0.02;
  double sigma_xy = 0.02, sigma_phi = 0.005;  ///< of a step of odometry
  double sigma_range = 0.05, sigma_bearing = 0.005;
  bool ids = true;
  uint32_t seed = 1;
};
Drive simulateDrive(const DriveOptions& options);

}  // namespace submap_slam::testing
