#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "information_form.h"

namespace submap_slam::landmark_joining {

/** Marginal covariances of the end poses and the landmarks. */
struct Covariances {
  std::vector<Eigen::Matrix3d> ends;
  std::vector<Eigen::Matrix2d> landmarks;
};

/** An estimate with its covariances. */
struct Estimate {
  JointState state;
  Covariances covariances;
};

/** The diagonal blocks of I⁻¹ by Takahashi's equations; after InformationForm::factorize() only. */
Covariances marginalCovariances(const JointProblem& problem, const InformationForm& form);

/** The covariance of some rows of the state (rows of I, see BlockPattern), never the whole inverse; after
 * InformationForm::factorize() only. */
Eigen::MatrixXd covarianceOf(const InformationForm& form, const std::vector<int>& rows);

}  // namespace submap_slam::landmark_joining
