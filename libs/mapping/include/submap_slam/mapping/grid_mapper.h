#pragma once

#include <submap_slam/core/local_mapper.h>
#include <submap_slam/core/parameters.h>
#include <submap_slam/mapping/drift_covariance.h>
#include <submap_slam/mapping/evidence_renderer.h>
#include <submap_slam/mapping/grid_scan_matcher.h>
#include <submap_slam/mapping/particle_filter.h>
#include <submap_slam/mapping/submap_tracker.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace submap_slam {

/** When the filter itself closes a submap before the stretch ends. */
struct ClosingParams {
  double lost_below = 0.25;  ///< share of inlier beams
  int lost_scans = 20;
  int undecided_scans = 300;
  double max_sigma_xy = 0.5;       ///< m
  double max_sigma_phi = 0.2;      ///< rad
  double doubtful_step_xy = 0.3;   ///< m
  double doubtful_step_phi = 0.1;  ///< rad
  bool carried = false;            ///< scans that fit nothing mean that the robot was carried
};

struct GridMapperParams {
  std::string method = "rbpf";  ///< or "scan_matching"
  FilterParams filter;
  ScanMatchingParams scan_matching;
  EvidenceParams evidence;
  ClosingParams closing;
  DriftParams drift;
  double max_range = 0;            ///< m, 0 = all that the scanner gives
  double refine_sigma_xy = 0.05;   ///< m
  double refine_sigma_phi = 0.05;  ///< rad
  bool refine = true;
};

/** Adds the sections [mapper], [matcher], [rescue], [motion], [particles], [scan_matching], [closing],
 * [drift] and [evidence]. */
void describe(ParameterTable& table, GridMapperParams& params);

/** Builds grid submaps from laser scans and odometry: what all local mappers do around their own way to
 * follow the robot.
 *
 * The warm-up frames of the stretch only prepare the matching map. When the stretch ends, every own frame and
 * the first frame of the next stretch are matched once more to the finished map; the evidence is rendered
 * from those poses.
 */
class GridMapper : public LocalMapper {
 public:
  std::vector<GridSubmap::Ptr> map(const Stretch& stretch) const final;

 protected:
  explicit GridMapper(const GridMapperParams& params) : params_(params) {}

  const GridMapperParams& params() const { return params_; }

 private:
  /** @param first_frame index in the log of the submap's first own frame */
  virtual std::unique_ptr<SubmapTracker> track(uint64_t first_frame) const = 0;

  GridMapperParams params_;
};

/** The mapper that [mapper] method names. Throws ConfigError if its parameters contradict each other. */
std::unique_ptr<LocalMapper> makeGridMapper(const GridMapperParams& params, uint64_t seed);

}  // namespace submap_slam
