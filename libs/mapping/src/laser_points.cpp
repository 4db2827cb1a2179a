#include <submap_slam/mapping/laser_points.h>

#include <mrpt/poses/CPose3D.h>

#include <cmath>
#include <optional>
#include <vector>

namespace submap_slam {
namespace {

using mrpt::obs::CObservation2DRangeScan;

/** Neighbouring endpoints farther apart than this lie on different surfaces (m). */
constexpr float kMaxGap = 0.5f;
/** Both neighbours' directions must agree within this cosine for a corner not to blur the normal. */
constexpr float kMinCosine = 0.85f;
/** Two tangents closer than this cosine are one straight line. */
constexpr float kStraight = 0.995f;

/** Direction from one endpoint to the next. */
struct Tangent {
  float x = 0, y = 0;
  bool near = false;   ///< close enough to lie on one surface
  bool valid = false;  ///< lies along a surface
};

Tangent between(const LaserPoint& a, const LaserPoint& b) {
  const float dx = b.x - a.x, dy = b.y - a.y;
  const float length = std::hypot(dx, dy);
  if (length < 1e-4f) return {};
  const bool near = length <= kMaxGap;
  return {dx / length, dy / length, near, near};
}

float cosine(const Tangent& a, const Tangent& b) { return a.x * b.x + a.y * b.y; }

/** Normal from the tangents to the previous and the next endpoint, towards the scanner. */
void setNormal(LaserPoint& p, const Eigen::Vector2d& origin, const Tangent& before, const Tangent& after) {
  if (!before.valid && !after.valid) return;
  if (before.valid && after.valid && cosine(before, after) < kMinCosine) return;
  const float tx = (before.valid ? before.x : 0) + (after.valid ? after.x : 0);
  const float ty = (before.valid ? before.y : 0) + (after.valid ? after.y : 0);
  const auto to_x = static_cast<float>(origin.x()) - p.x, to_y = static_cast<float>(origin.y()) - p.y;
  // Of the normal (−ty, tx)/|t|; positive on the side of the scanner.
  const float cosine_of_incidence = (tx * to_y - ty * to_x) / (std::hypot(tx, ty) * std::hypot(to_x, to_y));
  const float scale = cosine_of_incidence / std::hypot(tx, ty);
  p.normal_x = scale * -ty;
  p.normal_y = scale * tx;
}

void setNormals(LaserPoints& out, const LaserSweep& sweep) {
  if (sweep.end - sweep.begin < 2) return;
  // Tangent k leads to endpoint begin + k; the first and the last lead nowhere.
  std::vector<Tangent> tangents(sweep.end - sweep.begin + 1);
  for (std::size_t k = 1; k + 1 < tangents.size(); ++k)
    tangents[k] = between(out.points[sweep.begin + k - 1], out.points[sweep.begin + k]);
  // Endpoints far apart lie on one surface if the tangent next to theirs goes on in the same direction: a
  // wall seen at a grazing angle.
  for (std::size_t k = 1; k + 1 < tangents.size(); ++k) {
    Tangent& t = tangents[k];
    t.valid = t.near || cosine(t, tangents[k - 1]) > kStraight || cosine(t, tangents[k + 1]) > kStraight;
  }
  for (std::size_t i = sweep.begin; i < sweep.end; ++i)
    setNormal(out.points[i], sweep.origin, tangents[i - sweep.begin], tangents[i - sweep.begin + 1]);
}

/** What the directions of the beams depend on. */
struct BeamLayout {
  std::size_t beams = 0;
  float aperture = 0;
  bool right_to_left = false;
  double yaw = 0;
  double mirror = 1;  ///< −1: a scanner mounted upside down (roll = π) sees its angles mirrored

  explicit BeamLayout(const CObservation2DRangeScan& scan)
      : beams(scan.getScanSize()),
        aperture(scan.aperture),
        right_to_left(scan.rightToLeft),
        yaw(scan.sensorPose.yaw()),
        mirror(std::cos(scan.sensorPose.roll()) < 0 ? -1.0 : 1.0) {}
  bool operator==(const BeamLayout& o) const {
    return beams == o.beams && aperture == o.aperture && right_to_left == o.right_to_left && yaw == o.yaw &&
           mirror == o.mirror;
  }
};

struct Direction {
  double cos, sin;
};

/** Of all beams, in the robot's frame. Kept for the next scan, which mostly has the same. */
const std::vector<Direction>& directionsOf(const CObservation2DRangeScan& scan) {
  thread_local std::optional<BeamLayout> known;
  thread_local std::vector<Direction> directions;
  const BeamLayout layout(scan);
  if (known && *known == layout) return directions;
  directions.clear();
  for (std::size_t i = 0; i < layout.beams; ++i) {
    const double angle = layout.yaw + layout.mirror * static_cast<double>(scan.getScanAngle(i));
    directions.push_back({std::cos(angle), std::sin(angle)});
  }
  known = layout;
  return directions;
}

void append(LaserPoints& out, const CObservation2DRangeScan& scan, double max_range) {
  LaserSweep sweep;
  sweep.origin = {scan.sensorPose.x(), scan.sensorPose.y()};
  sweep.begin = out.points.size();
  const std::vector<Direction>& directions = directionsOf(scan);
  for (std::size_t i = 0; i < scan.getScanSize(); ++i) {
    const double range = static_cast<double>(scan.getScanRange(i));
    if (!scan.getScanRangeValidity(i) || !(range > 0) || range > max_range) continue;
    LaserPoint p;
    p.x = static_cast<float>(sweep.origin.x() + range * directions[i].cos);
    p.y = static_cast<float>(sweep.origin.y() + range * directions[i].sin);
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
