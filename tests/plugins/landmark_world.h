#pragma once

#include <submap_slam/core/landmark_submap.h>

#include <cstdint>

namespace submap_slam::testing {

/** Landmark submaps of a simulated drive with noise of the stated covariance. */
struct LandmarkWorldOptions {
  int submaps = 12;
  int features = 6;          ///< of each submap, about
  double radius_m = 20;      ///< of the circle that is driven, once
  double sigma_m = 0.02;     ///< of features and of the end position
  double sigma_rad = 0.005;  ///< of the end heading
  uint32_t seed = 1;
};

/** A drive around a circle that ends where it began, past landmarks on both sides. Ids are the truth. */
LandmarkSubmaps simulateLandmarks(const LandmarkWorldOptions& options);

}  // namespace submap_slam::testing
