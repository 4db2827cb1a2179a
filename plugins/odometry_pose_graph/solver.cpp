#include "solver.h"

#include <ceres/solver.h>

namespace submap_slam::pose_graph {

Solution solve(ceres::Problem& problem) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  options.max_num_iterations = 50;
  options.function_tolerance = 1e-7;
  options.num_threads = 1;  // sums in a fixed order
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) return Solution::kUnusable;
  return summary.termination_type == ceres::CONVERGENCE ? Solution::kConverged : Solution::kIterationLimit;
}

}  // namespace submap_slam::pose_graph
