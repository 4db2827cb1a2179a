#pragma once

#include <mrpt/math/TPose2D.h>

#include <Eigen/Dense>
#include <Eigen/SparseCore>
#include <cstddef>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace submap_slam::grid_joining {

/** T_w_s of every submap (m, rad), in the order of the submaps. */
using Frames = std::vector<mrpt::math::TPose2D>;

/** Indices of two submaps, the smaller one first. */
using PosePair = std::pair<std::size_t, std::size_t>;

/** Normal equations of the submap frames, (x, y, θ) each in the global map frame: A Δ = −g with A = Σ JᵀJ and
 * g = Σ Jᵀr. A is symmetric; only the blocks (i, k) with i ≤ k that were added are stored. */
struct PoseSystem {
  explicit PoseSystem(std::size_t frames) : gradient(frames, Eigen::Vector3d::Zero()) {}

  std::vector<Eigen::Vector3d> gradient;
  std::map<PosePair, Eigen::Matrix3d> blocks;

  std::size_t frames() const { return gradient.size(); }

  /** Adds JᵀJ of the pair; for i > k its transpose to (k, i), for i = k its symmetric part. */
  void addBlock(std::size_t i, std::size_t k, const Eigen::Matrix3d& block);

  /** Adds scale · other. */
  void add(const PoseSystem& other, double scale);

  /** The whole of A and g (3 rows a frame). */
  Eigen::MatrixXd denseMatrix() const;
  Eigen::SparseMatrix<double> sparseMatrix() const;
  Eigen::VectorXd denseGradient() const;
};

/** For each frame the first submap of its group; groups are what off-diagonal blocks connect. */
std::vector<std::size_t> groupsOf(const PoseSystem& system);

/** Which frames are held: the first one of every group. With one group it is the gauge of the paper (X_0
 * fixed); groups without any link between them are joined each for itself. */
std::vector<bool> anchorsOf(const PoseSystem& system);

/** What Levenberg and Marquardt add to the diagonal of A: damping · diag(A), and a trace of it where A has
 * none. */
Eigen::VectorXd dampingDiagonal(const PoseSystem& system, double damping);

/** Solves (A + diag(added)) Δ = −g for the frames that are not held by sparse Cholesky; held frames get 0.
 * Empty if the matrix is not positive definite. */
std::optional<Eigen::VectorXd> solve(const PoseSystem& system, const std::vector<bool>& held,
                                     const Eigen::VectorXd& added);

/** Diagonal blocks of (A + diag(added))⁻¹, zero for held frames; empty if the matrix is not positive
 * definite. */
std::optional<std::vector<Eigen::Matrix3d>> marginalCovariances(const PoseSystem& system,
                                                                const std::vector<bool>& held,
                                                                const Eigen::VectorXd& added);

/** Frames moved by Δ: (x, y, θ) + Δ, θ wrapped. */
Frames moved(const Frames& frames, const Eigen::VectorXd& step);

}  // namespace submap_slam::grid_joining
