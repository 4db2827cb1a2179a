#pragma once

#include "compatibility.h"
#include "covariances.h"

namespace submap_slam::landmark_joining {

/** Landmarks of a state, as the start of the next submap sees them, with their joint covariance. */
struct Prediction {
  std::vector<int> landmarks;
  Eigen::VectorXd mean;        ///< two rows for each, in the next submap's frame
  Eigen::MatrixXd covariance;  ///< J C Jᵀ with C recovered for the start pose and these landmarks alone
};

/** Predicts the landmarks that are within `margin_m` of one of the submap's features, and as far beyond as
 * that feature is uncertain because the start pose is. `form` must be factorized.
 * @param z features in the submap's frame, two rows for each */
Prediction predictLandmarks(const InformationForm& form, const JointState& state, const Eigen::VectorXd& z,
                            double margin_m);

/** Pairings of features with predicted landmarks within the gate, and for each feature the squared distance
 * of the nearest landmark (infinite if there is none).
 * @param z features, two rows for each, with covariance q */
struct Comparison {
  Candidates candidates;
  std::vector<double> nearest2;
};
Comparison compare(const Prediction& prediction, const Eigen::VectorXd& z, const Eigen::MatrixXd& q,
                   double gate2);

}  // namespace submap_slam::landmark_joining
