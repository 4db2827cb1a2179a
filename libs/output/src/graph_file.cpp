#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/output/graph_file.h>

#include <Eigen/Eigenvalues>

#include <cmath>

#include "binary_file.h"

namespace submap_slam {
namespace {

/** Inverse of the covariance with its eigenvalues bounded from below. */
Eigen::Matrix3d information(const Eigen::Matrix3d& covariance) {
  constexpr double kMinVariance = 1e-12;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance);
  const Eigen::Vector3d inverse = eigen.eigenvalues().cwiseMax(kMinVariance).cwiseInverse();
  return eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
}

/** 17 digits: the number reads back to the same bits. */
std::string poseText(const mrpt::poses::CPose2D& pose) {
  return fmt::format("{:.17g} {:.17g} {:.17g}", pose.x(), pose.y(), pose.phi());
}

std::string edgeText(const Constraint& constraint, const std::string& file) {
  const Eigen::Matrix3d covariance = constraint.T_a_b.cov.asEigen();
  if (!covariance.allFinite())
    throw OutputError(
        fmt::format("{}: cannot be written: the covariance of constraint {} to {} is not finite", file,
                    constraint.from, constraint.to));
  const Eigen::Matrix3d I = information(covariance);
  return fmt::format("EDGE_SE2 {} {} {} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}\n", constraint.from,
                     constraint.to, poseText(constraint.T_a_b.mean), I(0, 0), I(0, 1), I(0, 2), I(1, 1),
                     I(1, 2), I(2, 2));
}

}  // namespace

void writeG2o(const std::string& file, const std::vector<mrpt::poses::CPosePDFGaussian>& frames,
              const std::vector<Constraint>& constraints) {
  std::string text;
  for (std::size_t i = 0; i < frames.size(); ++i)
    text += fmt::format("VERTEX_SE2 {} {}\n", i, poseText(frames[i].mean));
  if (!frames.empty()) text += "FIX 0\n";
  for (const auto& constraint : constraints)
    if (constraint.accepted) text += edgeText(constraint, file);
  writeBytes(file, text);
}

void writeConstraints(const std::string& file, const std::vector<Constraint>& constraints) {
  std::string text = "from,to,kind,accepted,x_m,y_m,phi_rad,sigma_x_m,sigma_y_m,sigma_phi_rad,reason\n";
  for (const auto& c : constraints) {
    const auto& cov = c.T_a_b.cov;
    text += fmt::format("{},{},{},{},{:.4f},{:.4f},{:.5f},{:.4f},{:.4f},{:.5f},\"{}\"\n", c.from, c.to,
                        c.inter ? "inter" : "intra", c.accepted ? 1 : 0, c.T_a_b.mean.x(), c.T_a_b.mean.y(),
                        c.T_a_b.mean.phi(), std::sqrt(cov(0, 0)), std::sqrt(cov(1, 1)), std::sqrt(cov(2, 2)),
                        c.reason);
  }
  writeBytes(file, text);
}

}  // namespace submap_slam
