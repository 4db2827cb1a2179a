#pragma once

#include <ceres/problem.h>

namespace submap_slam::pose_graph {

/** Levenberg-Marquardt with sparse Cholesky; damping by the gain ratio (Huang et al. 2024, eq. 8 to 10),
 * which is what Ceres does. The result is the same for any number of threads. False if it is not usable. */
bool solve(ceres::Problem& problem);

}  // namespace submap_slam::pose_graph
