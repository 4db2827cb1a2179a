#include <submap_slam/mapping/rbpf_grid_mapper.h>

#include <submap_slam/core/errors.h>
#include <submap_slam/core/random_stream.h>

#include <algorithm>

namespace submap_slam {
namespace {

/** The particle filter of one submap. */
class RbpfTracker : public SubmapTracker {
 public:
  RbpfTracker(const GridMapperParams& params, uint64_t seed)
      : adaptive_(params.filter.fixed_particles == 0),
        filter_(params.filter, seed),
        matcher_(params.filter.matcher, params.filter.map.search_radius) {
    const Eigen::Vector3d sigma(params.refine_sigma_xy, params.refine_sigma_xy, params.refine_sigma_phi);
    refine_information_ = sigma.array().square().inverse().matrix().asDiagonal();
  }

  void step(const LaserPoints& scan, const std::optional<mrpt::math::TPose2D>& increment) override {
    filter_.step(scan, increment);
    max_particles_ = std::max(max_particles_, static_cast<uint32_t>(filter_.size()));
    if (filter_.size() > 1) ++ambiguous_scans_;
  }

  const LocalPath& path() const override { return filter_.best().path; }

  PathNode rematched(const PathNode& node, const LaserPoints& scan) const override {
    PathNode out = node;
    out.take(matcher_.match(filter_.best().map, scan, {node.pose, refine_information_}));
    return out;
  }

  /** The classical filter always has several particles. */
  bool undecided() const override { return adaptive_ && filter_.size() > 1; }

  SubmapStatistics statistics() const override {
    SubmapStatistics out;
    out.rescues = filter_.rescues();
    out.resamplings = filter_.resamplings();
    out.max_particles = max_particles_;
    out.ambiguous_scans = ambiguous_scans_;
    return out;
  }

 private:
  bool adaptive_;
  ParticleFilter filter_;
  ScanMatcher matcher_;
  Eigen::Matrix3d refine_information_;
  uint32_t max_particles_ = 1, ambiguous_scans_ = 0;
};

}  // namespace

RbpfGridMapper::RbpfGridMapper(const GridMapperParams& params, uint64_t seed)
    : GridMapper(params), seed_(seed) {
  constexpr double kMostCells = 3.0;  // beyond, a surfel has more neighbours than it keeps
  const SurfelMapParams& map = params.filter.map;
  if (map.fit_radius > kMostCells * map.resolution * (1 + 1e-9))
    throw ConfigError("[matcher] fit_radius must not exceed three times surfel_resolution");
}

std::unique_ptr<SubmapTracker> RbpfGridMapper::track(uint64_t first_frame) const {
  return std::make_unique<RbpfTracker>(params(), streamSeed(seed_, first_frame));
}

}  // namespace submap_slam
