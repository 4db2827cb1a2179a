#include <submap_slam/mapping/extent_forecast.h>

#include <mrpt/math/wrap2pi.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;

/** Mean range of the beams, no longer than what they draw into the evidence (m). */
double meanSight(const LaserPoints& scan, double max_range) {
  double sum = 0;
  for (const auto& sweep : scan.sweeps)
    for (std::size_t k = sweep.begin; k < sweep.end; ++k) {
      const Eigen::Vector2d end(static_cast<double>(scan.points[k].x), static_cast<double>(scan.points[k].y));
      sum += std::min((end - sweep.origin).norm(), max_range);
    }
  return scan.points.empty() ? 0 : sum / static_cast<double>(scan.points.size());
}

Eigen::Matrix3d turned(const Eigen::Matrix3d& information, double heading) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(heading).toRotationMatrix();
  return R * information * R.transpose();
}

}  // namespace

ExtentForecast::ExtentForecast(const GridMapperParams& mapper) : mapper_(mapper), drift_(mapper.drift) {}

void ExtentForecast::begin(const Frame& first) {
  drift_ = DriftCovariance(mapper_.drift);
  T_odom_start_ = first.odometry;
  pose_ = key_pose_ = TPose2D();
  path_ = 0, sight_sum_ = 0, key_scans_ = 0;
  seen_ = {};
  addKeyScan(first);
}

void ExtentForecast::add(const Frame& frame) {
  if (!T_odom_start_) T_odom_start_ = frame.odometry;
  const TPose2D now = frame.odometry ? *frame.odometry - *T_odom_start_ : pose_;
  path_ += std::hypot(now.x - pose_.x, now.y - pose_.y);
  drift_.move(pose_, now);
  pose_ = now;
  const TPose2D since = pose_ - key_pose_;
  const KeyParams& keys = mapper_.filter.keys;
  if (std::hypot(since.x, since.y) < keys.distance && std::abs(mrpt::math::wrapToPi(since.phi)) < keys.angle)
    return;
  addKeyScan(frame);
  drift_.addKeyScan(seen_.information, motionInformation(mapper_.filter.motion, since));
  key_pose_ = pose_;
}

void ExtentForecast::addKeyScan(const Frame& frame) {
  const double all = std::numeric_limits<double>::max();
  const LaserPoints scan = toLaserPoints(frame, mapper_.max_range > 0 ? mapper_.max_range : all);
  seen_ = informationOf(scan);
  seen_.information = turned(seen_.information, pose_.phi);
  if (scan.points.empty()) return;
  sight_sum_ += meanSight(scan, mapper_.evidence.max_range);
  ++key_scans_;
}

ExtentForecast::ScanInformation ExtentForecast::informationOf(const LaserPoints& scan) const {
  ScanInformation sum;
  for (const auto& p : scan.points) {
    Eigen::Vector2d normal(static_cast<double>(p.normal_x), static_cast<double>(p.normal_y));
    if (normal.isZero(0)) continue;
    normal.normalize();
    const double px = static_cast<double>(p.x), py = static_cast<double>(p.y);
    const Eigen::Vector3d row(normal.x(), normal.y(), px * normal.y() - py * normal.x());
    sum.information += row * row.transpose();
    sum.beams += 1;
  }
  sum.information /= std::pow(mapper_.filter.matcher.line_sigma, 2);
  return sum;
}

double ExtentForecast::blur() const {
  if (seen_.beams == 0) return 0;
  const double sigma = mapper_.filter.matcher.line_sigma;
  return sigma * std::sqrt((drift_.covariance() * seen_.information).trace() / seen_.beams);
}

double ExtentForecast::overlap() const {
  const double sight = key_scans_ > 0 ? sight_sum_ / static_cast<double>(key_scans_) : 0;
  return sight > 0 ? sight / (sight + path_) : 1;
}

}  // namespace submap_slam
