#include "landmark_joining_fixture.h"

#include <submap_slam/core/plugins.h>
#include <submap_slam/rawlog/landmark_log.h>

#include <Eigen/Dense>
#include <filesystem>

namespace submap_slam::testing {

using namespace landmark_joining;

namespace {

JointState unstacked(const Eigen::VectorXd& x, const JointState& like) {
  JointState state = like;
  Eigen::Index row = 0;
  for (Pose& p : state.ends) p = x.segment<3>(row), row += 3;
  for (Point& p : state.landmarks) p = x.segment<2>(row), row += 2;
  return state;
}

}  // namespace

Eigen::VectorXd stacked(const JointState& state) {
  Eigen::VectorXd x(static_cast<Eigen::Index>(3 * state.ends.size() + 2 * state.landmarks.size()));
  Eigen::Index row = 0;
  for (const Pose& p : state.ends) x.segment<3>(row) = p, row += 3;
  for (const Point& p : state.landmarks) x.segment<2>(row) = p, row += 2;
  return x;
}

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

void EifTreePlugin::SetUp() {
  loadPlugin(EIF_TREE_PLUGIN);
  for (const auto& candidate : availableJoiners())
    if (candidate->name() == "eif_tree") joiner = std::dynamic_pointer_cast<LandmarkJoiner>(candidate);
  ASSERT_TRUE(joiner);
  joiner->describe(parameters);
}

void EifTreePlugin::expectObjective(const std::string& name, double minimum) {
  const auto file = std::filesystem::path(SUBMAP_SLAM_SOURCE_DIR "/../shared/data/landmark_submaps") / name;
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  const JoinedLandmarks joined = joiner->join(readLandmarkSubmaps(file.string()), {});
  EXPECT_EQ(joined.status, JoinStatus::kConverged);
  EXPECT_NEAR(joined.objective, minimum, 1e-4 * minimum);
}

}  // namespace submap_slam::testing
