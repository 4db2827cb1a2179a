#include <submap_slam/mapping/grid_mapper.h>

#include <mrpt/math/wrap2pi.h>
#include <mrpt/poses/CPose2D.h>
#include <submap_slam/mapping/rbpf_grid_mapper.h>
#include <submap_slam/mapping/scan_matching_mapper.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

#include "doubtful_steps.h"
#include "odometry_increment.h"

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;

/** Frames [warm_up, end) of a stretch of which [first, end) are the submap's own; `end` is the next submap's
 * first frame or the end of the stretch. */
struct Span {
  std::size_t warm_up = 0, first = 0, end = 0;
  bool has_successor = false;
  bool ends_in_doubt = false;  ///< by a doubtful step: what lies before tells nothing of the map behind
};

/** First of the frames that prepare the matching map of a submap starting at `first`, be it in the middle of
 * a stretch. */
std::size_t warmUpBegin(const Stretch& stretch, std::size_t first) {
  constexpr std::size_t kLeast = 20;
  return first - std::min(first, std::max(stretch.warm_up, kLeast));
}

/** Watches the tracker and tells when a submap should end before its stretch does. */
class ClosingRules {
 public:
  explicit ClosingRules(const ClosingParams& params) : params_(params) {}

  /** Call after each step. Returns the rule that closes the submap; empty: go on. */
  std::string check(const SubmapTracker& tracker, const DriftCovariance& drift) {
    undecided_scans_ = tracker.undecided() ? undecided_scans_ + 1 : 0;
    const auto inliers = static_cast<double>(tracker.path().back().inlier_share);
    lost_scans_ = inliers < params_.lost_below ? lost_scans_ + 1 : 0;
    if (lost()) return "match lost";
    if (undecided_scans_ >= params_.undecided_scans) return "hypotheses undecided";
    if (drift.sigmaXy() > params_.max_sigma_xy || drift.sigmaPhi() > params_.max_sigma_phi)
      return "pose uncertain";
    return {};
  }

  bool lost() const { return lost_scans_ >= params_.lost_scans; }

 private:
  ClosingParams params_;
  int lost_scans_ = 0, undecided_scans_ = 0;
};

/** What the tracker made of a span. */
struct Tracked {
  LocalPath path;  ///< in the frame of the tracker
  SubmapStatistics statistics;
  bool lost = false;  ///< the last scans could not be matched
  Eigen::Vector3d last_step_off =
      Eigen::Vector3d::Zero();  ///< what a doubtful last step may be off by (m, m, rad)
};

/** Builds one submap; lives as long as that takes. */
class SubmapBuild {
 public:
  SubmapBuild(const GridMapperParams& params, const std::vector<Frame>& frames,
              const std::vector<LaserPoints>& scans, const DoubtfulSteps& doubtful_steps,
              SubmapTracker& tracker)
      : params_(params), frames_(frames), scans_(scans), doubtful_steps_(doubtful_steps), tracker_(tracker) {}

  /** Tracks, refines and renders; shortens `span` if a decision rule closes the submap early. Empty if the
   * warm-up holds a doubtful step: it begins after that now, and wants a new tracker. */
  GridSubmap::Ptr run(Span& span) {
    std::optional<Tracked> tracked = track(span);
    if (!tracked) return {};
    if (params_.refine) refine(span, tracked->path);
    return assemble(span, *tracked);
  }

 private:
  std::optional<Tracked> track(Span& span);
  void refine(const Span& span, LocalPath& path) const;
  GridSubmap::Ptr assemble(const Span& span, const Tracked& tracked) const;
  void addScores(SubmapStatistics& statistics, const Span& span, const LocalPath& path) const;
  void advance(DriftCovariance& drift, const LocalPath& path, std::size_t k) const;
  mrpt::math::CMatrixDouble33 endCovariance(const Span& span, const Tracked& tracked) const;
  std::size_t lastFrame(const Span& span) const { return span.has_successor ? span.end : span.end - 1; }

  const GridMapperParams& params_;
  const std::vector<Frame>& frames_;
  const std::vector<LaserPoints>& scans_;
  const DoubtfulSteps& doubtful_steps_;
  SubmapTracker& tracker_;
};

std::optional<Tracked> SubmapBuild::track(Span& span) {
  ClosingRules rules(params_.closing);
  DriftCovariance drift(params_.drift);
  std::string closed_because = span.has_successor ? "stretch ended" : "log ended";
  const auto close = [&](std::size_t end, const std::string& reason) {
    span.end = end;
    span.has_successor = true;
    closed_because = reason;
  };
  Eigen::Vector3d last_step_off = Eigen::Vector3d::Zero();
  std::size_t decided = span.warm_up;  // up to this frame it is known which hypothesis is right
  for (std::size_t i = span.warm_up; i <= lastFrame(span); ++i) {
    tracker_.step(scans_[i], i > span.warm_up ? incrementBetween(frames_[i - 1], frames_[i]) : std::nullopt);
    if (i > span.first && i < lastFrame(span)) {
      advance(drift, tracker_.path(), tracker_.path().size() - 1);
      const std::string reason = rules.check(tracker_, drift);
      if (!reason.empty()) close(i, reason);
    }
    if (tracker_.undecided() && i < lastFrame(span)) continue;
    const bool last = span.has_successor && i == span.end;
    if (const auto doubtful = doubtful_steps_.find(tracker_.path(), span.warm_up, decided, i, last)) {
      if (doubtful->to <= span.first) {
        span.warm_up = doubtful->to;
        return std::nullopt;
      }
      if (doubtful->to < lastFrame(span)) close(doubtful->to, "match in doubt");
      last_step_off = doubtful->off;
      span.ends_in_doubt = true;
    }
    decided = i;
  }
  Tracked tracked{tracker_.path(), tracker_.statistics(), rules.lost(), last_step_off};
  tracked.statistics.closed_because = closed_because;
  return tracked;
}

void SubmapBuild::refine(const Span& span, LocalPath& path) const {
  for (std::size_t i = span.first; i <= lastFrame(span); ++i) {
    PathNode& node = path[i - span.warm_up];
    if (!scans_[i].points.empty()) node = tracker_.rematched(node, scans_[i]);
  }
}

/** Takes the step that ends at node k of the path. */
void SubmapBuild::advance(DriftCovariance& drift, const LocalPath& path, std::size_t k) const {
  drift.move(path[k - 1].pose, path[k].pose);
  if (!path[k].key) return;
  std::size_t last_key = k - 1;
  while (last_key > 0 && !path[last_key].key) --last_key;
  const TPose2D since = path[k].pose - path[last_key].pose;
  drift.addKeyScan(path[k].information, motionInformation(params_.filter.motion, since));
}

mrpt::math::CMatrixDouble33 SubmapBuild::endCovariance(const Span& span, const Tracked& tracked) const {
  const auto& path = tracked.path;
  DriftCovariance drift(params_.drift);
  for (std::size_t i = span.first + 1; i <= lastFrame(span); ++i) advance(drift, path, i - span.warm_up);
  // The path is in the tracker's frame, which the warm-up began; turn the axes into the submap's.
  const double heading = path[span.first - span.warm_up].pose.phi;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(-heading).toRotationMatrix();
  mrpt::math::CMatrixDouble33 out;
  out.asEigen() = R * drift.covariance() * R.transpose();
  if (tracked.lost) {  // nothing is known of where the next submap starts but what odometry says
    const double xy = params_.closing.max_sigma_xy, phi = params_.closing.max_sigma_phi;
    out.asEigen().diagonal() += Eigen::Vector3d(xy * xy, xy * xy, phi * phi);
  }
  const double off_xy2 = tracked.last_step_off.head<2>().squaredNorm(), off_phi = tracked.last_step_off.z();
  out.asEigen().diagonal() += Eigen::Vector3d(off_xy2, off_xy2, off_phi * off_phi);
  return out;
}

void SubmapBuild::addScores(SubmapStatistics& statistics, const Span& span, const LocalPath& path) const {
  double sum = 0;
  statistics.match_score_min = 1;
  for (std::size_t i = span.first; i < span.end; ++i) {
    const float share = path[i - span.warm_up].inlier_share;
    sum += static_cast<double>(share);
    statistics.match_score_min = std::min(statistics.match_score_min, share);
    statistics.match_score_max = std::max(statistics.match_score_max, share);
  }
  statistics.match_score_mean = static_cast<float>(sum / static_cast<double>(span.end - span.first));
}

GridSubmap::Ptr SubmapBuild::assemble(const Span& span, const Tracked& tracked) const {
  auto submap = GridSubmap::Create();
  submap->sensorLabel = "SUBMAP";
  submap->timestamp = frames_[span.first].stamp;
  submap->first_frame = frames_[span.first].index;
  submap->end_frame = submap->first_frame + (span.end - span.first);
  submap->has_successor = span.has_successor;
  submap->statistics = tracked.statistics;
  addScores(submap->statistics, span, tracked.path);
  // The local map frame is the first own frame's pose.
  const auto poseOf = [&](std::size_t frame) {
    return tracked.path[frame - span.warm_up].pose - tracked.path[span.first - span.warm_up].pose;
  };
  std::vector<PlacedScan> key_scans;
  for (std::size_t i = span.first; i < span.end; ++i) {
    const bool key = tracked.path[i - span.warm_up].key || i == span.first;
    submap->nodes.push_back(
        {frames_[i].stamp, poseOf(i), frames_[i].odometry, key ? frames_[i].scans : SubmapScans{}});
    if (key) key_scans.push_back({&scans_[i], poseOf(i)});
  }
  submap->end_pose.mean = mrpt::poses::CPose2D(poseOf(lastFrame(span)));
  submap->end_pose.cov = endCovariance(span, tracked);
  submap->evidence = renderEvidence(key_scans, params_.evidence);
  return submap;
}

}  // namespace

std::vector<GridSubmap::Ptr> GridMapper::map(const Stretch& stretch) const {
  const double max_range = params_.max_range > 0 ? params_.max_range : 1e9;
  std::vector<LaserPoints> scans;
  for (const auto& frame : stretch.frames) scans.push_back(toLaserPoints(frame, max_range));

  const DoubtfulSteps doubtful_steps(params_.closing, stretch.frames);
  std::vector<GridSubmap::Ptr> submaps;
  const std::size_t end = stretch.warm_up + stretch.ownFrames();
  bool after_doubt = false;
  for (std::size_t first = stretch.warm_up; first < end;) {
    Span span{after_doubt ? first : warmUpBegin(stretch, first), first, end, !stretch.last};
    GridSubmap::Ptr submap;
    while (!submap) {
      const auto tracker = track(stretch.frames[first].index);
      submap = SubmapBuild(params_, stretch.frames, scans, doubtful_steps, *tracker).run(span);
    }
    submaps.push_back(submap);
    first = span.end;
    after_doubt = span.ends_in_doubt;
  }
  return submaps;
}

std::unique_ptr<LocalMapper> makeGridMapper(const GridMapperParams& params, uint64_t seed) {
  if (params.method == "scan_matching") return std::make_unique<ScanMatchingMapper>(params);
  return std::make_unique<RbpfGridMapper>(params, seed);
}

}  // namespace submap_slam
