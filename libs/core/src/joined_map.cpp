#include <submap_slam/core/joined_map.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <utility>

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;
using mrpt::poses::CPosePDFGaussian;

void requireOneFrameEach(const GridSubmaps& submaps, const std::vector<CPosePDFGaussian>& frames) {
  if (submaps.size() != frames.size()) throw std::invalid_argument("one frame is needed for each submap");
}

/** Σ N_i L_i, Σ N_i², Σ N_i of one cell. */
struct FusionSums {
  double nl = 0, nn = 0, n = 0;
};

/** A submap in the global map frame, ready for bilinear look-ups. */
class PlacedEvidence {
 public:
  PlacedEvidence(std::shared_ptr<const PackedEvidence> evidence, const TPose2D& T_w_s)
      : evidence_(std::move(evidence)), T_w_s_(T_w_s), cos_(std::cos(T_w_s.phi)), sin_(std::sin(T_w_s.phi)) {}

  bool empty() const { return evidence_->empty(); }
  double resolution() const { return evidence_->resolution(); }

  /** Grows [x_min, x_max] × [y_min, y_max] (m, global map frame) by everything that interpolation reaches. */
  void extend(double& x_min, double& x_max, double& y_min, double& y_max) const {
    for (const double u : {-1.0, evidence_->sizeX() * 1.0})
      for (const double v : {-1.0, evidence_->sizeY() * 1.0}) {
        const double r = evidence_->resolution();
        const mrpt::math::TPoint2D corner =
            T_w_s_.composePoint({evidence_->xMin() + (u + 0.5) * r, evidence_->yMin() + (v + 0.5) * r});
        x_min = std::min(x_min, corner.x), x_max = std::max(x_max, corner.x);
        y_min = std::min(y_min, corner.y), y_max = std::max(y_max, corner.y);
      }
  }

  /** Index coordinates (cell centres are integers) of a global point (m). */
  mrpt::math::TPoint2D toIndex(double x, double y) const {
    const double dx = x - T_w_s_.x, dy = y - T_w_s_.y, r = evidence_->resolution();
    return {(cos_ * dx + sin_ * dy - evidence_->xMin()) / r - 0.5,
            (-sin_ * dx + cos_ * dy - evidence_->yMin()) / r - 0.5};
  }

  /** Those k in [0, count) for which start + k·step can reach a cell, as a half-open interval. */
  std::pair<int, int> reach(const mrpt::math::TPoint2D& start, const mrpt::math::TPoint2D& step,
                            int count) const {
    double from = 0, to = count - 1;
    clip(start.x, step.x, -1, evidence_->sizeX(), from, to);
    clip(start.y, step.y, -1, evidence_->sizeY(), from, to);
    if (from > to) return {0, 0};
    return {static_cast<int>(std::ceil(from)), static_cast<int>(std::floor(to)) + 1};
  }

  /** Adds the bilinear log-odds sum and hit count to the sums of a cell of the map; cells outside count as
   * unknown. */
  void addTo(FusionSums& sums, const mrpt::math::TPoint2D& index) const {
    const double fx = std::floor(index.x), fy = std::floor(index.y);
    const int cx = static_cast<int>(fx), cy = static_cast<int>(fy);
    if (!evidence_->mayReach(cx, cy)) return;
    const double a = index.x - fx, b = index.y - fy;
    double log_odds = 0, hits = 0;
    const auto add = [&](int x, int y, double weight) {
      const auto [l, n] = evidence_->cell(x, y);
      log_odds += weight * static_cast<double>(l);
      hits += weight * static_cast<double>(n);
    };
    add(cx, cy, (1 - a) * (1 - b));
    add(cx + 1, cy, a * (1 - b));
    add(cx, cy + 1, (1 - a) * b);
    add(cx + 1, cy + 1, a * b);
    sums.nl += hits * log_odds, sums.nn += hits * hits, sums.n += hits;
  }

 private:
  static void clip(double start, double step, double low, double high, double& from, double& to) {
    if (std::abs(step) < 1e-12) {
      if (start <= low || start >= high) to = from - 1;
      return;
    }
    const double a = (low - start) / step, b = (high - start) / step;
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }

  std::shared_ptr<const PackedEvidence> evidence_;
  TPose2D T_w_s_;
  double cos_, sin_;
};

/** Largest map that is made without being asked for: 160 MB, and as much again while it is written. */
constexpr double kMostCells = 2e7;

/** Fewer hits than this come from rounding where a look-up falls on the centre of a neighbouring cell. */
constexpr double kLeastHits = 1e-6;

void fuseRow(const std::vector<PlacedEvidence>& submaps, int row, EvidenceGrid& map) {
  const int columns = static_cast<int>(map.sizeX());
  const double x0 = map.log_odds.idx2x(0), y0 = map.log_odds.idx2y(row), r = map.resolution();
  std::vector<FusionSums> sums(map.sizeX());
  for (const PlacedEvidence& submap : submaps) {
    const auto start = submap.toIndex(x0, y0), step = submap.toIndex(x0 + r, y0) - start;
    const auto [from, to] = submap.reach(start, step, columns);
    for (int k = from; k < to; ++k) submap.addTo(sums[static_cast<std::size_t>(k)], start + step * k);
  }
  const auto offset = static_cast<std::ptrdiff_t>(row) * columns;
  for (int k = 0; k < columns; ++k) {
    const FusionSums& s = sums[static_cast<std::size_t>(k)];
    if (s.n < kLeastHits) continue;
    map.log_odds.begin()[offset + k] = static_cast<float>(s.n * s.nl / s.nn);
    map.hits.begin()[offset + k] = static_cast<float>(s.n);
  }
}

}  // namespace

const char* toString(JoinStatus status) {
  switch (status) {
    case JoinStatus::kChained:
      return "chained";
    case JoinStatus::kConverged:
      return "converged";
    case JoinStatus::kIterationLimit:
      return "iteration limit";
    case JoinStatus::kNothingToJoin:
      return "nothing to join";
    case JoinStatus::kFailed:
      return "failed";
  }
  return "unknown";
}

JoinedMap chainSubmaps(const GridSubmaps& submaps) {
  JoinedMap chain;
  CPosePDFGaussian frame;  // identity, no uncertainty
  frame.cov.setZero();
  for (std::size_t k = 0; k < submaps.size(); ++k) {
    chain.frames.push_back(frame);
    const GridSubmap& submap = *submaps[k];
    if (submap.has_successor && k + 1 < submaps.size()) {
      Constraint link;
      link.from = submap.id;
      link.to = submaps[k + 1]->id;
      link.T_a_b = submap.end_pose;
      link.reason = "end pose of the submap";
      chain.constraints.push_back(link);
    }
    frame += submap.end_pose;
  }
  return chain;
}

Trajectory trajectoryOf(const GridSubmaps& submaps, const JoinedMap& joined) {
  requireOneFrameEach(submaps, joined.frames);
  const bool moved = !joined.nodes.empty();
  if (moved && joined.nodes.size() != submaps.size())
    throw std::invalid_argument("trajectoryOf: nodes of each submap are needed");
  Trajectory trajectory;
  for (std::size_t k = 0; k < submaps.size(); ++k) {
    const auto& nodes = submaps[k]->nodes;
    if (moved && joined.nodes[k].size() != nodes.size())
      throw std::invalid_argument("trajectoryOf: one pose for each node is needed");
    const TPose2D T_w_s = joined.frames[k].mean.asTPose();
    for (std::size_t n = 0; n < nodes.size(); ++n)
      trajectory.push_back({nodes[n].stamp, T_w_s + (moved ? joined.nodes[k][n] : nodes[n].pose)});
  }
  return trajectory;
}

Trajectory odometryOf(const std::vector<Frame>& frames) {
  Trajectory trajectory;
  for (const Frame& frame : frames)
    if (frame.odometry) trajectory.push_back({frame.stamp, *frame.odometry});
  return trajectory;
}

EvidenceGrid fuseEvidence(const GridSubmaps& submaps, const std::vector<CPosePDFGaussian>& frames,
                          double resolution) {
  requireOneFrameEach(submaps, frames);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double x_min = kInfinity, x_max = -kInfinity, y_min = kInfinity, y_max = -kInfinity, finest = kInfinity;
  std::vector<PlacedEvidence> placed;
  for (std::size_t k = 0; k < submaps.size(); ++k) {
    PlacedEvidence submap(packedEvidenceOf(*submaps[k]), frames[k].mean.asTPose());
    if (submap.empty()) continue;
    submap.extend(x_min, x_max, y_min, y_max);
    finest = std::min(finest, submap.resolution());
    placed.push_back(std::move(submap));
  }
  if (placed.empty()) return {};

  while (resolution <= 0 && (x_max - x_min) * (y_max - y_min) > kMostCells * finest * finest) finest *= 2;
  EvidenceGrid map(x_min, x_max, y_min, y_max, resolution > 0 ? resolution : finest);
  tbb::parallel_for(0, static_cast<int>(map.sizeY()), [&](int row) { fuseRow(placed, row, map); });
  return map.cropped();
}

}  // namespace submap_slam
