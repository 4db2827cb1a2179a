#include <submap_slam/eval/gps_error.h>

#include <cstddef>

#include "table_file.h"

namespace submap_slam {

using mrpt::math::TPoint2D;

std::vector<GpsFix> readGps(const std::string& file) {
  std::vector<GpsFix> fixes;
  for (const auto& row : readTable(file, "t x y"))
    fixes.push_back({row.values[0], {row.values[1], row.values[2]}});
  return fixes;
}

std::vector<GpsFix> withoutOutliers(const std::vector<GpsFix>& fixes, double max_jump) {
  std::vector<GpsFix> kept;
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    const auto far = [&](std::size_t a, std::size_t b) {
      return (fixes[a].position - fixes[b].position).norm() > max_jump;
    };
    const bool wild = i > 0 && i + 1 < fixes.size() && far(i, i - 1) && far(i, i + 1) && !far(i - 1, i + 1);
    if (!wild) kept.push_back(fixes[i]);
  }
  return kept;
}

std::vector<PosePair> antennaPairs(const TimedTrajectory& trajectory, const std::vector<GpsFix>& fixes,
                                   const TPoint2D& antenna, double max_gap_s) {
  std::vector<PosePair> pairs;
  for (const GpsFix& fix : fixes) {
    const auto pose = trajectory.at(fix.t, TimedTrajectory::kTolerance_s, max_gap_s);
    if (!pose) continue;
    const TPoint2D at = toPose2D(*pose).composePoint(antenna);
    pairs.push_back({fix.t, {fix.position.x, fix.position.y, 0}, {at.x, at.y, 0}});
  }
  return pairs;
}

GpsError gpsError(const TimedTrajectory& trajectory, const std::vector<GpsFix>& fixes,
                  const TPoint2D& antenna, double max_gap_s) {
  const auto pairs = antennaPairs(trajectory, fixes, antenna, max_gap_s);
  return {absoluteTrajectoryError(pairs).translation_m, fixes.size() - pairs.size()};
}

}  // namespace submap_slam
