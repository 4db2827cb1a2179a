#include "solver.h"

#include <ceres/solver.h>

namespace submap_slam::pose_graph {
namespace {

class Show : public ceres::IterationCallback {
 public:
  explicit Show(const std::function<void()>& show) : show_(show) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
    show_();
    return ceres::SOLVER_CONTINUE;
  }

 private:
  const std::function<void()>& show_;
};

}  // namespace

Solution solve(ceres::Problem& problem, const std::function<void()>& show) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  options.max_num_iterations = 50;
  options.function_tolerance = 1e-7;
  options.num_threads = 1;  // sums in a fixed order
  options.logging_type = ceres::SILENT;
  Show callback(show);
  if (show) {
    options.callbacks.push_back(&callback);
    options.update_state_every_iteration = true;
  }
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) return Solution::kUnusable;
  return summary.termination_type == ceres::CONVERGENCE ? Solution::kConverged : Solution::kIterationLimit;
}

}  // namespace submap_slam::pose_graph
