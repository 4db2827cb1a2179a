#include <submap_slam/simulation/sensors.h>

#include <cmath>

#include "require.h"

namespace submap_slam {

OdometryModel OdometryModel::perfect() {
  OdometryModel model;
  model.along = model.lateral = model.turn_by_distance = model.turn_by_turn = model.fixed_xy =
      model.fixed_turn = 0;
  return model;
}

void validate(const LaserModel& laser) {
  require(laser.beams >= 2, "beams", "at least 2");
  require(laser.aperture > 0 && laser.aperture < 6.2832, "aperture", "in (0, 2π] rad");
  require(laser.max_range > 0 && std::isfinite(laser.max_range), "max_range", "positive");
  requireNotNegative(laser.sigma_range, "sigma_range");
  requireNotNegative(laser.range_step, "range_step");
}

void validate(const OdometryModel& odometry) {
  requireNotNegative(odometry.along, "along");
  requireNotNegative(odometry.lateral, "lateral");
  requireNotNegative(odometry.turn_by_distance, "turn_by_distance");
  requireNotNegative(odometry.turn_by_turn, "turn_by_turn");
  requireNotNegative(odometry.fixed_xy, "fixed_xy");
  requireNotNegative(odometry.fixed_turn, "fixed_turn");
  require(odometry.fixed_every >= 1, "fixed_every", "at least 1");
  require(std::isfinite(odometry.distance_scale), "distance_scale", "finite");
  require(std::isfinite(odometry.turn_scale), "turn_scale", "finite");
  for (const WheelSlip& slip : odometry.slips)
    require(slip.begin < slip.end, "slips", "intervals with begin < end");
}

}  // namespace submap_slam
