#pragma once

#include <ceres/problem.h>

#include <functional>

namespace submap_slam::pose_graph {

enum class Solution { kConverged, kIterationLimit, kUnusable };

/** Levenberg-Marquardt with sparse Cholesky; damping by the gain ratio (Huang et al. 2024, eq. 8 to 10),
 * which is what Ceres does. Without BLAS, whose threads would decide the last bits.
 * @param show called after each iteration, with its values in the blocks of the problem */
Solution solve(ceres::Problem& problem, const std::function<void()>& show = {});

}  // namespace submap_slam::pose_graph
