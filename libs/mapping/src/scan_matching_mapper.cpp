#include <submap_slam/mapping/scan_matching_mapper.h>

#include <mrpt/poses/CPose2D.h>

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;

/** Robots like to drive along walls. The grid is turned against the first heading, so that walls cross its
 * rows at all fractions of a cell, and what a cell's width hides averages out (rad). */
constexpr double kLatticeAngle = 0.41;

/** Where odometry is missing, the prediction is no more than a guess. */
ScanMatchingParams weakened(ScanMatchingParams params) {
  constexpr double kShare = 0.1;
  params.translation_weight *= kShare;
  params.rotation_weight *= kShare;
  return params;
}

/** Path and probability grid of one submap. */
class ScanMatchingTracker : public SubmapTracker {
 public:
  explicit ScanMatchingTracker(const GridMapperParams& params)
      : keys_(params.filter.keys),
        max_range_(params.evidence.max_range),
        always_search_(params.scan_matching.correlative_search),
        matcher_(params.scan_matching),
        guess_matcher_(weakened(params.scan_matching)),
        grid_(params.scan_matching.grid) {}

  void step(const LaserPoints& scan, const std::optional<TPose2D>& increment) override {
    PathNode node = predicted(increment);
    if (!scan.points.empty()) {
      const GridScanMatcher& matcher = increment ? matcher_ : guess_matcher_;
      if (!grid_.empty()) node.take(matcher.match(grid_, scan, node.pose, always_search_ || !increment));
      node.key = isKeyPose(path_, node.pose, keys_);
    }
    if (node.key) grid_.insert(scan, node.pose, max_range_);
    path_.push_back(node);
  }

  const LocalPath& path() const override { return path_; }

  PathNode rematched(const PathNode& node, const LaserPoints& scan) const override {
    PathNode out = node;
    out.take(matcher_.match(grid_, scan, node.pose, false));
    return out;
  }

  bool undecided() const override { return false; }

  SubmapStatistics statistics() const override { return {}; }

 private:
  /** Where odometry, or without it the last motion, says that the robot is; the scan has no say yet. */
  PathNode predicted(const std::optional<TPose2D>& increment) const {
    PathNode node;
    node.pose.phi = kLatticeAngle;
    if (path_.empty()) return node;
    node.pose = path_.back().pose + increment.value_or(lastIncrement(path_));
    node.inlier_share = path_.back().inlier_share;
    return node;
  }

  KeyParams keys_;
  double max_range_;  ///< m
  bool always_search_;
  GridScanMatcher matcher_, guess_matcher_;
  ProbabilityGrid grid_;
  LocalPath path_;
};

}  // namespace

std::unique_ptr<SubmapTracker> ScanMatchingMapper::track(uint64_t) const {
  return std::make_unique<ScanMatchingTracker>(params());
}

}  // namespace submap_slam
