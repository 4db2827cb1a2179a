#include <submap_slam/landmarks/path_smoother.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace submap_slam::landmark_mapping {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/** Variances that a step with motion has at least, whatever the model leaves out (m², rad²); that of a pose
 * that is certain. */
const Vector3d kLeast(1e-10, 1e-10, 1e-12);
constexpr double kCertain = 1e-12;

constexpr double kFailed = std::numeric_limits<double>::quiet_NaN();

Index row(std::size_t feature) { return 3 + 2 * static_cast<Index>(feature); }

/** Normal equations of the present pose and of the features so far; only the lower triangle is kept. */
class Elimination {
 public:
  Elimination(const std::vector<MotionStep>& steps, const std::vector<Sighting>& sightings,
              SmoothedSubmap& submap)
      : steps_(steps), sightings_(sightings), submap_(submap) {}

  /** Moves all variables by one Gauss-Newton step. @return the largest change (m, rad); NaN if it failed */
  double iterate() {
    eliminate();
    llt_.compute(information_);
    if (!definite_ || llt_.info() != Eigen::Success) return kFailed;
    const VectorXd change = llt_.solve(vector_);
    for (std::size_t f = 0; f < submap_.features.size(); ++f)
      submap_.features[f] += change.segment<2>(row(f));
    return movePath(change);
  }

  /** Where it was linearised last, if that did not fail. */
  MatrixXd covariance() const {
    return llt_.solve(MatrixXd::Identity(information_.rows(), information_.rows()));
  }

 private:
  /** Change of an eliminated pose = offset − gain · changes of what was there after it. */
  struct Eliminated {
    MatrixXd gain;
    Vector3d offset;
  };

  void eliminate() {
    const Index size = row(submap_.features.size());
    information_ = MatrixXd::Zero(size, size);
    vector_ = VectorXd::Zero(size);
    eliminated_.clear();
    active_ = 3;
    information_.diagonal().head<3>().setConstant(1 / kCertain);
    fixed_ = definite_ = true;
    auto next = sightings_.begin();
    for (std::size_t k = 0; k < submap_.path.size(); ++k) {
      if (k > 0) move(k);
      for (; next != sightings_.end() && next->step == k; ++next) see(*next);
    }
  }

  void move(std::size_t k) {
    const Composition expected = compose(submap_.path[k - 1], steps_[k - 1].increment);
    if (steps_[k - 1].covariance.isZero(0)) {
      submap_.path[k] = expected.pose;
      follow(expected.by_a);
    } else {
      eliminateBefore(k, expected);
      fixed_ = false;
    }
  }

  /** A step without noise: the pose after it takes the place of the one before, by the Jacobian between them.
   */
  void follow(const Matrix3d& by_before) {
    eliminated_.push_back({MatrixXd::Zero(3, active_), Vector3d::Zero()});
    if (fixed_) return;
    const Matrix3d back = by_before.inverse(), own = information_.topLeftCorner<3, 3>();
    information_.topLeftCorner<3, 3>() =
        back.transpose() * Matrix3d(own.selfadjointView<Eigen::Lower>()) * back;
    information_.block(3, 0, active_ - 3, 3) *= back;
    vector_.head<3>() = (back.transpose() * vector_.head<3>()).eval();
    eliminated_.back().gain.leftCols<3>() = -back;
  }

  void eliminateBefore(std::size_t k, const Composition& expected) {
    Matrix3d covariance = expected.by_b * steps_[k - 1].covariance * expected.by_b.transpose();
    covariance.diagonal() += kLeast;
    const Matrix3d w = covariance.inverse();
    Vector3d error = submap_.path[k] - expected.pose;
    error[2] = wrapped(error[2]);

    if (fixed_) {
      eliminated_.push_back({MatrixXd::Zero(3, active_), Vector3d::Zero()});
      setPose(w, error);
      return;
    }
    const Index features = active_ - 3;
    MatrixXd coupling(3, active_);  // of the pose before with all the rest
    coupling << -expected.by_a.transpose() * w, information_.block(3, 0, features, 3).transpose();
    const Matrix3d own = information_.topLeftCorner<3, 3>();
    const Matrix3d of_before =
        Matrix3d(own.selfadjointView<Eigen::Lower>()) + expected.by_a.transpose() * w * expected.by_a;
    const Vector3d vector = vector_.head<3>() + expected.by_a.transpose() * w * error;
    const Eigen::LLT<Matrix3d> llt(of_before);
    definite_ = definite_ && llt.info() == Eigen::Success;
    eliminated_.push_back({llt.solve(coupling), llt.solve(vector)});

    setPose(w, error);
    const MatrixXd half = llt.matrixL().solve(coupling);
    information_.topLeftCorner(active_, active_)
        .selfadjointView<Eigen::Lower>()
        .rankUpdate(half.transpose(), -1);
    vector_.head(active_) -= coupling.transpose() * eliminated_.back().offset;
  }

  /** The pose as odometry alone has it. */
  void setPose(const Matrix3d& w, const Vector3d& error) {
    information_.topLeftCorner<3, 3>() = w;
    information_.block(3, 0, active_ - 3, 3).setZero();
    vector_.head<3>() = -w * error;
  }

  void see(const Sighting& sighting) {
    const Predicted p = predictMeasurement(submap_.path[sighting.step], sighting.T_robot_sensor,
                                           submap_.features[sighting.feature]);
    const Eigen::Matrix2d w = sighting.value.noise.inverse();
    const Eigen::Vector2d weighted = w * innovationOf(sighting.value.z, p.z);
    const Index at = row(sighting.feature);
    active_ = std::max(active_, at + 2);
    information_.block<2, 2>(at, at) += p.by_feature.transpose() * w * p.by_feature;
    vector_.segment<2>(at) += p.by_feature.transpose() * weighted;
    if (fixed_) return;
    information_.topLeftCorner<3, 3>() += p.by_pose.transpose() * w * p.by_pose;
    information_.block<2, 3>(at, 0) += p.by_feature.transpose() * w * p.by_pose;
    vector_.head<3>() += p.by_pose.transpose() * weighted;
  }

  /** @return the largest change, also of the features; NaN if one is not finite */
  double movePath(VectorXd change) {
    double largest = change.cwiseAbs().maxCoeff();
    for (std::size_t k = submap_.path.size(); k-- > 0;) {
      if (!change.allFinite()) return kFailed;
      submap_.path[k] += change.head<3>();
      largest = std::max(largest, change.head<3>().cwiseAbs().maxCoeff());
      if (k == 0) break;
      const Eliminated& before = eliminated_[k - 1];
      change.head<3>() = before.offset - before.gain * change.head(before.gain.cols());
    }
    return largest;
  }

  const std::vector<MotionStep>& steps_;
  const std::vector<Sighting>& sightings_;
  SmoothedSubmap& submap_;
  MatrixXd information_;
  VectorXd vector_;
  std::vector<Eliminated> eliminated_;
  Index active_ = 3;
  Eigen::LLT<MatrixXd> llt_;  ///< of the information
  bool definite_ = true;      ///< that of all poses that were eliminated
  bool fixed_ = true;         ///< the present pose is the first one, or as certain
};

/** Where the measurements put the features from the path, on average. */
std::vector<Point> located(const std::vector<Sighting>& sightings, const std::vector<Pose>& path) {
  std::vector<Point> points;
  std::vector<double> counts;
  for (const Sighting& s : sightings) {
    if (s.feature == points.size()) points.emplace_back(Point::Zero()), counts.push_back(0);
    points[s.feature] += locate(path[s.step], s.T_robot_sensor, s.value.z).feature;
    ++counts[s.feature];
  }
  for (std::size_t f = 0; f < points.size(); ++f) points[f] /= counts[f];
  return points;
}

}  // namespace

std::optional<SmoothedSubmap> smoothSubmap(const std::vector<MotionStep>& steps,
                                           const std::vector<Sighting>& sightings, std::vector<Pose> path) {
  constexpr int kMostIterations = 20;
  constexpr double kStands = 1e-4;  // m or rad
  SmoothedSubmap submap;
  submap.features = located(sightings, path);
  submap.path = std::move(path);
  Elimination elimination(steps, sightings, submap);
  for (int i = 0; i < kMostIterations; ++i) {
    const double change = elimination.iterate();
    if (std::isnan(change)) return std::nullopt;
    if (change >= kStands) continue;
    submap.covariance = elimination.covariance();
    if (!submap.covariance.allFinite()) return std::nullopt;
    return submap;
  }
  return std::nullopt;
}

}  // namespace submap_slam::landmark_mapping
