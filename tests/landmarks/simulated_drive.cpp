#include "simulated_drive.h"

#include <mrpt/poses/CPose2D.h>

#include <Eigen/Core>
#include <cmath>
#include <random>

namespace submap_slam::testing {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kRange = 15, kFieldOfView = M_PI;

LandmarkScan measure(const DriveOptions& o, const Drive& drive, const TPose2D& robot, std::mt19937& random) {
  std::normal_distribution<double> normal;
  LandmarkScan scan;
  scan.T_robot_sensor = {0.3, 0.1, 0};
  scan.max_range = kRange, scan.field_of_view = kFieldOfView;
  scan.sigma_range = o.sigma_range, scan.sigma_bearing = o.sigma_bearing;
  const TPose2D sensor = robot + scan.T_robot_sensor;
  for (std::size_t i = 0; i < drive.landmarks.size(); ++i) {
    const TPoint2D p = sensor.inverseComposePoint(drive.landmarks[i]);
    const double range = std::hypot(p.x, p.y), bearing = std::atan2(p.y, p.x);
    if (range > kRange || std::abs(bearing) > kFieldOfView / 2) continue;
    LandmarkMeasurement m{
        range + o.sigma_range * normal(random), bearing + o.sigma_bearing * normal(random), {}};
    if (o.ids) m.id = static_cast<uint32_t>(i + 1);
    scan.measurements.push_back(m);
  }
  return scan;
}

}  // namespace

Drive simulateDrive(const DriveOptions& o) {
  std::mt19937 random(o.seed);
  std::normal_distribution<double> normal;
  Drive drive;
  for (int i = 0; i < 16; ++i)
    drive.landmarks.emplace_back(-4.0 + 2.5 * i, (i % 2 == 0 ? 5.0 : -4.0) + 0.25 * (i % 5));
  TPose2D truth, odometry;
  for (int k = 0; k < o.frames; ++k) {
    if (k > 0 && o.step_m > 0) {
      const TPose2D step(o.step_m, 0, o.turn_rad);
      truth = truth + step;
      odometry = odometry + TPose2D(step.x + o.sigma_xy * normal(random), o.sigma_xy * normal(random),
                                    step.phi + o.sigma_phi * normal(random));
    }
    Frame frame;
    frame.index = static_cast<std::size_t>(k);
    frame.stamp = mrpt::Clock::fromDouble(1000 + 0.2 * k);
    frame.odometry = odometry;
    mrpt::math::CMatrixDouble33 covariance;
    covariance.setZero();
    if (k > 0 && o.step_m > 0)
      covariance.asEigen().diagonal() << o.sigma_xy * o.sigma_xy, o.sigma_xy * o.sigma_xy,
          o.sigma_phi * o.sigma_phi;
    frame.motion_covariance = covariance;
    frame.landmark_scans.push_back(measure(o, drive, truth, random));
    drive.stretch.frames.push_back(std::move(frame));
    drive.path.push_back(truth);
  }
  drive.stretch.last = true;
  return drive;
}

}  // namespace submap_slam::testing
