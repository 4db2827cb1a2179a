#pragma once

#include <submap_slam/mapping/grid_mapper.h>

#include <cstdint>
#include <memory>

namespace submap_slam {

/** Builds grid submaps with an adaptive Rao-Blackwellized particle filter. The random stream of each is
 * seeded by (seed, index of its first frame). */
class RbpfGridMapper : public GridMapper {
 public:
  /** Throws ConfigError if the parameters contradict each other. */
  RbpfGridMapper(const GridMapperParams& params, uint64_t seed);

 private:
  std::unique_ptr<SubmapTracker> track(uint64_t first_frame) const override;

  uint64_t seed_;
};

}  // namespace submap_slam
