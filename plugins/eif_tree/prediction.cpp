#include "prediction.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace submap_slam::landmark_joining {

namespace {

/** A feature where the start pose puts it, and how far from there its landmark may be. */
struct Disc {
  Point centre;
  double radius2 = 0;
};

std::vector<Disc> discsOf(const Pose& start, const Eigen::Matrix3d& c_start, const Eigen::VectorXd& z,
                          double margin_m) {
  constexpr double kSigmas = 4;
  std::vector<Disc> discs;
  for (Eigen::Index row = 0; row < z.size(); row += 2) {
    const Point feature = z.segment<2>(row);
    const double variance = c_start(0, 0) + c_start(1, 1) + feature.squaredNorm() * c_start(2, 2);
    const double radius = margin_m + kSigmas * std::sqrt(variance);
    discs.push_back({compose(start, feature), radius * radius});
  }
  return discs;
}

}  // namespace

Prediction predictLandmarks(const InformationForm& form, const JointState& state, const Eigen::VectorXd& z,
                            double margin_m) {
  const std::size_t last = state.ends.size() - 1;
  const Pose& start = state.ends[last];
  const int pose_row = form.pattern().poseRow(last);
  std::vector<int> rows{pose_row, pose_row + 1, pose_row + 2};
  const std::vector<Disc> discs = discsOf(start, covarianceOf(form, rows), z, margin_m);
  Prediction p;
  for (std::size_t m = 0; m < state.landmarks.size(); ++m) {
    const auto near = [&](const Disc& disc) {
      return (state.landmarks[m] - disc.centre).squaredNorm() <= disc.radius2;
    };
    if (std::none_of(discs.begin(), discs.end(), near)) continue;
    p.landmarks.push_back(static_cast<int>(m));
    rows.push_back(form.pattern().landmarkRow(m));
    rows.push_back(rows.back() + 1);
  }
  std::vector<Point> points;
  for (const int m : p.landmarks) points.push_back(state.landmarks[static_cast<std::size_t>(m)]);
  const Eigen::VectorXd h = predict(start, start, points);
  const Eigen::MatrixXd whole = jacobian(start, h);
  Eigen::MatrixXd j(h.size() - 3, h.size());  // rows of landmarks; columns of start and landmarks
  j << whole.bottomRows(h.size() - 3).leftCols(3), whole.bottomRightCorner(h.size() - 3, h.size() - 3);
  p.mean = h.tail(h.size() - 3);
  p.covariance = j * covarianceOf(form, rows) * j.transpose();
  return p;
}

Comparison compare(const Prediction& prediction, const Eigen::VectorXd& z, const Eigen::MatrixXd& q,
                   double gate2) {
  Comparison c;
  c.nearest2.assign(static_cast<std::size_t>(z.size() / 2), std::numeric_limits<double>::infinity());
  std::vector<int> feature_rows, landmark_rows;
  for (int f = 0; f < z.size() / 2; ++f)
    for (int l = 0; l < static_cast<int>(prediction.landmarks.size()); ++l) {
      const Eigen::Vector2d v = z.segment<2>(2 * f) - prediction.mean.segment<2>(2 * l);
      const Eigen::Matrix2d s = q.block<2, 2>(2 * f, 2 * f) + prediction.covariance.block<2, 2>(2 * l, 2 * l);
      const double distance2 = v.dot(s.inverse() * v);
      double& nearest = c.nearest2[static_cast<std::size_t>(f)];
      nearest = std::min(nearest, distance2);
      if (distance2 > gate2) continue;
      c.candidates.pairings.push_back({f, prediction.landmarks[static_cast<std::size_t>(l)], distance2});
      for (int axis : {0, 1}) feature_rows.push_back(2 * f + axis), landmark_rows.push_back(2 * l + axis);
    }
  c.candidates.gate2 = gate2;
  c.candidates.innovation = z(feature_rows) - prediction.mean(landmark_rows);
  c.candidates.covariance =
      q(feature_rows, feature_rows) + prediction.covariance(landmark_rows, landmark_rows);
  return c;
}

}  // namespace submap_slam::landmark_joining
