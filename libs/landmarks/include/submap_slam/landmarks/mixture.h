#pragma once

#include <submap_slam/landmarks/feature_map.h>
#include <submap_slam/landmarks/landmark_filter.h>

#include <cstddef>
#include <vector>

namespace submap_slam::landmark_mapping {

/** What one particle, or all that agree on the association, say of the pose and the features. */
struct MixtureComponent {
  double weight = 0;  ///< normalised
  Pose pose = Pose::Zero();
  Eigen::Matrix3d pose_covariance = Eigen::Matrix3d::Zero();
  std::vector<Feature> features;

  /** Of (x, y, φ, x_1, y_1, …) in the order of the features; empty: pose and features are independent, as
   * they are given the path, and have their own covariances. */
  Eigen::MatrixXd covariance;
};

struct MixtureOptions {
  int min_hits = 1;  ///< of features whose id is not known

  /** Particles that lack a feature of the best one are left out as long as they have no more weight than this
   * together; otherwise the feature is. */
  double most_left_out = 0.3;

  /** The mean of few samples is itself uncertain, and they spread less than what they are drawn from: with
   * Σw² = 1/n the spread is multiplied by (1 + 1/n) / (1 − 1/n). */
  bool small_sample_correction = true;
};

/** Rows of the pose and of the features with these indices, in a state (x, y, φ, x_1, y_1, …). */
std::vector<Eigen::Index> rowsOf(const std::vector<std::size_t>& features);

/** The mixture as one Gaussian with the same moments (Combined SLAM (7), (8)):
 *
 *     x̄ = Σ w_j x_j,   Q = Σ w_j [Q_j + (x_j − x̄)(x_j − x̄)ᵀ]
 *
 * Headings are taken about that of the best particle. Features correspond by their ids, the index of the
 * measurement that made them where the log has none; the best particle's set is the standard (9)–(11). The
 * path is left empty.
 * @param kept which components are in it */
LandmarkEstimate toGaussian(const std::vector<MixtureComponent>& components, const MixtureOptions& options,
                            std::vector<std::size_t>& kept);

}  // namespace submap_slam::landmark_mapping
