#include "report_parts.h"

#include <gmock/gmock.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <set>
#include <vector>

namespace submap_slam {
namespace {

TEST(SigmaEllipse, AgreesWithAnEigensolver) {
  const std::vector<Eigen::Vector3d> covariances{
      {0.04, 0.01, 0.02}, {0.01, -0.015, 0.04}, {1, 0, 4}, {4, 0, 1}};
  for (const Eigen::Vector3d& c : covariances) {
    Eigen::Matrix2d cov;
    cov << c(0), c(1), c(1), c(2);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(cov);
    const SigmaEllipse ellipse = sigmaEllipse(c(0), c(1), c(2));
    EXPECT_NEAR(ellipse.minor, std::sqrt(eigen.eigenvalues()(0)), 1e-12);
    EXPECT_NEAR(ellipse.major, std::sqrt(eigen.eigenvalues()(1)), 1e-12);
    const Eigen::Vector2d axis(std::cos(ellipse.angle), std::sin(ellipse.angle));
    EXPECT_NEAR(std::abs(axis.dot(eigen.eigenvectors().col(1))), 1, 1e-12);
  }
}

TEST(SigmaEllipse, OfACertainPointIsAPoint) {
  const SigmaEllipse ellipse = sigmaEllipse(0, 0, 0);
  EXPECT_EQ(ellipse.major, 0);
  EXPECT_EQ(ellipse.minor, 0);
  EXPECT_TRUE(std::isfinite(ellipse.angle));
}

void observe(EvidenceGrid& grid, unsigned cx, unsigned cy) { *grid.hits.cellByIndex(cx, cy) = 1; }

TEST(Outline, IsTheHullOfAnLInTheGlobalFrame) {
  EvidenceGrid grid(0, 3, 0, 3, 1);
  for (unsigned i = 0; i < 3; ++i) observe(grid, i, 0), observe(grid, 0, i);
  const Json outline = outlineJson(PackedEvidence(grid), {10, 0, M_PI / 2});
  std::set<std::pair<double, double>> corners;
  for (const auto& p : outline) corners.emplace(p[0].get<double>(), p[1].get<double>());
  // In the local frame (0, 0), (3, 0), (3, 1), (1, 3), (0, 3); in the global one x = 10 − y, y = x.
  const std::set<std::pair<double, double>> expected{{10, 0}, {10, 3}, {9, 3}, {7, 1}, {7, 0}};
  EXPECT_EQ(corners, expected);
  EXPECT_EQ(outline.size(), 5u);
}

TEST(Outline, OfNothingIsEmpty) {
  EXPECT_TRUE(outlineJson(PackedEvidence(EvidenceGrid(0, 1, 0, 1, 1)), {}).empty());
}

}  // namespace
}  // namespace submap_slam
