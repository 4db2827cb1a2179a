#include "prediction.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace submap_slam::landmark_joining {

Prediction predictLandmarks(InformationForm& form, const JointState& state, double radius_m) {
  const std::size_t last = state.ends.size() - 1;
  const Pose& start = state.ends[last];
  const int pose_row = form.pattern().poseRow(last);
  std::vector<int> rows{pose_row, pose_row + 1, pose_row + 2};
  const Eigen::MatrixXd c_start = covarianceOf(form, rows);
  constexpr double kSigmas = 4;
  const double reach =
      radius_m + kSigmas * std::sqrt(c_start(0, 0) + c_start(1, 1) + radius_m * radius_m * c_start(2, 2));
  Prediction p;
  for (std::size_t m = 0; m < state.landmarks.size(); ++m) {
    if ((state.landmarks[m] - start.head<2>()).norm() > reach) continue;
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
