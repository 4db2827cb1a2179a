#include <gmock/gmock.h>

#include <Eigen/Dense>
#include <cmath>

#include "eif_tree/chaining.h"
#include "eif_tree/known_association.h"
#include "landmark_world.h"

namespace submap_slam {
namespace {

using namespace landmark_joining;
using testing::simulateLandmarks;

TEST(Observation, PredictsASubmapByHand) {
  // Start at (1, 2) looking along y: what lies at (0, 5) is 3 ahead and 1 to the left.
  const Pose start(1, 2, M_PI / 2), end(1, 4, M_PI);
  const Eigen::VectorXd h = predict(start, end, {Point(0, 5)});
  Eigen::VectorXd expected(5);
  expected << 2, 0, M_PI / 2, 3, 1;
  EXPECT_LT((h - expected).norm(), 1e-12);
  EXPECT_LT((compose(start, Point(3, 1)) - Point(0, 5)).norm(), 1e-12);
}

TEST(Observation, JacobianAgreesWithFiniteDifferences) {
  const Pose start(1.5, -2, 0.7), end(3, -1, 1.9);
  const std::vector<Point> landmarks{{4, 1}, {-3, 2.5}};
  const Eigen::MatrixXd j = jacobian(start, predict(start, end, landmarks));
  ASSERT_EQ(j.rows(), 7);
  ASSERT_EQ(j.cols(), 10);
  const auto moved = [&](Eigen::Index column, double step) {
    Pose s = start, e = end;
    std::vector<Point> l = landmarks;
    if (column < 3) s[column] += step;
    if (column >= 3 && column < 6) e[column - 3] += step;
    if (column >= 6) l[static_cast<std::size_t>(column - 6) / 2][column % 2] += step;
    return predict(s, e, l);
  };
  for (Eigen::Index c = 0; c < 10; ++c)
    EXPECT_LT((j.col(c) - (moved(c, 1e-6) - moved(c, -1e-6)) / 2e-6).norm(), 1e-8) << "column " << c;
}

TEST(Observation, ContributionIsThatOfTheJacobian) {
  const auto associated = associateByIds(simulateLandmarks({}));
  const JointProblem& problem = associated.problem;
  const JointState state = chained(problem).state;
  const std::size_t k = 5;
  const Contribution c = linearise(problem, state, k);
  const Eigen::VectorXd r = residual(problem, state, k);
  const Eigen::MatrixXd j = jacobian(startOf(state, k), problem.observations[k]->z - r);
  const Eigen::MatrixXd& w = problem.observations[k]->information;
  EXPECT_LT((c.matrix - j.transpose() * w * j).norm(), 1e-9 * c.matrix.norm());
  EXPECT_LT((c.vector - j.transpose() * w * r).norm(), 1e-9 * (1 + c.vector.norm()));
  EXPECT_NEAR(c.cost, r.dot(w * r), 1e-9 * (1 + c.cost));
}

TEST(Observation, LeavesOutFeaturesByMarginalising) {
  const auto submap = simulateLandmarks({})[0];
  std::vector<bool> keep(submap->features.size(), true);
  keep[0] = false;
  const Observation observation = observationOf(*submap, keep);
  const Eigen::MatrixXd q = submap->covariance.asEigen();
  std::vector<int> rows{0, 1, 2};
  for (int row = 5; row < q.rows(); ++row) rows.push_back(row);
  const Eigen::MatrixXd expected = q(rows, rows).inverse();
  EXPECT_LT((observation.information - expected).norm(), 1e-8 * expected.norm());
}

}  // namespace
}  // namespace submap_slam
