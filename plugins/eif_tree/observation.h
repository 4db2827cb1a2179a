#pragma once

#include <mrpt/math/TPose2D.h>
#include <submap_slam/core/landmark_submap.h>

#include <Eigen/Core>
#include <vector>

namespace submap_slam::landmark_joining {

using Pose = Eigen::Vector3d;   ///< x, y (m), φ (rad)
using Point = Eigen::Vector2d;  ///< x, y (m)

/** What is estimated: the end pose of each submap and the landmarks, in the frame of the first submap's
 * start. Headings are not wrapped. */
struct JointState {
  std::vector<Pose> ends;
  std::vector<Point> landmarks;
};

/** A submap as one observation of its start pose, its end pose and its landmarks. */
struct Observation {
  Eigen::VectorXd z;            ///< x_e, y_e, φ_e, x_1, y_1, … in the submap's frame
  Eigen::MatrixXd information;  ///< Q⁻¹
};

/** The observation with the features that are kept; the others are marginalised, by leaving out their rows
 * and columns of Q. Throws InputError naming the submap if Q is not positive definite.
 * @param keep one for each feature */
Observation observationOf(const LandmarkSubmap& submap, const std::vector<bool>& keep);

/** Area (m²) of the disc about the start pose that holds the features, of a radius of at least 1 m.
 * @param features in the submap's frame, two rows for each */
double areaOf(const Eigen::VectorXd& features);

/** Where each submap of a sequence finds its landmarks in the state; submap k ends at pose k and starts at
 * pose k − 1, the first one at the origin. */
struct JointProblem {
  std::vector<const Observation*> observations;
  std::vector<std::vector<int>> landmarks;  ///< of each submap, in the order of its features
  std::size_t landmark_count = 0;

  std::size_t submaps() const { return observations.size(); }
};

/** Start pose of submap k. */
Pose startOf(const JointState& state, std::size_t k);

/** a ∘ b and a ∘ p, p a point in frame a. */
Pose compose(const Pose& a, const Pose& b);
Point compose(const Pose& a, const Point& p);

/** The submap as the state predicts it, h(X) (eq. 15). */
Eigen::VectorXd predict(const Pose& start, const Pose& end, const std::vector<Point>& landmarks);

/** Residual of submap k, z − h(X), heading wrapped. */
Eigen::VectorXd residual(const JointProblem& problem, const JointState& state, std::size_t k);

/** Sum over all submaps of rᵀ Q⁻¹ r. */
double objective(const JointProblem& problem, const JointState& state);

/** A submap's part of the normal equations: JᵀQ⁻¹J and JᵀQ⁻¹r, J = ∂h/∂(start, end, landmarks). Rows 0–2 are
 * the start pose, 3–5 the end pose, then two for each landmark. */
struct Contribution {
  Eigen::MatrixXd matrix;  ///< symmetric
  Eigen::VectorXd vector;
  double cost = 0;  ///< rᵀ Q⁻¹ r
};
Contribution linearise(const JointProblem& problem, const JointState& state, std::size_t k);

/** J of linearise(); also carries covariances over to predicted landmarks. */
Eigen::MatrixXd jacobian(const Pose& start, const Eigen::VectorXd& predicted);

}  // namespace submap_slam::landmark_joining
