/** Whether the covariances of landmark submaps are honest. */
#pragma once

#include <submap_slam/core/landmark_submap.h>
#include <submap_slam/eval/landmark_errors.h>
#include <submap_slam/eval/timed_trajectory.h>

#include <optional>

namespace submap_slam {

/** eᵀ Q⁻¹ e / n with e = estimate − truth of a submap's state, the pose where it ends and its features, all
 * in the frame of the pose where it starts, and n the number of elements; 1 is expected. Features that the
 * truth does not have, and those of submaps whose ids are not known, are left out.
 * @param landmarks true places by the ids of the features, in the frame of `path`
 * @return nothing if the time of either end is not known, the truth lacks it or the covariance is not
 * positive definite */
std::optional<double> neesPerDimension(const LandmarkSubmap& submap, const LandmarkTruth& landmarks,
                                       const TimedTrajectory& path);

struct SubmapNees {
  std::size_t used = 0;  ///< submaps that have one
  double mean = 0;       ///< over them; above 1: overconfident, below: underconfident
};

/** Mean of neesPerDimension() over submaps. */
SubmapNees meanNeesPerDimension(const LandmarkSubmaps& submaps, const LandmarkTruth& landmarks,
                                const TimedTrajectory& path);

}  // namespace submap_slam
