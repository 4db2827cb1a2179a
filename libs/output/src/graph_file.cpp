#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/output/graph_file.h>

#include <Eigen/Eigenvalues>

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

}  // namespace submap_slam
