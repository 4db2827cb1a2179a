#include <fmt/format.h>
#include <mrpt/core/bits_math.h>
#include <mrpt/math/wrap2pi.h>
#include <submap_slam/eval/trajectory_error.h>

#include <cmath>
#include <stdexcept>

namespace submap_slam {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

/** Collects the errors of single pairs. */
struct ErrorSamples {
  std::vector<double> translations_m, rotations_deg;

  /** T_want_got is the error: identity if there is none. */
  void add(const TPose2D& T_want_got) {
    translations_m.push_back(std::hypot(T_want_got.x, T_want_got.y));
    rotations_deg.push_back(mrpt::RAD2DEG(std::abs(mrpt::math::wrapToPi(T_want_got.phi))));
  }

  TrajectoryError statistics() const {
    return {errorStatistics(translations_m), errorStatistics(rotations_deg)};
  }
};

/** Σ over pairs of dot and cross products: the cosine and sine of a rotation, both times the same factor. */
struct RotationSums {
  double dot = 0, cross = 0;

  void add(const TPoint2D& from, const TPoint2D& to) {
    dot += from.x * to.x + from.y * to.y;
    cross += from.x * to.y - from.y * to.x;
  }
  double length() const { return std::hypot(dot, cross); }
  double angle() const { return std::atan2(cross, dot); }
};

TPoint2D direction(double phi) { return {std::cos(phi), std::sin(phi)}; }

double alignedHeading(const std::vector<PosePair>& pairs, const TPoint2D& reference_centre,
                      const TPoint2D& estimate_centre) {
  RotationSums by_position, by_heading;
  for (const auto& p : pairs) {
    by_position.add(TPoint2D(p.estimate) - estimate_centre, TPoint2D(p.reference) - reference_centre);
    by_heading.add(direction(p.estimate.phi), direction(p.reference.phi));
  }
  constexpr double kNoSpread = 1e-12;  // (1 µm)²
  return (by_position.length() > kNoSpread * static_cast<double>(pairs.size()) ? by_position : by_heading)
      .angle();
}

std::string tableRow(const std::string& name, const ErrorStatistics& e) {
  if (e.count == 0)  // errors of 0 would look perfect
    return fmt::format("{0:<24} {1:>7} {2:>9} {2:>9} {2:>9} {2:>9} {2:>9} {2:>9}\n", name, 0, "-");
  return fmt::format("{:<24} {:>7} {:>9.4f} {:>9.4f} {:>9.4f} {:>9.4f} {:>9.4f} {:>9.4f}\n", name, e.count,
                     e.mean, e.std, e.rmse, e.median, e.percentile_95, e.max);
}

}  // namespace

std::vector<PosePair> associate(const TimedTrajectory& reference, const TimedTrajectory& estimate,
                                double tolerance_s, double max_gap_s) {
  std::vector<PosePair> pairs;
  for (const auto& pose : reference.poses())
    if (const auto partner = estimate.at(pose.t, tolerance_s, max_gap_s))
      pairs.push_back({pose.t, toPose2D(pose.pose), toPose2D(*partner)});
  return pairs;
}

TPose2D alignSe2(const std::vector<PosePair>& pairs) {
  if (pairs.empty()) return {};
  TPoint2D reference_centre, estimate_centre;
  for (const auto& p : pairs) {
    reference_centre += TPoint2D(p.reference);
    estimate_centre += TPoint2D(p.estimate);
  }
  const double share = 1.0 / static_cast<double>(pairs.size());
  reference_centre *= share;
  estimate_centre *= share;
  const double phi = alignedHeading(pairs, reference_centre, estimate_centre);
  const TPoint2D offset = reference_centre - TPose2D(0, 0, phi).composePoint(estimate_centre);
  return {offset.x, offset.y, phi};
}

TrajectoryError absoluteTrajectoryError(const std::vector<PosePair>& pairs) {
  const TPose2D T_reference_estimate = alignSe2(pairs);
  ErrorSamples errors;
  for (const auto& p : pairs) errors.add((T_reference_estimate + p.estimate) - p.reference);
  return errors.statistics();
}

TrajectoryError relativePoseError(const std::vector<PosePair>& pairs, std::size_t delta) {
  if (delta == 0) throw std::invalid_argument("relativePoseError: delta must be at least 1");
  ErrorSamples errors;
  for (std::size_t i = 0; i + delta < pairs.size(); ++i) {
    const auto &a = pairs[i], &b = pairs[i + delta];
    errors.add((b.estimate - a.estimate) - (b.reference - a.reference));
  }
  return errors.statistics();
}

CoordinateError coordinateError(const std::vector<PosePair>& pairs) {
  std::vector<double> axes_m, headings_rad;
  for (const auto& p : pairs) {
    const TPose2D aligned = pairs[0].reference + (p.estimate - pairs[0].estimate);
    axes_m.push_back(std::abs(aligned.x - p.reference.x));
    axes_m.push_back(std::abs(aligned.y - p.reference.y));
    headings_rad.push_back(std::abs(mrpt::math::wrapToPi(aligned.phi - p.reference.phi)));
  }
  const ErrorStatistics axes = errorStatistics(axes_m), headings = errorStatistics(headings_rad);
  return {axes.mean, axes.rmse, headings.mean, headings.rmse};
}

std::string formatTable(const TrajectoryError& absolute, const TrajectoryError& relative) {
  return fmt::format("{:<24} {:>7} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}\n", "trajectory error", "pairs",
                     "mean", "std", "rmse", "median", "95 %", "max") +
         tableRow("absolute, position (m)", absolute.translation_m) +
         tableRow("absolute, heading (deg)", absolute.rotation_deg) +
         tableRow("relative, position (m)", relative.translation_m) +
         tableRow("relative, heading (deg)", relative.rotation_deg);
}

}  // namespace submap_slam
