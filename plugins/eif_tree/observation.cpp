#include "observation.h"

#include <fmt/format.h>
#include <mrpt/math/wrap2pi.h>
#include <submap_slam/core/errors.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace submap_slam::landmark_joining {
namespace {

/** Takes coordinates of the map to axes turned by φ. */
Eigen::Matrix2d turnInto(double phi) {
  const double c = std::cos(phi), s = std::sin(phi);
  Eigen::Matrix2d r;
  r << c, s, -s, c;
  return r;
}

/** Rows of the state of the submap that are kept. */
std::vector<int> keptRows(const std::vector<bool>& keep) {
  std::vector<int> rows{0, 1, 2};
  for (std::size_t i = 0; i < keep.size(); ++i)
    if (keep[i])
      for (int axis : {0, 1}) rows.push_back(3 + 2 * static_cast<int>(i) + axis);
  return rows;
}

std::vector<Point> landmarksOf(const JointProblem& problem, const JointState& state, std::size_t k) {
  std::vector<Point> points;
  points.reserve(problem.landmarks[k].size());
  for (const int index : problem.landmarks[k])
    points.push_back(state.landmarks[static_cast<std::size_t>(index)]);
  return points;
}

/** The start pose's columns of J: targets [−c −s h_y; s −c −h_x], heading [0 0 −1]. */
Eigen::MatrixX3d startColumns(const Pose& start, const Eigen::VectorXd& h) {
  const Eigen::Matrix2d turn = turnInto(start[2]);
  Eigen::MatrixX3d columns(h.size(), 3);
  const auto target = [&](Eigen::Index row) {
    columns.block<2, 2>(row, 0) = -turn;
    columns(row, 2) = h[row + 1];
    columns(row + 1, 2) = -h[row];
  };
  target(0);
  columns.row(2) << 0, 0, -1;
  for (Eigen::Index row = 3; row < h.size(); row += 2) target(row);
  return columns;
}

/** Dᵀ M for the targets' block-diagonal part D of J: [c s; −s c] for each target, 1 for the heading. */
template <class Matrix>
void turnRowsBack(Matrix& m, const Eigen::Matrix2d& turn) {
  const Eigen::Matrix2d back = turn.transpose();
  m.template topRows<2>() = (back * m.template topRows<2>()).eval();
  for (Eigen::Index row = 3; row < m.rows(); row += 2)
    m.template middleRows<2>(row) = (back * m.template middleRows<2>(row)).eval();
}

}  // namespace

Observation observationOf(const LandmarkSubmap& submap, const std::vector<bool>& keep) {
  Eigen::VectorXd z(static_cast<Eigen::Index>(submap.dimension()));
  z.head<3>() << submap.end_pose.x, submap.end_pose.y, submap.end_pose.phi;
  for (std::size_t i = 0; i < submap.features.size(); ++i)
    z.segment<2>(3 + 2 * static_cast<Eigen::Index>(i)) << submap.features[i].x, submap.features[i].y;
  const std::vector<int> rows = keptRows(keep);
  Observation observation;
  observation.z = z(rows);
  const Eigen::MatrixXd q = flooredCovariance(submap).asEigen()(rows, rows);
  const Eigen::LLT<Eigen::MatrixXd> factor(q);
  if (!q.allFinite() || factor.info() != Eigen::Success)
    throw InputError(fmt::format("submap {}: its covariance is not positive definite", submap.id));
  observation.information = factor.solve(Eigen::MatrixXd::Identity(q.rows(), q.cols()));
  return observation;
}

double areaOf(const Eigen::VectorXd& features) {
  double radius2 = 1;
  for (Eigen::Index row = 0; row < features.size(); row += 2)
    radius2 = std::max(radius2, features.segment<2>(row).squaredNorm());
  return M_PI * radius2;
}

Pose startOf(const JointState& state, std::size_t k) {
  return k == 0 ? Pose(Pose::Zero()) : state.ends[k - 1];
}

Point compose(const Pose& a, const Point& p) { return a.head<2>() + turnInto(a[2]).transpose() * p; }

Pose compose(const Pose& a, const Pose& b) {
  Pose c;
  c.head<2>() = compose(a, Point(b.head<2>()));
  c[2] = a[2] + b[2];
  return c;
}

Eigen::VectorXd predict(const Pose& start, const Pose& end, const std::vector<Point>& landmarks) {
  const Eigen::Matrix2d turn = turnInto(start[2]);
  Eigen::VectorXd h(3 + 2 * static_cast<Eigen::Index>(landmarks.size()));
  h.head<2>() = turn * (end - start).head<2>();  // (15), end position
  h[2] = end[2] - start[2];
  for (std::size_t i = 0; i < landmarks.size(); ++i)  // (15), features
    h.segment<2>(3 + 2 * static_cast<Eigen::Index>(i)) = turn * (landmarks[i] - start.head<2>());
  return h;
}

Eigen::VectorXd residual(const JointProblem& problem, const JointState& state, std::size_t k) {
  Eigen::VectorXd r =
      problem.observations[k]->z - predict(startOf(state, k), state.ends[k], landmarksOf(problem, state, k));
  r[2] = mrpt::math::wrapToPi(r[2]);
  return r;
}

double objective(const JointProblem& problem, const JointState& state) {
  double sum = 0;
  for (std::size_t k = 0; k < problem.submaps(); ++k) {
    const Eigen::VectorXd r = residual(problem, state, k);
    sum += r.dot(problem.observations[k]->information * r);
  }
  return sum;
}

Eigen::MatrixXd jacobian(const Pose& start, const Eigen::VectorXd& predicted) {
  const Eigen::Index n = predicted.size();
  Eigen::MatrixXd j(n, n + 3);
  j.leftCols<3>() = startColumns(start, predicted);
  Eigen::MatrixXd back = Eigen::MatrixXd::Identity(n, n);
  turnRowsBack(back, turnInto(start[2]));
  j.rightCols(n) = back.transpose();
  return j;
}

Contribution linearise(const JointProblem& problem, const JointState& state, std::size_t k) {
  const Observation& observation = *problem.observations[k];
  const Eigen::Index n = observation.z.size();
  const Pose start = startOf(state, k);
  const Eigen::Matrix2d turn = turnInto(start[2]);
  const Eigen::VectorXd r = residual(problem, state, k);
  const Eigen::MatrixX3d s =
      startColumns(start, observation.z - r);  // h = z − r, but for the wrapped heading

  // With J = [S D]: JᵀWJ = [SᵀWS SᵀWD; DᵀWS DᵀWD], JᵀWr likewise; (13) and (16) are sums of these.
  Eigen::MatrixX3d ws = observation.information * s;
  Eigen::VectorXd wr = observation.information * r;
  Contribution c;
  c.cost = r.dot(wr);
  c.matrix.resize(n + 3, n + 3);
  c.vector.resize(n + 3);
  c.matrix.topLeftCorner<3, 3>() = s.transpose() * ws;
  c.vector.head<3>() = s.transpose() * wr;
  turnRowsBack(ws, turn);
  turnRowsBack(wr, turn);
  c.matrix.bottomLeftCorner(n, 3) = ws;
  c.matrix.topRightCorner(3, n) = ws.transpose();
  c.vector.tail(n) = wr;
  Eigen::MatrixXd d = observation.information;  // → Dᵀ W
  turnRowsBack(d, turn);
  d.transposeInPlace();  // W Dᵀ transposed twice: DᵀWD is symmetric
  turnRowsBack(d, turn);
  c.matrix.bottomRightCorner(n, n) = d;
  return c;
}

}  // namespace submap_slam::landmark_joining
