#pragma once

#include <functional>
#include <optional>

#include "covariances.h"

namespace submap_slam::landmark_joining {

/** Most elements of a state that joinDense() should be given; its covariance then has half a gigabyte. */
constexpr std::size_t kLargestDenseState = 8000;

/** Elements of the state of a problem. */
std::size_t stateSize(const JointProblem& problem);

/** Joins one after the other by an extended Kalman filter with the whole covariance matrix (map joining as of
 * Tardós, Neira, Newman, Leonard, "Robust mapping and localization in indoor environments using sonar data",
 * 2002): the submap is moved to the map by its start pose, then each landmark that was known is fused with
 * its second estimate by the exact constraint that their difference is zero. Cubic in the size of the state:
 * it is here for comparison.
 * @param progress called with the share of the work done; false ends it
 * @return estimate of the submaps fused until then, where landmarks that none of them holds are zero; empty
 * if an innovation's covariance was not positive definite */
std::optional<Estimate> joinDense(const JointProblem& problem, const std::function<bool(double)>& progress);

}  // namespace submap_slam::landmark_joining
