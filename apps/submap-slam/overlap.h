#pragma once

#include <mrpt/poses/CPosePDFGaussian.h>
#include <submap_slam/core/joined_map.h>

#include <vector>

namespace submap_slam {

/** Share of the observed cells of each submap, [0, 1], that another submap saw too (to the nearest cell).
 * @param frames T_w_s, one for each submap */
std::vector<double> overlapShares(const GridSubmaps& submaps,
                                  const std::vector<mrpt::poses::CPosePDFGaussian>& frames);

}  // namespace submap_slam
