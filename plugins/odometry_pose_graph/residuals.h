#pragma once

#include <ceres/autodiff_cost_function.h>
#include <ceres/jet.h>
#include <mrpt/math/TPose2D.h>
#include <Eigen/Core>

#include <cmath>

namespace submap_slam::pose_graph {

/** A pose as Ceres changes it: x, y (m), θ (rad). */
struct PoseBlock {
  double values[3] = {0, 0, 0};

  PoseBlock() = default;
  explicit PoseBlock(const mrpt::math::TPose2D& pose) : values{pose.x, pose.y, pose.phi} {}
  mrpt::math::TPose2D pose() const { return {values[0], values[1], values[2]}; }
};

/** Lᵀ e of a measured relation of two poses (see RelationError), Ω = L Lᵀ its information. Serves constraints
 * and odometry alike. */
class RelationResidual {
 public:
  RelationResidual(const mrpt::math::TPose2D& T_a_b, const Eigen::Matrix3d& square_root_information)
      : T_a_b_(T_a_b), weight_(square_root_information) {}

  /** @param a, b  poses in the global map frame */
  template <class T>
  bool operator()(const T* a, const T* b, T* residual) const {
    using std::cos;
    using std::floor;
    using std::sin;
    const T c = cos(a[2]), s = sin(a[2]), dx = b[0] - a[0], dy = b[1] - a[1];
    const T turn = b[2] - a[2] - T_a_b_.phi;
    const Eigen::Matrix<T, 3, 1> e(c * dx + s * dy - T_a_b_.x, -s * dx + c * dy - T_a_b_.y,
                                   turn - 2 * M_PI * floor((turn + M_PI) / (2 * M_PI)));
    Eigen::Map<Eigen::Matrix<T, 3, 1>>{residual} = weight_.cast<T>() * e;
    return true;
  }

  static ceres::CostFunction* cost(const mrpt::math::TPose2D& T_a_b,
                                   const Eigen::Matrix3d& square_root_information) {
    return new ceres::AutoDiffCostFunction<RelationResidual, 3, 3, 3>(
        new RelationResidual(T_a_b, square_root_information));
  }

 private:
  mrpt::math::TPose2D T_a_b_;
  Eigen::Matrix3d weight_;
};

}  // namespace submap_slam::pose_graph
