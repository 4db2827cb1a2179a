#include <submap_slam/mapping/laser_points.h>

#include <mrpt/poses/CPose3D.h>

#include <cmath>

namespace submap_slam {
namespace {

using mrpt::obs::CObservation2DRangeScan;

/** Neighbouring endpoints farther apart than this lie on different surfaces (m). */
constexpr float kMaxGap = 0.5f;
/** Both neighbours' directions must agree within this cosine for a corner not to blur the normal. */
constexpr float kMinCosine = 0.85f;

struct Direction {
  float x = 0, y = 0;
  bool valid = false;
};

Direction between(const LaserPoint& a, const LaserPoint& b) {
  const float dx = b.x - a.x, dy = b.y - a.y;
  const float length = std::hypot(dx, dy);
  if (length < 1e-4f || length > kMaxGap) return {};
  return {dx / length, dy / length, true};
}

/** Double-angle normal from the tangents to the previous and the next endpoint. */
void setNormal(LaserPoint& p, const Direction& before, const Direction& after) {
  if (!before.valid && !after.valid) return;
  if (before.valid && after.valid && before.x * after.x + before.y * after.y < kMinCosine) return;
  const float tx = before.x + after.x, ty = before.y + after.y;
  const float norm2 = tx * tx + ty * ty;
  // Normal (−ty, tx): cos 2α = (ty² − tx²)/|t|², sin 2α = −2 tx ty/|t|².
  p.normal_cos2 = (ty * ty - tx * tx) / norm2;
  p.normal_sin2 = -2 * tx * ty / norm2;
}

void setNormals(LaserPoints& out, const LaserSweep& sweep) {
  Direction before;
  for (std::size_t i = sweep.begin; i < sweep.end; ++i) {
    const Direction after = i + 1 < sweep.end ? between(out.points[i], out.points[i + 1]) : Direction{};
    setNormal(out.points[i], before, after);
    before = after;
  }
}

void append(LaserPoints& out, const CObservation2DRangeScan& scan, double max_range) {
  LaserSweep sweep;
  sweep.origin = {scan.sensorPose.x(), scan.sensorPose.y()};
  sweep.begin = out.points.size();
  const double yaw = scan.sensorPose.yaw();
  // A scanner mounted upside down (roll = π) sees its angles mirrored.
  const double mirror = std::cos(scan.sensorPose.roll()) < 0 ? -1.0 : 1.0;
  for (std::size_t i = 0; i < scan.getScanSize(); ++i) {
    const double range = static_cast<double>(scan.getScanRange(i));
    if (!scan.getScanRangeValidity(i) || !(range > 0) || range > max_range) continue;
    const double angle = yaw + mirror * static_cast<double>(scan.getScanAngle(i));
    LaserPoint p;
    p.x = static_cast<float>(sweep.origin.x() + range * std::cos(angle));
    p.y = static_cast<float>(sweep.origin.y() + range * std::sin(angle));
    out.points.push_back(p);
  }
  sweep.end = out.points.size();
  setNormals(out, sweep);
  out.sweeps.push_back(sweep);
}

}  // namespace

LaserPoints toLaserPoints(const Frame& frame, double max_range) {
  LaserPoints out;
  for (const auto& scan : frame.scans) append(out, *scan, max_range);
  return out;
}

}  // namespace submap_slam
