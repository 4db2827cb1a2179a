#include <gmock/gmock.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/core/landmark_joiner.h>
#include <submap_slam/core/plugins.h>
#include <submap_slam/rawlog/landmark_log.h>

#include <Eigen/Dense>
#include <cmath>
#include <filesystem>

#include "eif_tree/chaining.h"
#include "eif_tree/dense_filter.h"
#include "eif_tree/joining.h"
#include "eif_tree/known_association.h"
#include "eif_tree/sequential_filter.h"
#include "eif_tree/tree.h"
#include "landmark_world.h"

namespace submap_slam {
namespace {

using namespace landmark_joining;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::LandmarkWorldOptions;
using testing::simulateLandmarks;

/** Rows of the state: end poses, then landmarks. */
Eigen::VectorXd stacked(const JointState& state) {
  Eigen::VectorXd x(static_cast<Eigen::Index>(3 * state.ends.size() + 2 * state.landmarks.size()));
  Eigen::Index row = 0;
  for (const Pose& p : state.ends) x.segment<3>(row) = p, row += 3;
  for (const Point& p : state.landmarks) x.segment<2>(row) = p, row += 2;
  return x;
}

JointState unstacked(const Eigen::VectorXd& x, const JointState& like) {
  JointState state = like;
  Eigen::Index row = 0;
  for (Pose& p : state.ends) p = x.segment<3>(row), row += 3;
  for (Point& p : state.landmarks) p = x.segment<2>(row), row += 2;
  return state;
}

/** Residuals of all submaps, times the transposed Cholesky factor of their information: a plain least-squares
 * problem, with nothing in common with the solvers but h(X). */
Eigen::VectorXd whitened(const JointProblem& problem, const JointState& state) {
  Eigen::VectorXd all(0);
  for (std::size_t k = 0; k < problem.submaps(); ++k) {
    const Eigen::VectorXd r =
        problem.observations[k]->information.llt().matrixU() * residual(problem, state, k);
    all.conservativeResize(all.size() + r.size());
    all.tail(r.size()) = r;
  }
  return all;
}

Eigen::MatrixXd numericJacobian(const JointProblem& problem, const JointState& state) {
  const Eigen::VectorXd x = stacked(state);
  Eigen::MatrixXd jacobian(whitened(problem, state).size(), x.size());
  constexpr double kStep = 1e-6;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    Eigen::VectorXd up = x, down = x;
    up[i] += kStep, down[i] -= kStep;
    jacobian.col(i) =
        (whitened(problem, unstacked(up, state)) - whitened(problem, unstacked(down, state))) / (2 * kStep);
  }
  return jacobian;
}

/** Dense Gauss-Newton with numeric derivatives, from a state until it stands still. */
JointState denseGaussNewton(const JointProblem& problem, JointState state) {
  for (int i = 0; i < 20; ++i) {
    const Eigen::MatrixXd j = numericJacobian(problem, state);
    const Eigen::VectorXd step = j.colPivHouseholderQr().solve(-whitened(problem, state));
    state = unstacked(stacked(state) + step, state);
    if (step.cwiseAbs().maxCoeff() < 1e-9) break;
  }
  return state;
}

JoiningOptions by(Method method) {
  JoiningOptions options;
  options.method = method;
  options.gauss_newton.max_step_m = options.gauss_newton.max_step_rad = 1e-9;
  return options;
}

LandmarkSubmap::Ptr submapOf(const mrpt::math::TPose2D& end, const std::vector<SubmapFeature>& features,
                             double variance) {
  auto submap = LandmarkSubmap::Create();
  submap->end_pose = end;
  submap->features = features;
  submap->covariance.setIdentity(static_cast<int>(submap->dimension()));
  submap->covariance *= variance;
  return submap;
}

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
  const Eigen::MatrixXd lower = form.matrix();
  const Eigen::MatrixXd whole = Eigen::MatrixXd(lower.selfadjointView<Eigen::Lower>()).inverse();
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

TEST(EifTree, StoppingGivesTheBestSoFar) {
  const auto associated = associateByIds(simulateLandmarks({}));
  const Joining joining = joinBy({}, associated.problem, [](double) { return false; });
  EXPECT_EQ(joining.result.status, JoinStatus::kIterationLimit);
  EXPECT_TRUE(stacked(joining.state).allFinite());
}

TEST(EifTree, AStoppedTreeSaysSo) {
  const auto associated = associateByIds(simulateLandmarks({}));
  const Joining stopped = joinBy(by(Method::kTree), associated.problem, [](double) { return false; });
  EXPECT_EQ(stopped.result.status, JoinStatus::kIterationLimit);
  EXPECT_THAT(stopped.result.reason, HasSubstr("stopped"));
  EXPECT_TRUE(stacked(stopped.state).allFinite());
  const Joining whole = joinBy(by(Method::kTree), associated.problem, {});
  EXPECT_EQ(whole.result.status, JoinStatus::kConverged);
  EXPECT_LT(whole.result.objective, stopped.result.objective);
  const Joining in_the_end =
      joinBy(by(Method::kTree), associated.problem, [](double share) { return share < 1; });
  EXPECT_EQ(in_the_end.result.status, JoinStatus::kConverged) << "nothing was left to do";
}

TEST(EifTree, AStoppedFilterKeepsWhatWasFusedAndChainsTheRest) {
  const auto submaps = simulateLandmarks({});
  constexpr std::size_t kFused = 5;
  const auto part = associateByIds(LandmarkSubmaps(submaps.begin(), submaps.begin() + kFused));
  const auto associated = associateByIds(submaps);
  for (const Method method : {Method::kSequential, Method::kSequentialIterated, Method::kDenseFilter}) {
    int calls = 0;
    const Joining stopped =
        joinBy(by(method), associated.problem, [&](double) { return ++calls < static_cast<int>(kFused); });
    EXPECT_EQ(stopped.result.status, JoinStatus::kIterationLimit);
    EXPECT_THAT(stopped.result.reason, HasSubstr("stopped after 5 of 12 submaps"));
    const Joining fused = joinBy(by(method), part.problem, {});
    ASSERT_EQ(stopped.state.ends.size(), submaps.size());
    for (std::size_t k = 0; k < kFused; ++k) {
      EXPECT_LT((stopped.state.ends[k] - fused.state.ends[k]).norm(), 1e-9);
      EXPECT_LT((stopped.covariances.ends[k] - fused.covariances.ends[k]).norm(), 1e-12);
    }
    for (std::size_t k = kFused; k < submaps.size(); ++k) {
      const Pose chain = compose(stopped.state.ends[k - 1], Pose(associated.observations[k].z.head<3>()));
      EXPECT_LT((stopped.state.ends[k] - chain).norm(), 1e-12);
      EXPECT_GT(stopped.covariances.ends[k](2, 2), stopped.covariances.ends[k - 1](2, 2));
    }
    for (const auto& covariance : stopped.covariances.landmarks) EXPECT_GT(covariance.determinant(), 0);
  }
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

/** The joiner as the program gets it: from the plugin file. */
class EifTreePlugin : public ::testing::Test {
 protected:
  void SetUp() override {
    loadPlugin(EIF_TREE_PLUGIN);
    for (const auto& candidate : availableJoiners())
      if (candidate->name() == "eif_tree") joiner = std::dynamic_pointer_cast<LandmarkJoiner>(candidate);
    ASSERT_TRUE(joiner);
    joiner->describe(parameters);
  }

  /** Joins a file of the shared data sets, which may be absent. */
  void expectObjective(const std::string& name, double minimum) {
    const auto file = std::filesystem::path(SUBMAP_SLAM_SOURCE_DIR "/../shared/data/landmark_submaps") / name;
    if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
    const JoinedLandmarks joined = joiner->join(readLandmarkSubmaps(file.string()), {});
    EXPECT_EQ(joined.status, JoinStatus::kConverged);
    EXPECT_NEAR(joined.objective, minimum, 1e-4 * minimum);
  }

  std::shared_ptr<LandmarkJoiner> joiner;
  ParameterTable parameters;
};

TEST_F(EifTreePlugin, JoiningAsSubmapsComeGivesTheSameBits) {
  LandmarkWorldOptions options;
  options.submaps = 21;
  const LandmarkSubmaps all = simulateLandmarks(options);
  const auto at_work = joiner->incremental();
  for (const std::ptrdiff_t count : {1, 2, 3, 8, 13, 20, 21}) {
    const LandmarkSubmaps first(all.begin(), all.begin() + count);
    const JoinedLandmarks step = at_work->join(first, {}), at_once = joiner->join(first, {});
    ASSERT_EQ(step.frames.size(), at_once.frames.size());
    for (std::size_t k = 0; k < step.frames.size(); ++k)
      EXPECT_EQ(step.frames[k].mean.asTPose(), at_once.frames[k].mean.asTPose()) << count << " " << k;
    EXPECT_EQ(step.objective, at_once.objective) << count;
  }
}

TEST_F(EifTreePlugin, AStoppedIncrementalJoiningBeginsAnew) {
  const LandmarkSubmaps all = simulateLandmarks({});
  const auto at_work = joiner->incremental();
  at_work->join({all.begin(), all.begin() + 7}, [](double, const std::string&) { return false; });
  EXPECT_EQ(at_work->join(all, {}).objective, joiner->join(all, {}).objective);
}

TEST_F(EifTreePlugin, SubmapsWithoutIdsAreMatchedByPosition) {
  LandmarkSubmaps submaps = simulateLandmarks({});
  const std::size_t landmarks = joiner->join(submaps, {}).landmarks.size();
  for (const auto& submap : submaps) {
    submap->ids_known = false;
    for (std::size_t i = 0; i < submap->features.size(); ++i)
      submap->features[i].id = static_cast<uint32_t>(i + 1);
  }
  const JoinedLandmarks joined = joiner->join(submaps, {});
  EXPECT_FALSE(joined.association_known);
  EXPECT_EQ(joined.landmarks.size(), landmarks);
}

TEST_F(EifTreePlugin, GivesFramesAndLandmarksWithTheirCovariances) {
  auto submaps = simulateLandmarks({});
  for (auto& feature : submaps[0]->features) feature.hits = 10;
  const JoinedLandmarks joined = joiner->join(submaps, {});
  ASSERT_EQ(joined.frames.size(), submaps.size() + 1);
  EXPECT_EQ(joined.frames[0].mean.norm(), 0);
  EXPECT_EQ(joined.frames[0].cov(0, 0), 0);
  EXPECT_NEAR(joined.frames.back().mean.norm(), 0, 0.2) << "the drive ends where it began";
  EXPECT_GT(joined.frames[6].cov(0, 0), joined.frames[1].cov(0, 0));
  EXPECT_TRUE(joined.association_known);
  std::size_t features = 0, hits = 0, joined_hits = 0;
  for (const auto& submap : submaps)
    for (const auto& feature : submap->features) ++features, hits += feature.hits;
  for (const auto& landmark : joined.landmarks) joined_hits += landmark.hits;
  EXPECT_EQ(joined.associations.size(), features);
  EXPECT_EQ(joined_hits, hits);
}

TEST_F(EifTreePlugin, ContradictoryIdsEndInAResultThatIsFinite) {
  auto submaps = simulateLandmarks({});
  std::swap(submaps[3]->features.front().id, submaps[3]->features.back().id);
  const double consistent = joiner->join(simulateLandmarks({}), {}).objective;
  const JoinedLandmarks joined = joiner->join(submaps, {});
  EXPECT_TRUE(std::isfinite(joined.objective));
  EXPECT_GT(joined.objective, 10 * consistent);
}

TEST_F(EifTreePlugin, EveryMethodCanBeChosen) {
  for (const char* method : {"tree_gn", "tree", "sequential", "sequential_iterated", "ekf"}) {
    parameters.set("eif_tree", "method", method);
    EXPECT_NE(joiner->join(simulateLandmarks({}), {}).status, JoinStatus::kFailed) << method;
  }
  EXPECT_THROW(parameters.set("eif_tree", "method", "magic"), ConfigError);
}

TEST_F(EifTreePlugin, AMethodThatAssociationByPositionWouldIgnoreIsRefused) {
  parameters.set("eif_tree", "method", "ekf");
  EXPECT_NO_THROW(joiner->validate());
  parameters.set("eif_tree", "association", "jcbb");
  try {
    joiner->validate();
    ADD_FAILURE() << "no ConfigError";
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("association = jcbb"), HasSubstr("method = ekf")));
  }
  parameters.set("eif_tree", "method", "tree_gn");
  EXPECT_NO_THROW(joiner->validate());
}

TEST_F(EifTreePlugin, AStoppedAssociationKeepsWhatWasJoined) {
  parameters.set("eif_tree", "association", "jcbb");
  const auto submaps = simulateLandmarks({});
  int calls = 0;
  const JoinedLandmarks joined =
      joiner->join(submaps, [&](double, const std::string&) { return ++calls < 4; });
  EXPECT_EQ(joined.status, JoinStatus::kIterationLimit);
  EXPECT_THAT(joined.reason, HasSubstr("stopped after 4 of 12 submaps"));
  ASSERT_EQ(joined.frames.size(), submaps.size() + 1);
  EXPECT_FALSE(joined.landmarks.empty());
  std::size_t features = 0;
  for (const auto& submap : submaps) features += submap->features.size();
  ASSERT_EQ(joined.associations.size(), features);
  for (const auto& a : joined.associations) {
    const bool left_out = a.submap >= 4;
    EXPECT_TRUE(!left_out || a.kind == FeatureAssociation::Kind::kDropped) << a.submap;
  }
  for (std::size_t k = 5; k < joined.frames.size(); ++k)
    EXPECT_GT(joined.frames[k].cov(2, 2), joined.frames[k - 1].cov(2, 2));
}

TEST_F(EifTreePlugin, ReachesTheMinimumOfASimulatedSequence) { expectObjective("sim_8240_50.txt", 458.154); }
TEST_F(EifTreePlugin, ReachesTheMinimumOfALongSequence) {
  expectObjective("sim_35188_700.txt.gz", 10315.633);
}
TEST_F(EifTreePlugin, ReachesTheMinimumOfVictoriaPark) { expectObjective("vicpark_200.txt", 3643.435); }
TEST_F(EifTreePlugin, ReachesTheMinimumOfVictoriaParkStepByStep) {
  expectObjective("vicpark_6898.txt.gz", 9012.7196);
}

}  // namespace
}  // namespace submap_slam
