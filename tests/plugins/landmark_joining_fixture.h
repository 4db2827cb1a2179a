#pragma once

#include <gtest/gtest.h>
#include <submap_slam/core/landmark_joiner.h>
#include <submap_slam/core/parameters.h>

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "eif_tree/joining.h"

namespace submap_slam::testing {

/** Rows of the state: end poses, then landmarks. */
Eigen::VectorXd stacked(const landmark_joining::JointState& state);

/** Residuals of all submaps, times the transposed Cholesky factor of their information: a plain least-squares
 * problem, with nothing in common with the solvers but h(X). */
Eigen::VectorXd whitened(const landmark_joining::JointProblem& problem,
                         const landmark_joining::JointState& state);

Eigen::MatrixXd numericJacobian(const landmark_joining::JointProblem& problem,
                                const landmark_joining::JointState& state);

/** Dense Gauss-Newton with numeric derivatives, from a state until it stands still. */
landmark_joining::JointState denseGaussNewton(const landmark_joining::JointProblem& problem,
                                              landmark_joining::JointState state);

/** A method that goes on until nothing changes. */
landmark_joining::JoiningOptions by(landmark_joining::Method method);

/** A submap whose variables are independent, each with this variance. */
LandmarkSubmap::Ptr submapOf(const mrpt::math::TPose2D& end, const std::vector<SubmapFeature>& features,
                             double variance);

/** The joiner as the program gets it: from the plugin file. */
class EifTreePlugin : public ::testing::Test {
 protected:
  void SetUp() override;

  /** Joins a file of the shared data sets, which may be absent. */
  void expectObjective(const std::string& name, double minimum);

  std::shared_ptr<LandmarkJoiner> joiner;
  ParameterTable parameters;
};

}  // namespace submap_slam::testing
