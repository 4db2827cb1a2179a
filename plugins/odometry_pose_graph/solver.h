#pragma once

#include <ceres/problem.h>

namespace submap_slam::pose_graph {

enum class Solution { kConverged, kIterationLimit, kUnusable };

/** Levenberg-Marquardt with sparse Cholesky; damping by the gain ratio (Huang et al. 2024, eq. 8 to 10),
 * which is what Ceres does. Without BLAS, whose threads would decide the last bits. */
Solution solve(ceres::Problem& problem);

}  // namespace submap_slam::pose_graph
