#include <submap_slam/landmarks/landmark_mapper.h>

#include <mrpt/math/TPose2D.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/core/random_stream.h>
#include <submap_slam/landmarks/landmark_filter.h>

#include <algorithm>
#include <cmath>

#include "odometry_steps.h"

namespace submap_slam {
namespace {

using namespace landmark_mapping;
using mrpt::math::TPose2D;

/** When the filter itself closes a submap. */
class ClosingRules {
 public:
  explicit ClosingRules(const LandmarkClosingParams& params) : params_(params) {}

  void move(const MotionStep& step) { distance_ += step.increment.head<2>().norm(); }

  void note(const MeasuredScan& scan) {
    for (const Measurement& m : scan.measurements) {
      sigma_range_ = std::sqrt(m.value.noise(0, 0));
      sigma_bearing_ = std::sqrt(m.value.noise(1, 1));
    }
  }

  /** After each scan. */
  bool close(const LandmarkFilter& filter) {
    depleted_ = filter.depleted() ? depleted_ + 1 : 0;
    if (distance_ < params_.min_distance) return false;
    if (filter.features() >= static_cast<std::size_t>(params_.max_features)) return true;
    if (depleted_ >= params_.depleted_scans) return true;
    const Eigen::Vector3d sigma = filter.poseCovariance().diagonal().cwiseSqrt();
    return std::max({sigma[0] / sigma_range_, sigma[1] / sigma_range_, sigma[2] / sigma_bearing_}) >
           params_.max_pose_sigma;
  }

 private:
  LandmarkClosingParams params_;
  double sigma_range_ = 0.1, sigma_bearing_ = 0.02;  // until the sensor has seen something (m, rad)
  double distance_ = 0;
  int depleted_ = 0;
};

/** Frames [first, last] of a submap; the last one's scans belong to it only if the log ends there. */
struct Span {
  std::size_t first = 0, last = 0;
  bool has_successor = false;
};

/** Runs the filter over a span, which it shortens if a rule closes the submap. */
LandmarkEstimate track(const std::vector<Frame>& frames, const LandmarkMapperParams& params, uint64_t seed,
                       bool rules_apply, Span& span) {
  const auto filter = makeLandmarkFilter(params, streamSeed(seed, frames[span.first].index));
  OdometrySteps steps(params.motion);
  ClosingRules rules(params.closing);
  uint32_t measurements = 0;
  bool close = false;
  for (std::size_t i = span.first; i <= span.last; ++i) {
    if (i > span.first) {
      const MotionStep step = steps.between(frames[i - 1], frames[i]);
      filter->predict(step);
      rules.move(step);
    }
    if (close && i < span.last) span.last = i, span.has_successor = true;
    if (i == span.last && span.has_successor) break;
    for (const LandmarkScan& scan : frames[i].landmark_scans) {
      const MeasuredScan measured = usableMeasurements(scan, params, measurements);
      filter->observe(measured);
      rules.note(measured);
    }
    close = rules_apply && rules.close(*filter);
  }
  return filter->estimate();
}

/** That no measurement lacks one: a submap that saw nothing does not make those of the others useless. */
bool idsAreKnown(const std::vector<Frame>& frames, const Span& span) {
  for (std::size_t i = span.first; i < span.last + (span.has_successor ? 0 : 1); ++i)
    for (const LandmarkScan& scan : frames[i].landmark_scans)
      for (const LandmarkMeasurement& m : scan.measurements)
        if (!m.id) return false;
  return true;
}

TPose2D toTPose(const Pose& pose) { return {pose[0], pose[1], wrapped(pose[2])}; }

LandmarkSubmap::Ptr assemble(const std::vector<Frame>& frames, const Span& span,
                             const LandmarkEstimate& estimate, bool known_ids) {
  auto submap = LandmarkSubmap::Create();
  submap->sensorLabel = "SUBMAP";
  submap->timestamp = frames[span.first].stamp;
  submap->end_stamp = frames[span.last].stamp;
  submap->end_pose = toTPose(estimate.pose);
  submap->features = estimate.features;
  submap->covariance = mrpt::math::CMatrixDouble(estimate.covariance);
  submap->ids_known = known_ids;
  const std::size_t own = span.last - span.first + (span.has_successor ? 0 : 1);
  for (std::size_t i = 0; i < own; ++i)
    submap->nodes.push_back({frames[span.first + i].stamp, toTPose(estimate.path[i])});
  submap->covariance = flooredCovariance(*submap);
  return submap;
}

LandmarkSubmap::Ptr build(const std::vector<Frame>& frames, const LandmarkMapperParams& params, uint64_t seed,
                          bool rules_apply, Span& span) {
  const LandmarkEstimate estimate = track(frames, params, seed, rules_apply, span);
  return assemble(frames, span, estimate, params.association.known_ids && idsAreKnown(frames, span));
}

}  // namespace

LandmarkMapper::LandmarkMapper(const LandmarkMapperParams& params, uint64_t seed)
    : params_(params), seed_(seed) {
  if (params.association.new_gate < params.association.match_gate)
    throw ConfigError("[landmark_mapper] new_gate must not be less than match_gate");
}

LandmarkSubmaps LandmarkMapper::map(const Stretch& stretch) const {
  LandmarkSubmaps submaps;
  const std::size_t last = stretch.frames.size() - 1;
  for (std::size_t first = stretch.warm_up;;) {
    Span span{first, last, !stretch.last};
    submaps.push_back(build(stretch.frames, params_, seed_, !params_.single_map, span));
    first = span.last;
    if (span.last == last) return submaps;  // its scans are done, or are those of the next stretch
  }
}

Stretch LandmarkMapper::withCorrectedOdometry(const Stretch& stretch) const {
  const auto hasOdometry = [](const Frame& frame) { return frame.odometry.has_value(); };
  if (std::none_of(stretch.frames.begin(), stretch.frames.end(), hasOdometry)) return stretch;
  Stretch corrected = stretch;
  corrected.warm_up = 0;
  std::vector<TPose2D> path;  // T_odom_robot of all frames, the first at the origin
  TPose2D T_odom_s;
  for (const auto& submap : map(corrected)) {
    for (const LandmarkNode& node : submap->nodes) path.push_back(T_odom_s + node.pose);
    T_odom_s = T_odom_s + submap->end_pose;
  }
  path.push_back(T_odom_s);  // of the frame that the next stretch begins with
  for (std::size_t i = 0; i < corrected.frames.size(); ++i)
    if (auto& odometry = corrected.frames[i].odometry) odometry = path[i];
  corrected.warm_up = stretch.warm_up;
  return corrected;
}

LandmarkSubmaps LandmarkMapper::mapBeside(const std::vector<GridSubmap::Ptr>& grids,
                                          const Stretch& stretch) const {
  LandmarkSubmaps submaps;
  std::size_t first = stretch.warm_up;
  for (const auto& grid : grids) {
    const std::size_t next = first + grid->nodes.size();
    Span span{first, grid->has_successor ? next : next - 1, grid->has_successor};
    submaps.push_back(build(stretch.frames, params_, seed_, false, span));
    first = next;
  }
  return submaps;
}

}  // namespace submap_slam
