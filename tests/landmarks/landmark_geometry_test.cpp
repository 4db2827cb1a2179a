/** Jacobians against central differences, and measuring as the inverse of locating. */
#include <gtest/gtest.h>
#include <submap_slam/landmarks/landmark_geometry.h>

#include <cmath>
#include <functional>

namespace submap_slam::landmark_mapping {
namespace {

const Pose kRobot(1.2, -0.7, 2.4), kSensor(3.78, 0.5, -0.3);
const Point kFeature(9, -6);

Eigen::MatrixXd numeric(const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& f,
                        const Eigen::VectorXd& at) {
  constexpr double kStep = 1e-6;
  Eigen::MatrixXd jacobian(f(at).size(), at.size());
  for (Eigen::Index i = 0; i < at.size(); ++i) {
    const Eigen::VectorXd step = Eigen::VectorXd::Unit(at.size(), i) * kStep;
    jacobian.col(i) = (f(at + step) - f(at - step)) / (2 * kStep);
  }
  return jacobian;
}

TEST(Compose, HasTheDerivativesOfFiniteDifferences) {
  const Composition c = compose(kRobot, kSensor);
  EXPECT_TRUE(c.by_a.isApprox(numeric([](const auto& a) { return compose(a, kSensor).pose; }, kRobot), 1e-7));
  EXPECT_TRUE(c.by_b.isApprox(numeric([](const auto& b) { return compose(kRobot, b).pose; }, kSensor), 1e-7));
}

TEST(PredictMeasurement, HasTheDerivativesOfFiniteDifferences) {
  const Predicted p = predictMeasurement(kRobot, kSensor, kFeature);
  const auto of_pose = [](const auto& x) { return predictMeasurement(x, kSensor, kFeature).z; };
  const auto of_feature = [](const auto& f) { return predictMeasurement(kRobot, kSensor, f).z; };
  EXPECT_TRUE(p.by_pose.isApprox(numeric(of_pose, kRobot), 1e-6));
  EXPECT_TRUE(p.by_feature.isApprox(numeric(of_feature, kFeature), 1e-6));
}

TEST(Locate, HasTheDerivativesOfFiniteDifferences) {
  const Eigen::Vector2d z(8, 0.6);
  const Located l = locate(kRobot, kSensor, z);
  const auto of_pose = [&z](const auto& x) { return locate(x, kSensor, z).feature; };
  const auto of_z = [](const auto& m) { return locate(kRobot, kSensor, m).feature; };
  EXPECT_TRUE(l.by_pose.isApprox(numeric(of_pose, kRobot), 1e-7));
  EXPECT_TRUE(l.by_measurement.isApprox(numeric(of_z, z), 1e-7));
}

TEST(Locate, IsTheInverseOfMeasuring) {
  const Predicted p = predictMeasurement(kRobot, kSensor, kFeature);
  EXPECT_TRUE(locate(kRobot, kSensor, p.z).feature.isApprox(kFeature, 1e-12));
}

TEST(PredictMeasurement, SeesAheadAndToTheLeftAsPositive) {
  // Sensor 1 m ahead of a robot that looks along y; a feature 2 m ahead of it and 2 m to the left.
  const Predicted p = predictMeasurement({0, 0, M_PI / 2}, {1, 0, 0}, {-2, 3});
  EXPECT_NEAR(p.z[0], std::sqrt(8.0), 1e-12);
  EXPECT_NEAR(p.z[1], M_PI / 4, 1e-12);
}

TEST(PredictMeasurement, IsFiniteAtTheSensorItself) {
  const Predicted p = predictMeasurement(Pose::Zero(), Pose::Zero(), Point::Zero());
  EXPECT_TRUE(p.by_pose.allFinite() && p.by_feature.allFinite());
}

TEST(InnovationOf, TakesBearingsTheShortWay) {
  EXPECT_NEAR(innovationOf({1, M_PI - 0.1}, {1, -M_PI + 0.1})[1], -0.2, 1e-12);
}

}  // namespace
}  // namespace submap_slam::landmark_mapping
