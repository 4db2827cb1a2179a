#pragma once

#include <submap_slam/core/landmark_submap.h>
#include <submap_slam/core/local_mapper.h>
#include <submap_slam/landmarks/landmark_mapper_params.h>

#include <cstdint>

namespace submap_slam {

/** Builds landmark submaps from measured landmarks and odometry (Combined SLAM). Holds no state between
 * stretches: they can be mapped in any order and by any number of threads with the same result.
 *
 * A submap begins with its first frame's measurements and ends at the pose where the next submap's first
 * frame was taken, so that no measurement is in two of them.
 */
class LandmarkMapper {
 public:
  /** Throws ConfigError if the parameters contradict each other. */
  LandmarkMapper(const LandmarkMapperParams& params, uint64_t seed);

  /** The submaps of a stretch, one or more; ids are left 0. The warm-up is not looked at. The random stream
   * of each submap is seeded by (seed, index of its first frame). */
  LandmarkSubmaps map(const Stretch& stretch) const;

  /** The stretch with better odometry: where it has any, the path that odometry and landmarks give together,
   * over all frames, the warm-up too. */
  Stretch withCorrectedOdometry(const Stretch& stretch) const;

  /** Submaps of the same frames as the grid submaps of the stretch, one for each, which begin and end at the
   * same poses. No rule closes one before. */
  LandmarkSubmaps mapBeside(const std::vector<GridSubmap::Ptr>& grids, const Stretch& stretch) const;

 private:
  LandmarkMapperParams params_;
  uint64_t seed_;
};

}  // namespace submap_slam
