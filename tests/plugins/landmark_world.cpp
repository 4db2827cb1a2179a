#include "landmark_world.h"

#include <mrpt/math/wrap2pi.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

namespace submap_slam::testing {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

/** A random covariance with the variances of the options and correlations of about a half. */
Eigen::MatrixXd randomCovariance(const LandmarkWorldOptions& o, Eigen::Index size, std::mt19937& random) {
  std::normal_distribution<double> normal;
  Eigen::MatrixXd root = Eigen::MatrixXd::Identity(size, size);
  for (Eigen::Index row = 0; row < size; ++row)
    for (Eigen::Index column = 0; column < size; ++column)
      root(row, column) += 0.5 * normal(random) / std::sqrt(static_cast<double>(size));
  Eigen::VectorXd sigma = Eigen::VectorXd::Constant(size, o.sigma_m);
  sigma[2] = o.sigma_rad;
  return sigma.asDiagonal() * root * root.transpose() * sigma.asDiagonal();
}

TPose2D poseAt(const LandmarkWorldOptions& o, int k) {
  const double angle = 2 * M_PI * k / o.submaps;
  return {o.radius_m * std::sin(angle), o.radius_m * (1 - std::cos(angle)), mrpt::math::wrapToPi(angle)};
}

LandmarkSubmap::Ptr observe(const LandmarkWorldOptions& o, int k, const std::vector<TPoint2D>& landmarks,
                            std::mt19937& random) {
  auto submap = LandmarkSubmap::Create();
  submap->id = static_cast<uint32_t>(k);
  const TPose2D start = poseAt(o, k), end = poseAt(o, k + 1) - start;
  const double range = o.radius_m * std::sin(M_PI / o.submaps) * 2.5;
  Eigen::VectorXd z(3);
  z << end.x, end.y, end.phi;
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    const TPoint2D p = start.inverseComposePoint(landmarks[i]);
    if (std::hypot(p.x, p.y) > range) continue;
    submap->features.push_back({static_cast<uint32_t>(i + 1), 0, 0, 1});
    z.conservativeResize(z.size() + 2);
    z.tail<2>() << p.x, p.y;
  }
  const Eigen::MatrixXd q = randomCovariance(o, z.size(), random);
  std::normal_distribution<double> normal;
  z += q.llt().matrixL() * Eigen::VectorXd::NullaryExpr(z.size(), [&] { return normal(random); });
  submap->end_pose = {z[0], z[1], mrpt::math::wrapToPi(z[2])};
  for (std::size_t i = 0; i < submap->features.size(); ++i) {
    const auto row = 3 + 2 * static_cast<Eigen::Index>(i);
    submap->features[i].x = z[row], submap->features[i].y = z[row + 1];
  }
  submap->covariance = mrpt::math::CMatrixDouble(q);
  return submap;
}

}  // namespace

LandmarkSubmaps simulateLandmarks(const LandmarkWorldOptions& options) {
  std::mt19937 random(options.seed);
  std::uniform_real_distribution<double> uniform(-0.3, 0.3);
  std::vector<TPoint2D> landmarks;
  const int count = options.submaps * options.features / 3;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * M_PI * i / count;
    const double radius = options.radius_m * ((i % 2 == 0 ? 0.85 : 1.15) + 0.3 * uniform(random));
    landmarks.emplace_back(radius * std::sin(angle), options.radius_m - radius * std::cos(angle));
  }
  LandmarkSubmaps submaps;
  for (int k = 0; k < options.submaps; ++k) submaps.push_back(observe(options, k, landmarks, random));
  return submaps;
}

}  // namespace submap_slam::testing
