#include <mrpt/poses/CPose3D.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/simulation/normal_generator.h>
#include <submap_slam/simulation/simulate.h>

#include <algorithm>
#include <cmath>

#include "constants.h"
#include "log_time.h"

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;
using mrpt::obs::CObservation2DRangeScan;

constexpr double kTimeRounding = 1e-9;  // s; a step that ends at the time of an event belongs to it

/** Measures a robot's steps and adds them up. */
class Odometer {
 public:
  Odometer(const OdometryModel& model, uint64_t seed) : model_(model), normal_(seed, kOdometryStream) {}

  /** A step that lasts from time `begin` to `end` (s). */
  void step(const TPose2D& increment, double begin, double end) {
    TPose2D measured = withNoise(withSystematicErrors(increment, end), increment);
    for (const OdometryJump& jump : model_.jumps)
      if (jump.time > begin + kTimeRounding && jump.time <= end + kTimeRounding)
        measured = measured + jump.offset;
    pose_ = pose_ + measured;
  }

  TPose2D reading() const {
    return {rounded(pose_.x, kOdometryStep), rounded(pose_.y, kOdometryStep),
            rounded(pose_.phi, kOdometryStep)};
  }

 private:
  TPose2D withSystematicErrors(const TPose2D& increment, double end) const {
    double scale = model_.distance_scale;
    for (const WheelSlip& slip : model_.slips)
      if (end > slip.begin + kTimeRounding && end <= slip.end + kTimeRounding) scale *= slip.factor;
    return {increment.x * scale, increment.y * scale, increment.phi * model_.turn_scale};
  }

  /** Always draws three numbers, so that events do not change the noise of later steps. */
  TPose2D withNoise(const TPose2D& measured, const TPose2D& increment) {
    const double distance = std::hypot(increment.x, increment.y), turn = std::abs(increment.phi);
    const bool fixed = ++steps_ % model_.fixed_every == 0;
    const double fixed_xy = fixed ? model_.fixed_xy : 0, fixed_turn = fixed ? model_.fixed_turn : 0;
    const double sqrt_distance = std::sqrt(distance);
    const double along = std::hypot(model_.along * sqrt_distance, fixed_xy) * normal_();
    const double lateral = std::hypot(model_.lateral * sqrt_distance, fixed_xy) * normal_();
    const double rotation = std::hypot(model_.turn_by_distance * sqrt_distance,
                                       model_.turn_by_turn * std::sqrt(turn), fixed_turn) *
                            normal_();
    return {measured.x + along, measured.y + lateral, measured.phi + rotation};
  }

  const OdometryModel& model_;
  NormalGenerator normal_;
  TPose2D pose_{0, 0, 0};
  int steps_ = 0;
};

class LaserScanner {
 public:
  LaserScanner(const World& world, const LaserModel& model, uint64_t seed)
      : world_(world), model_(model), normal_(seed, kLaserStream) {}

  CObservation2DRangeScan::Ptr scanFrom(const TPose2D& robot) {
    auto scan = emptyScan();
    const TPose2D sensor = robot + model_.sensor_pose;
    const double first = model_.right_to_left ? -model_.aperture / 2 : model_.aperture / 2;
    const double step = -2 * first / (model_.beams - 1);
    for (int beam = 0; beam < model_.beams; ++beam) {
      const double range = measured(world_.raycast({sensor.x, sensor.y}, sensor.phi + first + step * beam));
      const bool valid = range < model_.max_range;
      scan->setScanRange(static_cast<std::size_t>(beam),
                         static_cast<float>(valid ? range : model_.max_range));
      scan->setScanRangeValidity(static_cast<std::size_t>(beam), valid);
    }
    return scan;
  }

 private:
  CObservation2DRangeScan::Ptr emptyScan() const {
    auto scan = CObservation2DRangeScan::Create();
    scan->sensorLabel = "LASER";
    scan->aperture = static_cast<float>(model_.aperture);
    scan->rightToLeft = model_.right_to_left;
    scan->maxRange = static_cast<float>(model_.max_range);
    scan->stdError = static_cast<float>(model_.sigma_range);
    scan->sensorPose = mrpt::poses::CPose3D(mrpt::math::TPose3D(model_.sensor_pose));
    scan->resizeScan(static_cast<std::size_t>(model_.beams));
    return scan;
  }

  double measured(double range) {
    return std::max(0.0, rounded(range + model_.sigma_range * normal_(), model_.range_step));
  }

  const World& world_;
  const LaserModel& model_;
  NormalGenerator normal_;
};

}  // namespace

SimulatedLog simulate(const World& world, const Path& path, const LaserModel& laser,
                      const OdometryModel& odometry, uint64_t seed) {
  validate(laser);
  validate(odometry);
  if (path.poses.empty()) throw ConfigError("the path to simulate is empty");
  Odometer odometer(odometry, seed);
  LaserScanner scanner(world, laser, seed);
  SimulatedLog log;
  for (std::size_t k = 0; k < path.poses.size(); ++k) {
    const double time = static_cast<double>(k) * path.period;
    if (k > 0) odometer.step(path.poses[k] - path.poses[k - 1], time - path.period, time);
    const auto stamp = stampOf(k, path.period);
    auto scan = scanner.scanFrom(path.poses[k]);
    scan->timestamp = stamp;
    log.frames.push_back({k, stamp, odometer.reading(), {std::move(scan)}});
    log.truth.push_back({stamp, path.poses[k]});
  }
  return log;
}

}  // namespace submap_slam
