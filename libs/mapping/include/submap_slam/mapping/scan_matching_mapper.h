#pragma once

#include <submap_slam/mapping/grid_mapper.h>

#include <cstdint>
#include <memory>

namespace submap_slam {

/** Builds grid submaps with one hypothesis: each scan is matched to a probability grid of the submap, see
 * GridScanMatcher and ProbabilityGrid (front end of Huang et al. 2024). */
class ScanMatchingMapper : public GridMapper {
 public:
  explicit ScanMatchingMapper(const GridMapperParams& params) : GridMapper(params) {}

 private:
  std::unique_ptr<SubmapTracker> track(uint64_t first_frame) const override;
};

}  // namespace submap_slam
