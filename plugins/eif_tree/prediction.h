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

/** Predicts the landmarks within `radius_m`, and as far beyond it as the start pose is uncertain. `form` must
 * be factorized. */
Prediction predictLandmarks(InformationForm& form, const JointState& state, double radius_m);

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
