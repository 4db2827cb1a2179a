#include <submap_slam/landmarks/landmark_filter.h>

#include <algorithm>
#include <cmath>

#include "ekf_filter.h"
#include "rbpf_filter.h"

namespace submap_slam::landmark_mapping {
namespace {

/** Of a sensor that nobody says it of: m, m per m of range, rad. */
constexpr double kUsualRange = 0.1, kUsualRangePerM = 0.01, kUsualBearing = M_PI / 180;

Eigen::Matrix2d noiseOf(const LandmarkScan& scan, double range, const LandmarkSensorParams& params) {
  double along = scan.sigma_range > 0 ? scan.sigma_range : kUsualRange + kUsualRangePerM * range;
  if (params.sigma_range > 0) along = params.sigma_range + params.sigma_range_per_m * range;
  double across = scan.sigma_bearing > 0 ? scan.sigma_bearing : kUsualBearing;
  if (params.sigma_bearing > 0) across = params.sigma_bearing;
  return Eigen::Vector2d(along * along, across * across).asDiagonal();
}

bool isUsable(const LandmarkMeasurement& m, const LandmarkScan& scan, bool known_ids) {
  if (!std::isfinite(m.range) || !std::isfinite(m.bearing) || m.range <= 0) return false;
  if (!known_ids || !m.id) return true;
  const auto same = [&m](const LandmarkMeasurement& other) { return other.id == m.id; };
  return std::count_if(scan.measurements.begin(), scan.measurements.end(), same) == 1;
}

}  // namespace

MeasuredScan usableMeasurements(const LandmarkScan& scan, const LandmarkMapperParams& params,
                                uint32_t& measurements_so_far) {
  MeasuredScan out{toPose(scan.T_robot_sensor), scan.max_range, scan.field_of_view, {}};
  const bool known_ids = params.association.known_ids;
  for (const auto& m : scan.measurements) {
    ++measurements_so_far;
    if (!isUsable(m, scan, known_ids)) continue;
    Measurement measurement;
    measurement.value = {{m.range, m.bearing}, noiseOf(scan, m.range, params.sensor)};
    if (known_ids) measurement.known_id = m.id;
    measurement.index = measurements_so_far;
    out.measurements.push_back(measurement);
  }
  return out;
}

std::unique_ptr<LandmarkFilter> makeLandmarkFilter(const LandmarkMapperParams& params, uint64_t seed) {
  if (params.method == "ekf") return std::make_unique<EkfFilter>(params);
  return std::make_unique<RbpfFilter>(params, seed);
}

}  // namespace submap_slam::landmark_mapping
