#include <submap_slam/mapping/grid_scan_matcher.h>

#include <ceres/autodiff_cost_function.h>
#include <ceres/cubic_interpolation.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <mrpt/math/wrap2pi.h>

#include <array>
#include <cmath>
#include <vector>

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;
using Pose = std::array<double, 3>;  // x, y, φ

/** The grid as Ceres' interpolator wants to read it. */
struct GridView {
  enum { DATA_DIMENSION = 1 };
  void GetValue(int row, int column, double* probability) const {
    *probability = grid.probability(column, row);
  }
  const ProbabilityGrid& grid;
};

/** (1 − M(T h_b)) / √n for all beams. */
class ScanResiduals {
 public:
  ScanResiduals(const ProbabilityGrid& grid, const LaserPoints& scan)
      : grid_(grid),
        view_{grid},
        interpolator_(view_),
        points_(scan.points),
        scale_(1 / std::sqrt(static_cast<double>(scan.points.size()))) {}

  template <class T>
  bool operator()(const T* pose, T* residuals) const {
    using std::cos;
    using std::sin;
    const T c = cos(pose[2]), s = sin(pose[2]);
    for (const LaserPoint& p : points_) {
      const double px = static_cast<double>(p.x), py = static_cast<double>(p.y);
      const T x = pose[0] + c * px - s * py, y = pose[1] + s * px + c * py;
      T probability;
      interpolator_.Evaluate(grid_.rowOf(y), grid_.columnOf(x), &probability);
      *residuals++ = scale_ * (1.0 - probability);
    }
    return true;
  }

 private:
  const ProbabilityGrid& grid_;
  GridView view_;
  ceres::BiCubicInterpolator<GridView> interpolator_;
  const std::vector<LaserPoint>& points_;
  double scale_;
};

/** Weighted distance from the prediction. */
struct PriorResiduals {
  template <class T>
  bool operator()(const T* pose, T* residuals) const {
    residuals[0] = translation_weight * (pose[0] - prediction.x);
    residuals[1] = translation_weight * (pose[1] - prediction.y);
    residuals[2] = rotation_weight * (pose[2] - prediction.phi);
    return true;
  }
  TPose2D prediction;
  double translation_weight, rotation_weight;
};

using ScanCost = ceres::AutoDiffCostFunction<ScanResiduals, ceres::DYNAMIC, 3>;
using PriorCost = ceres::AutoDiffCostFunction<PriorResiduals, 3, 3>;

/** One least-squares problem for a scan, solved from any number of starts. */
class MatchProblem {
 public:
  MatchProblem(const ProbabilityGrid& grid, const LaserPoints& scan, const TPose2D& prediction,
               const ScanMatchingParams& params)
      : prediction_(prediction) {
    const auto beams = static_cast<int>(scan.points.size());
    problem_.AddResidualBlock(new ScanCost(new ScanResiduals(grid, scan), beams), nullptr, pose_.data());
    problem_.AddResidualBlock(
        new PriorCost(new PriorResiduals{prediction, params.translation_weight, params.rotation_weight}),
        nullptr, pose_.data());
    options_.linear_solver_type = ceres::DENSE_QR;
    options_.max_num_iterations = params.max_iterations;
    options_.num_threads = 1;  // sums in a fixed order
    options_.logging_type = ceres::SILENT;
  }

  /** Pose, cost and iterations of the minimum that is reached from `start`. */
  MatchResult solveFrom(const TPose2D& start) {
    const double phi = prediction_.phi + mrpt::math::wrapToPi(start.phi - prediction_.phi);
    pose_ = {start.x, start.y, phi};
    ceres::Solver::Summary summary;
    ceres::Solve(options_, &problem_, &summary);
    MatchResult result;
    result.pose = summary.IsSolutionUsable() ? TPose2D(pose_[0], pose_[1], mrpt::math::wrapToPi(pose_[2]))
                                             : prediction_;
    result.cost = summary.final_cost;
    result.iterations = static_cast<int>(summary.iterations.size()) - 1;
    return result;
  }

 private:
  TPose2D prediction_;
  Pose pose_{};
  ceres::Problem problem_;
  ceres::Solver::Options options_;
};

}  // namespace

MatchResult GridScanMatcher::match(const ProbabilityGrid& grid, const LaserPoints& scan,
                                   const TPose2D& prediction, bool search) const {
  MatchProblem problem(grid, scan, prediction, params_);
  MatchResult result = problem.solveFrom(prediction);
  if (search) {
    const auto peak = correlativeSearch(grid, scan, prediction, params_.window);
    const MatchResult other = problem.solveFrom(peak.pose);
    if (other.cost < result.cost) result = other;
  }
  const Evaluation at = evaluate(grid, scan, result.pose);
  const auto beams = static_cast<double>(scan.points.size());
  constexpr double kLeastSquare = 1e-3;  // of 1 − M: no beam is explained better than that
  result.information = at.hessian * (params_.information_share * beams / std::max(2 * at.cost, kLeastSquare));
  result.inlier_share = static_cast<double>(at.inliers) / beams;
  return result;
}

GridScanMatcher::Evaluation GridScanMatcher::evaluate(const ProbabilityGrid& grid, const LaserPoints& scan,
                                                      const TPose2D& pose) {
  const auto beams = static_cast<Eigen::Index>(scan.points.size());
  const ScanCost cost(new ScanResiduals(grid, scan), static_cast<int>(beams));
  const Pose at{pose.x, pose.y, pose.phi};
  const double* parameters = at.data();
  Eigen::VectorXd residuals(beams);
  Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> jacobian(beams, 3);
  double* jacobians = jacobian.data();
  cost.Evaluate(&parameters, residuals.data(), &jacobians);

  Evaluation out;
  out.cost = 0.5 * residuals.squaredNorm();
  out.gradient = jacobian.transpose() * residuals;
  out.hessian = jacobian.transpose() * jacobian;
  const double half = 0.5 / std::sqrt(static_cast<double>(beams));
  out.inliers = static_cast<std::size_t>((residuals.array() < half).count());
  return out;
}

}  // namespace submap_slam
