#include <submap_slam/mapping/grid_mapper.h>

#include <mrpt/math/wrap2pi.h>
#include <mrpt/poses/CPose2D.h>
#include <Eigen/LU>

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

/** What the filter made of a span. */
struct Filtered {
  Particle particle;
  SubmapStatistics statistics;
  std::size_t processed = 0;  ///< frames from Span::warm_up on
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
  mrpt::math::CMatrixDouble33 endCovariance(const Span& span, const Filtered& filtered,
                                            const std::vector<TPose2D>& poses) const;
  std::size_t lastFrame(const Span& span) const { return span.has_successor ? span.end : span.end - 1; }

  const GridMapperParams& params_;
  const std::vector<Frame>& frames_;
  const std::vector<LaserPoints>& scans_;
  ScanMatcher matcher_;
  uint64_t seed_;
};

Filtered SubmapBuild::filter(Span& span) const {
  ParticleFilter filter(params_.filter, streamSeed(seed_, frames_[span.first].index));
  SubmapStatistics statistics;
  statistics.closed_because = span.has_successor ? "stretch ended" : "log ended";
  int lost = 0, undecided = 0;
  for (std::size_t i = span.warm_up; i <= lastFrame(span); ++i) {
    filter.step(scans_[i], i > span.warm_up ? incrementBetween(frames_[i - 1], frames_[i]) : std::nullopt);
    statistics.max_particles = std::max(statistics.max_particles, static_cast<uint32_t>(filter.size()));
    if (filter.size() > 1) ++statistics.ambiguous_scans;
    undecided = filter.size() > 1 ? undecided + 1 : 0;
    lost = static_cast<double>(filter.best().path.back().inlier_share) < params_.closing.lost_below ? lost + 1
                                                                                                    : 0;
    const bool is_lost = lost >= params_.closing.lost_scans;
    const bool is_undecided =
        params_.filter.fixed_particles == 0 && undecided >= params_.closing.undecided_scans;
    if ((is_lost || is_undecided) && i > span.first && i < lastFrame(span)) {
      statistics.closed_because = is_lost ? "match lost" : "hypotheses undecided";
      span.end = i;
      span.has_successor = true;
    }
  }
  statistics.rescues = filter.rescues();
  statistics.resamplings = filter.resamplings();
  return {filter.best(), statistics, lastFrame(span) + 1 - span.warm_up};
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
      node.inlier_share = static_cast<float>(match.inlier_share);
    }
    poses.push_back(node.pose);
  }
  // The local map frame is the first own frame's pose.
  const TPose2D origin = poses.front();
  for (auto& pose : poses) pose = pose - origin;
  return poses;
}

mrpt::math::CMatrixDouble33 SubmapBuild::endCovariance(const Span& span, const Filtered& filtered,
                                                       const std::vector<TPose2D>& poses) const {
  const TPose2D& end = poses.back();
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  double path = 0;
  for (std::size_t i = span.first + 1; i <= lastFrame(span); ++i) {
    const PathNode& node = filtered.particle.path[i - span.warm_up];
    const TPose2D &before = poses[i - span.first - 1], &here = poses[i - span.first];
    path += std::hypot(here.x - before.x, here.y - before.y);
    if (!node.key) continue;
    const auto evaluation = matcher_.evaluate(filtered.particle.map, scans_[i], node.pose);
    const Eigen::Matrix3d prior = ParticleFilter::motionInformation(params_.filter.motion, here - before);
    const Eigen::Matrix3d covariance = (evaluation.hessian + prior).inverse();
    // A small turn at `here` moves the end by the lever arm.
    Eigen::Matrix3d J = Eigen::Matrix3d::Identity();
    J(0, 2) = -(end.y - here.y);
    J(1, 2) = end.x - here.x;
    sum += J * covariance * J.transpose();
  }
  const double k = params_.drift.inflation * params_.drift.inflation;
  const double xy = params_.drift.sigma_xy_per_m, phi = params_.drift.sigma_phi_per_m;
  const Eigen::Vector3d floor = Eigen::Vector3d(xy * xy, xy * xy, phi * phi) * std::max(path, 0.1);
  mrpt::math::CMatrixDouble33 out;
  out.asEigen() = k * sum + Eigen::Matrix3d(floor.asDiagonal());
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
  submap->end_pose.cov = endCovariance(span, filtered, poses);
  submap->evidence = renderEvidence(key_scans, params_.evidence);
  return submap;
}

}  // namespace

RbpfGridMapper::RbpfGridMapper(const GridMapperParams& params, uint64_t seed)
    : params_(params), seed_(seed) {}

std::vector<GridSubmap::Ptr> RbpfGridMapper::map(const Stretch& stretch) const {
  const double max_range = params_.max_range > 0 ? params_.max_range : 1e9;
  std::vector<LaserPoints> scans;
  for (const auto& frame : stretch.frames) scans.push_back(toLaserPoints(frame, max_range));

  SubmapBuild build(params_, stretch.frames, scans, seed_);
  std::vector<GridSubmap::Ptr> submaps;
  const std::size_t end = stretch.warm_up + stretch.ownFrames();
  for (std::size_t first = stretch.warm_up; first < end;) {
    const std::size_t warm_up = first > stretch.warm_up ? first - std::min(first, stretch.warm_up) : 0;
    Span span{submaps.empty() ? 0 : std::max(warm_up, first - std::min<std::size_t>(first, 20)), first, end,
              !stretch.last};
    submaps.push_back(build.run(span));
    first = span.end;
  }
  return submaps;
}

}  // namespace submap_slam
