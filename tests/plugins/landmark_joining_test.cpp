#include <gmock/gmock.h>

#include <Eigen/Dense>
#include <cmath>

#include "eif_tree/chaining.h"
#include "eif_tree/dense_filter.h"
#include "eif_tree/known_association.h"
#include "eif_tree/sequential_filter.h"
#include "landmark_joining_fixture.h"
#include "landmark_world.h"

namespace submap_slam {
namespace {

using namespace landmark_joining;
using testing::by;
using testing::denseGaussNewton;
using ::testing::HasSubstr;
using testing::LandmarkWorldOptions;
using testing::numericJacobian;
using testing::simulateLandmarks;
using testing::stacked;
using testing::submapOf;
using testing::whitened;

TEST(EifTree, TwoSubmapsAreAveragedByTheirInformation) {
  // Headings are certain, so the problem is linear. The landmark is seen at x = 10 (variance 1) and, from the
  // end of the first submap at x = 4 (variance 1), at 4 + 5 = 9 (variance 1 + 1): mean (2·10 + 9)/3, variance
  // 2/3.
  auto first = submapOf({4, 0, 0}, {{1, 10, 0, 1}}, 1), second = submapOf({1, 0, 0}, {{1, 5, 0, 1}}, 1);
  for (const auto& submap : {first, second}) submap->covariance(2, 2) = 1e-8;
  const auto associated = associateByIds({first, second});
  for (const Method method : {Method::kTreeThenGaussNewton, Method::kTree, Method::kSequential,
                              Method::kSequentialIterated, Method::kDenseFilter}) {
    const Joining joining = joinBy(by(method), associated.problem, {});
    EXPECT_NEAR(joining.state.landmarks[0].x(), 29.0 / 3, 1e-4) << static_cast<int>(method);
    EXPECT_NEAR(joining.covariances.landmarks[0](0, 0), 2.0 / 3, 1e-4) << static_cast<int>(method);
    EXPECT_NEAR(joining.result.objective, 1.0 / 3, 1e-4) << "1² / (1 + 1 + 1)";
  }
}

TEST(EifTree, WhereTheProblemIsLinearAllMethodsAreBatchLeastSquares) {
  LandmarkWorldOptions world;
  world.sigma_rad = 1e-7;  // headings are certain
  const auto associated = associateByIds(simulateLandmarks(world));
  const JointState batch = denseGaussNewton(associated.problem, chained(associated.problem).state);
  for (const Method method : {Method::kTreeThenGaussNewton, Method::kTree, Method::kSequential,
                              Method::kSequentialIterated, Method::kDenseFilter}) {
    const Joining joining = joinBy(by(method), associated.problem, {});
    EXPECT_LT((stacked(joining.state) - stacked(batch)).cwiseAbs().maxCoeff(), 2e-4)
        << static_cast<int>(method);
  }
}

TEST(EifTree, TreeWithGaussNewtonIteratedFilterAndDenseGaussNewtonAgree) {
  for (const uint32_t seed : {1u, 2u, 3u}) {
    LandmarkWorldOptions world;
    world.seed = seed;
    const auto associated = associateByIds(simulateLandmarks(world));
    const Joining tree = joinBy(by(Method::kTreeThenGaussNewton), associated.problem, {});
    const Joining sequential = joinBy(by(Method::kSequentialIterated), associated.problem, {});
    const JointState dense = denseGaussNewton(associated.problem, tree.state);
    EXPECT_EQ(tree.result.status, JoinStatus::kConverged);
    EXPECT_LT((stacked(tree.state) - stacked(dense)).cwiseAbs().maxCoeff(), 1e-6);
    EXPECT_NEAR(tree.result.objective, whitened(associated.problem, dense).squaredNorm(), 1e-6);
    // The filter relinearises only when an estimate changed by more than 1 cm.
    EXPECT_LT((stacked(sequential.state) - stacked(dense)).cwiseAbs().maxCoeff(), 1e-3);
  }
}

TEST(EifTree, ObjectiveIsThatOfItsDegreesOfFreedom) {
  LandmarkWorldOptions world;
  world.submaps = 60, world.radius_m = 80;
  const auto associated = associateByIds(simulateLandmarks(world));
  const Joining joining = joinBy({}, associated.problem, {});
  double rows = 0;
  for (const auto& observation : associated.observations) rows += static_cast<double>(observation.z.size());
  const double freedom = rows - static_cast<double>(stacked(joining.state).size());
  EXPECT_NEAR(joining.result.objective, freedom, 5 * std::sqrt(2 * freedom));
}

TEST(EifTree, CovariancesAreThoseOfTheDenseInverse) {
  const auto associated = associateByIds(simulateLandmarks({}));
  const JointProblem& problem = associated.problem;
  const Joining joining = joinBy(by(Method::kTreeThenGaussNewton), problem, {});
  const Eigen::MatrixXd j = numericJacobian(problem, joining.state);
  const Eigen::MatrixXd inverse = (j.transpose() * j).inverse();
  const auto landmarks_from = static_cast<Eigen::Index>(3 * problem.submaps());
  for (std::size_t k = 0; k < problem.submaps(); ++k) {
    const auto row = 3 * static_cast<Eigen::Index>(k);
    const Eigen::Matrix3d expected = inverse.block<3, 3>(row, row);
    EXPECT_LT((joining.covariances.ends[k] - expected).norm(), 1e-4 * expected.norm());
  }
  for (std::size_t m = 0; m < problem.landmark_count; ++m) {
    const auto row = landmarks_from + 2 * static_cast<Eigen::Index>(m);
    const Eigen::Matrix2d expected = inverse.block<2, 2>(row, row);
    EXPECT_LT((joining.covariances.landmarks[m] - expected).norm(), 1e-4 * expected.norm());
  }
}

TEST(EifTree, CovarianceOfSomeRowsIsASubMatrixOfTheDenseInverse) {
  const auto associated = associateByIds(simulateLandmarks({}));
  const JointState state = chained(associated.problem).state;
  InformationForm form(associated.problem);
  form.lineariseAll(state);
  ASSERT_TRUE(form.factorize());
  const Eigen::MatrixXd upper = form.matrix();
  const Eigen::MatrixXd whole = Eigen::MatrixXd(upper.selfadjointView<Eigen::Upper>()).inverse();
  const int pose = form.pattern().poseRow(3), landmark = form.pattern().landmarkRow(8);
  const std::vector<int> rows{pose, pose + 1, pose + 2, landmark, landmark + 1};
  const Eigen::MatrixXd expected = whole(rows, rows);
  EXPECT_LT((covarianceOf(form, rows) - expected).norm(), 1e-8 * expected.norm());

  const auto a = form.cholesky().halfInverse({pose, pose + 1, pose + 2});
  const auto b = form.cholesky().halfInverse({landmark, landmark + 1});
  const Eigen::MatrixXd between = whole.block(pose, landmark, 3, 2);
  EXPECT_LT((inverseBetween(a, b) - between).norm(), 1e-8 * expected.norm());
}

TEST(EifTree, ALargeLoopIsClosedByTheTree) {
  LandmarkWorldOptions world;
  world.submaps = 100, world.radius_m = 300, world.sigma_m = 0.1, world.sigma_rad = 0.02;
  const auto associated = associateByIds(simulateLandmarks(world));
  const Joining joining = joinBy({}, associated.problem, {});
  EXPECT_EQ(joining.result.status, JoinStatus::kConverged);
  double rows = 0;
  for (const auto& observation : associated.observations) rows += static_cast<double>(observation.z.size());
  EXPECT_LT(joining.result.objective, 2 * rows);
}

TEST(EifTree, OneSubmapIsGivenBackAsItIs) {
  const auto submap = submapOf({1, 2, 0.5}, {{3, 4, 5, 1}}, 0.25);
  const auto associated = associateByIds({submap});
  for (const Method method : {Method::kTreeThenGaussNewton, Method::kSequential, Method::kDenseFilter}) {
    const Joining joining = joinBy(by(method), associated.problem, {});
    EXPECT_LT((joining.state.ends[0] - Pose(1, 2, 0.5)).norm(), 1e-12);
    EXPECT_LT((joining.state.landmarks[0] - Point(4, 5)).norm(), 1e-12);
    EXPECT_NEAR(joining.covariances.ends[0](2, 2), 0.25, 1e-12);
  }
}

TEST(EifTree, SubmapsWithoutFeaturesOrMotionAreJoinedToo) {
  auto still = submapOf({0, 0, 0}, {}, 0);
  const auto associated = associateByIds(
      {submapOf({1, 0, 0}, {{1, 2, 0, 1}}, 0.01), still, submapOf({1, 0, 0}, {{1, 1, 0, 1}}, 0.01)});
  const Joining joining = joinBy({}, associated.problem, {});
  EXPECT_EQ(joining.result.status, JoinStatus::kConverged);
  EXPECT_LT((joining.state.ends[2] - Pose(2, 0, 0)).norm(), 1e-6);
}

TEST(EifTree, AChainHasTheCovarianceOfAProblemWithoutCommonLandmarks) {
  auto submaps = simulateLandmarks({});
  for (std::size_t k = 0; k < submaps.size(); ++k)
    for (auto& feature : submaps[k]->features) feature.id += static_cast<uint32_t>(1000 * k);
  const auto associated = associateByIds(submaps);
  const Estimate chain = chained(associated.problem);
  const Joining joined = joinBy(by(Method::kTree), associated.problem, {});
  for (std::size_t k = 0; k < submaps.size(); ++k)
    EXPECT_LT((chain.covariances.ends[k] - joined.covariances.ends[k]).norm(),
              1e-6 * chain.covariances.ends[k].norm());
  for (std::size_t m = 0; m < associated.problem.landmark_count; ++m)
    EXPECT_LT((chain.covariances.landmarks[m] - joined.covariances.landmarks[m]).norm(),
              1e-6 * chain.covariances.landmarks[m].norm());
}

TEST(EifTree, AProblemTooLargeForTheDenseFilterFailsForThatReason) {
  const LandmarkSubmaps many(kLargestDenseState / 3 + 1, submapOf({1, 0, 0}, {}, 0.01));
  const auto associated = associateByIds(many);
  const Joining joining = joinBy(by(Method::kDenseFilter), associated.problem, {});
  EXPECT_EQ(joining.result.status, JoinStatus::kFailed);
  EXPECT_THAT(joining.result.reason, HasSubstr("too large"));
  EXPECT_GT(joining.covariances.ends.back()(0, 0), joining.covariances.ends.front()(0, 0));
}

}  // namespace
}  // namespace submap_slam
