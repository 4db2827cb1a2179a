#pragma once

#include <submap_slam/core/local_mapper.h>
#include <submap_slam/core/parameters.h>
#include <submap_slam/mapping/drift_covariance.h>
#include <submap_slam/mapping/evidence_renderer.h>
#include <submap_slam/mapping/particle_filter.h>

#include <cstdint>
#include <vector>

namespace submap_slam {

/** When the filter itself closes a submap before the stretch ends. */
struct ClosingParams {
  double lost_below = 0.25;  ///< share of inlier beams
  int lost_scans = 20;
  int undecided_scans = 300;
  double max_sigma_xy = 0.5;   ///< m
  double max_sigma_phi = 0.2;  ///< rad
};

struct GridMapperParams {
  FilterParams filter;
  EvidenceParams evidence;
  ClosingParams closing;
  DriftParams drift;
  double max_range = 0;            ///< m, 0 = all that the scanner gives
  double refine_sigma_xy = 0.05;   ///< m
  double refine_sigma_phi = 0.05;  ///< rad
  bool refine = true;
};

/** Adds the sections [mapper], [matcher], [rescue], [motion], [particles], [closing], [drift] and [evidence].
 */
void describe(ParameterTable& table, GridMapperParams& params);

/** Builds grid submaps from laser scans and odometry with an adaptive Rao-Blackwellized particle filter.
 *
 * The warm-up frames of the stretch only prepare the matching map. When the stretch ends, every own frame and
 * the first frame of the next stretch are matched once more to the finished map; the evidence is rendered
 * from those poses. The random stream is seeded by (seed, index of the first frame).
 */
class RbpfGridMapper : public LocalMapper {
 public:
  RbpfGridMapper(const GridMapperParams& params, uint64_t seed);

  std::vector<GridSubmap::Ptr> map(const Stretch& stretch) const override;

 private:
  GridMapperParams params_;
  uint64_t seed_;
};

}  // namespace submap_slam
