#pragma once

#include <submap_slam/core/joined_map.h>

#include <vector>

namespace submap_slam {

/** Cell size of the global map (m): what is wanted or, if that is 0, the finest of the submaps that saw
 * something, doubled until the map has at most 20 million cells; 0 if none saw anything. Throws
 * std::invalid_argument unless there is one frame for each submap. */
double mapResolution(const GridSubmaps& submaps, const std::vector<mrpt::poses::CPosePDFGaussian>& frames,
                     double wanted);

}  // namespace submap_slam
