#include <submap_slam/mapping/grid_mapper.h>

#include <mrpt/math/wrap2pi.h>
#include <mrpt/poses/CPose2D.h>
#include <submap_slam/core/errors.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;

std::optional<TPose2D> incrementBetween(const Frame& a, const Frame& b) {
  if (!a.odometry || !b.odometry) return std::nullopt;
  return *b.odometry - *a.odometry;
}

/** Seed of a submap's own random stream (the finaliser of splitmix64 spreads neighbouring frame numbers). */
uint64_t streamSeed(uint64_t seed, uint64_t frame) {
  uint64_t z = seed + 0x9e3779b97f4a7c15ull * (frame + 1);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

/** Frames [warm_up, end) of a stretch of which [first, end) are the submap's own; `end` is the next submap's
 * first frame or the end of the stretch. */
struct Span {
  std::size_t warm_up = 0, first = 0, end = 0;
  bool has_successor = false;
};

/** First of the frames that prepare the matching map of a submap starting at `first`, be it in the middle of
 * a stretch. */
std::size_t warmUpBegin(const Stretch& stretch, std::size_t first) {
  constexpr std::size_t kLeast = 20;
  return first - std::min(first, std::max(stretch.warm_up, kLeast));
}

/** Watches the filter and tells when a submap should end before its stretch does. */
class ClosingRules {
 public:
  /** @param adaptive the number of particles says how undecided the filter is */
  ClosingRules(const ClosingParams& params, bool adaptive) : params_(params), adaptive_(adaptive) {}

  /** Call after each step. Returns the rule that closes the submap; empty: go on. */
  std::string check(const ParticleFilter& filter, const DriftCovariance& drift) {
    undecided_scans_ = filter.size() > 1 ? undecided_scans_ + 1 : 0;
    const auto inliers = static_cast<double>(filter.best().path.back().inlier_share);
    lost_scans_ = inliers < params_.lost_below ? lost_scans_ + 1 : 0;
    if (lost()) return "match lost";
    if (adaptive_ && undecided_scans_ >= params_.undecided_scans) return "hypotheses undecided";
    if (drift.sigmaXy() > params_.max_sigma_xy || drift.sigmaPhi() > params_.max_sigma_phi)
      return "pose uncertain";
    return {};
  }

  bool lost() const { return lost_scans_ >= params_.lost_scans; }

 private:
  ClosingParams params_;
  bool adaptive_;
  int lost_scans_ = 0, undecided_scans_ = 0;
};

/** What the filter made of a span. */
struct Filtered {
  Particle particle;
  SubmapStatistics statistics;
  bool lost = false;  ///< the last scans could not be matched
};

/** Builds one submap; lives as long as that takes. */
class SubmapBuild {
 public:
  SubmapBuild(const GridMapperParams& params, const std::vector<Frame>& frames,
              const std::vector<LaserPoints>& scans, uint64_t seed)
      : params_(params),
        frames_(frames),
        scans_(scans),
        matcher_(params.filter.matcher, params.filter.map.search_radius),
        seed_(seed) {}

  /** Filters, refines and renders; shortens `span` if a decision rule closes the submap early. */
  GridSubmap::Ptr run(Span& span) {
    Filtered filtered = filter(span);
    std::vector<TPose2D> poses = refine(span, filtered);
    return assemble(span, filtered, poses);
  }

 private:
  Filtered filter(Span& span) const;
  std::vector<TPose2D> refine(const Span& span, Filtered& filtered) const;
  GridSubmap::Ptr assemble(const Span& span, const Filtered& filtered,
                           const std::vector<TPose2D>& poses) const;
  void advance(DriftCovariance& drift, const std::vector<PathNode>& path, std::size_t k) const;
  mrpt::math::CMatrixDouble33 endCovariance(const Span& span, const Filtered& filtered) const;
  std::size_t lastFrame(const Span& span) const { return span.has_successor ? span.end : span.end - 1; }

  const GridMapperParams& params_;
  const std::vector<Frame>& frames_;
  const std::vector<LaserPoints>& scans_;
  ScanMatcher matcher_;
  uint64_t seed_;
};

Filtered SubmapBuild::filter(Span& span) const {
  ParticleFilter filter(params_.filter, streamSeed(seed_, frames_[span.first].index));
  ClosingRules rules(params_.closing, params_.filter.fixed_particles == 0);
  DriftCovariance drift(params_.drift);
  SubmapStatistics statistics;
  statistics.closed_because = span.has_successor ? "stretch ended" : "log ended";
  for (std::size_t i = span.warm_up; i <= lastFrame(span); ++i) {
    filter.step(scans_[i], i > span.warm_up ? incrementBetween(frames_[i - 1], frames_[i]) : std::nullopt);
    statistics.max_particles = std::max(statistics.max_particles, static_cast<uint32_t>(filter.size()));
    if (filter.size() > 1) ++statistics.ambiguous_scans;
    if (i <= span.first || i == lastFrame(span)) continue;
    advance(drift, filter.best().path, filter.best().path.size() - 1);
    const std::string reason = rules.check(filter, drift);
    if (reason.empty()) continue;
    statistics.closed_because = reason;
    span.end = i;
    span.has_successor = true;
  }
  statistics.rescues = filter.rescues();
  statistics.resamplings = filter.resamplings();
  return {filter.best(), statistics, rules.lost()};
}

std::vector<TPose2D> SubmapBuild::refine(const Span& span, Filtered& filtered) const {
  const Eigen::Vector3d sigma(params_.refine_sigma_xy, params_.refine_sigma_xy, params_.refine_sigma_phi);
  const Eigen::Matrix3d information = sigma.array().square().inverse().matrix().asDiagonal();
  std::vector<TPose2D> poses;
  for (std::size_t i = span.first; i <= lastFrame(span); ++i) {
    PathNode& node = filtered.particle.path[i - span.warm_up];
    if (params_.refine && !scans_[i].points.empty()) {
      const MatchResult match = matcher_.match(filtered.particle.map, scans_[i], {node.pose, information});
      node.pose = match.pose;
      node.information = match.information;
      node.inlier_share = static_cast<float>(match.inlier_share);
    }
    poses.push_back(node.pose);
  }
  // The local map frame is the first own frame's pose.
  const TPose2D origin = poses.front();
  for (auto& pose : poses) pose = pose - origin;
  return poses;
}

/** Takes the step that ends at node k of the path. */
void SubmapBuild::advance(DriftCovariance& drift, const std::vector<PathNode>& path, std::size_t k) const {
  drift.move(path[k - 1].pose, path[k].pose);
  if (!path[k].key) return;
  std::size_t last_key = k - 1;
  while (last_key > 0 && !path[last_key].key) --last_key;
  const TPose2D since = path[k].pose - path[last_key].pose;
  drift.addKeyScan(path[k].information, ParticleFilter::motionInformation(params_.filter.motion, since));
}

mrpt::math::CMatrixDouble33 SubmapBuild::endCovariance(const Span& span, const Filtered& filtered) const {
  const auto& path = filtered.particle.path;
  DriftCovariance drift(params_.drift);
  for (std::size_t i = span.first + 1; i <= lastFrame(span); ++i) advance(drift, path, i - span.warm_up);
  // The path is in the filter's frame, which the warm-up began; turn the axes into the submap's.
  const double heading = path[span.first - span.warm_up].pose.phi;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(-heading).toRotationMatrix();
  mrpt::math::CMatrixDouble33 out;
  out.asEigen() = R * drift.covariance() * R.transpose();
  if (filtered.lost) {  // nothing is known of where the next submap starts but what odometry says
    const double xy = params_.closing.max_sigma_xy, phi = params_.closing.max_sigma_phi;
    out.asEigen().diagonal() += Eigen::Vector3d(xy * xy, xy * xy, phi * phi);
  }
  return out;
}

GridSubmap::Ptr SubmapBuild::assemble(const Span& span, const Filtered& filtered,
                                      const std::vector<TPose2D>& poses) const {
  auto submap = GridSubmap::Create();
  submap->sensorLabel = "SUBMAP";
  submap->timestamp = frames_[span.first].stamp;
  submap->first_frame = frames_[span.first].index;
  submap->end_frame = submap->first_frame + (span.end - span.first);
  submap->has_successor = span.has_successor;
  submap->statistics = filtered.statistics;
  std::vector<PlacedScan> key_scans;
  double score_sum = 0;
  submap->statistics.match_score_min = 1;
  for (std::size_t i = span.first; i < span.end; ++i) {
    const PathNode& node = filtered.particle.path[i - span.warm_up];
    const TPose2D& pose = poses[i - span.first];
    const bool key = node.key || i == span.first;
    submap->nodes.push_back(
        {frames_[i].stamp, pose, frames_[i].odometry,
         key ? frames_[i].scans : std::vector<mrpt::obs::CObservation2DRangeScan::Ptr>{}});
    if (key) key_scans.push_back({&scans_[i], pose});
    score_sum += static_cast<double>(node.inlier_share);
    submap->statistics.match_score_min = std::min(submap->statistics.match_score_min, node.inlier_share);
    submap->statistics.match_score_max = std::max(submap->statistics.match_score_max, node.inlier_share);
  }
  submap->statistics.match_score_mean =
      static_cast<float>(score_sum / static_cast<double>(span.end - span.first));
  submap->end_pose.mean = mrpt::poses::CPose2D(poses.back());
  submap->end_pose.cov = endCovariance(span, filtered);
  submap->evidence = renderEvidence(key_scans, params_.evidence);
  return submap;
}

}  // namespace

RbpfGridMapper::RbpfGridMapper(const GridMapperParams& params, uint64_t seed) : params_(params), seed_(seed) {
  constexpr double kMostCells = 3.0;  // beyond, a surfel has more neighbours than it keeps
  const SurfelMapParams& map = params.filter.map;
  if (map.fit_radius > kMostCells * map.resolution * (1 + 1e-9))
    throw ConfigError("[matcher] fit_radius must not exceed three times surfel_resolution");
}

std::vector<GridSubmap::Ptr> RbpfGridMapper::map(const Stretch& stretch) const {
  const double max_range = params_.max_range > 0 ? params_.max_range : 1e9;
  std::vector<LaserPoints> scans;
  for (const auto& frame : stretch.frames) scans.push_back(toLaserPoints(frame, max_range));

  SubmapBuild build(params_, stretch.frames, scans, seed_);
  std::vector<GridSubmap::Ptr> submaps;
  const std::size_t end = stretch.warm_up + stretch.ownFrames();
  for (std::size_t first = stretch.warm_up; first < end;) {
    Span span{warmUpBegin(stretch, first), first, end, !stretch.last};
    submaps.push_back(build.run(span));
    first = span.end;
  }
  return submaps;
}

}  // namespace submap_slam
