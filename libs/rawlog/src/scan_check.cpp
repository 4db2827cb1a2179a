#include "scan_check.h"

#include <mrpt/core/bits_math.h>
#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace submap_slam {
namespace {

const double kMaxTilt = mrpt::DEG2RAD(5.0);

/** Whether the scan plane is horizontal; that of a scanner mounted upside down (roll = π) is too. */
bool isLevel(const mrpt::math::TPose3D& pose) {
  const double roll = std::abs(mrpt::math::wrapToPi(pose.roll));
  return std::min(roll, M_PI - roll) <= kMaxTilt && std::abs(pose.pitch) <= kMaxTilt;
}

}  // namespace

bool isFinite(const mrpt::math::TPose3D& pose) {
  return std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.z) && std::isfinite(pose.yaw) &&
         std::isfinite(pose.pitch) && std::isfinite(pose.roll);
}

bool isSound(const bool& flag) {
  uint8_t byte = 0;
  std::memcpy(&byte, &flag, sizeof(byte));
  return byte <= 1;
}

ScanVerdict judge(const mrpt::obs::CObservation2DRangeScan& scan) {
  if (scan.getScanSize() == 0) return ScanVerdict::kEmpty;
  const auto pose = scan.sensorPose.asTPose();
  const double full_turn = 2 * M_PI + 1e-3;  // apertures are stored as float
  const bool sound = isSound(scan.rightToLeft) && isFinite(pose) && std::isfinite(scan.maxRange) &&
                     scan.maxRange > 0 && std::isfinite(scan.aperture) && scan.aperture > 0 &&
                     scan.aperture <= full_turn;
  if (!sound) return ScanVerdict::kBadGeometry;
  return isLevel(pose) ? ScanVerdict::kUsable : ScanVerdict::kTilted;
}

void invalidateBeams(mrpt::obs::CObservation2DRangeScan& scan, double min_range, ScannerReport& counts) {
  const std::size_t beams = scan.getScanSize();
  counts.beams_total += beams;
  for (std::size_t i = 0; i < beams; ++i) {
    const float range = scan.getScanRange(i);
    const bool broken = !std::isfinite(range) || range < 0;
    if (broken) {
      ++counts.beams_broken;
      scan.setScanRange(i, 0.0f);
    } else if (range >= scan.maxRange) {
      ++counts.beams_no_return;
    } else if (range < min_range || !scan.getScanRangeValidity(i)) {
      ++counts.beams_invalid;
    } else {
      continue;
    }
    scan.setScanRangeValidity(i, false);
  }
}

}  // namespace submap_slam
