#include <gtest/gtest.h>
#include <submap_slam/core/joined_map.h>

#include <cmath>

#include "grid_gauss_newton/constraint_prior.h"

namespace submap_slam {
namespace {

TEST(ConstraintPrior, GradientAndMatrixAreDerivativesOfItsCost) {
  GridSubmaps submaps{GridSubmap::Create(), GridSubmap::Create(), GridSubmap::Create()};
  submaps[1]->id = 1, submaps[2]->id = 2;
  submaps[0]->has_successor = submaps[1]->has_successor = true;
  submaps[0]->end_pose.mean = mrpt::poses::CPose2D(1.0, 0.2, 3.0);
  submaps[1]->end_pose.mean = mrpt::poses::CPose2D(0.4, -0.6, -0.5);
  Eigen::Matrix3d cov;
  cov << 0.04, 0.01, 0.002, 0.01, 0.09, -0.003, 0.002, -0.003, 0.01;
  submaps[0]->end_pose.cov = cov;
  submaps[1]->end_pose.cov = cov;
  const grid_joining::ConstraintPrior prior(chainSubmaps(submaps).constraints, submaps, 2.5);
  const grid_joining::Frames frames{{0, 0, 0.4}, {0.7, 0.9, -2.8}, {0.9, 1.8, 2.9}};
  const auto system = prior.linearise(frames);
  const double h = 1e-6;
  for (Eigen::Index k = 0; k < 9; ++k) {
    Eigen::VectorXd step = Eigen::VectorXd::Zero(9);
    step[k] = h;
    const double difference =
        (prior.cost(grid_joining::moved(frames, step)) - prior.cost(grid_joining::moved(frames, -step))) /
        (2 * h);
    EXPECT_NEAR(2 * system.denseGradient()[k], difference, 1e-6 * (1 + std::abs(difference)));
  }
  EXPECT_EQ(grid_joining::ConstraintPrior(chainSubmaps(submaps).constraints, submaps, 0).cost(frames), 0);

  // At the prior's own optimum J^T Omega J is half the Hessian: check it along a direction.
  const grid_joining::Frames exact{
      frames[0], frames[0] + submaps[0]->end_pose.mean.asTPose(),
      frames[0] + submaps[0]->end_pose.mean.asTPose() + submaps[1]->end_pose.mean.asTPose()};
  EXPECT_NEAR(prior.cost(exact), 0, 1e-12);
  const Eigen::VectorXd along = Eigen::VectorXd::LinSpaced(9, -1, 1.3);
  EXPECT_NEAR(prior.cost(grid_joining::moved(exact, 1e-4 * along)) / 1e-8,
              along.dot(prior.linearise(exact).denseMatrix() * along), 1e-2 * along.squaredNorm());
}

}  // namespace
}  // namespace submap_slam
