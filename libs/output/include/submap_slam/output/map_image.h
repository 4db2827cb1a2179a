#pragma once

#include <mrpt/poses/CPosePDFGaussian.h>
#include <submap_slam/core/joined_map.h>
#include <submap_slam/core/packed_evidence.h>

#include <string>
#include <vector>

namespace submap_slam {

/** Writes a PNG for people: free space white, occupied dark, unknown light grey; over it the trajectory (blue
 * at its start, red at its end, by time), a dot at the origin of each submap frame, and a scale bar. x points
 * right, y up.
 *
 * Only the observed part of the map is shown, 1–8 pixels per cell; if it is too large for `max_side` pixels,
 * several cells share a pixel and the most occupied one is shown. Trajectory and frames may be empty. Throws
 * OutputError.
 * @param max_side longest allowed side of the picture in pixels, at least 200 */
void writeMapImage(const std::string& file, const PackedEvidence& map, const Trajectory& trajectory,
                   const std::vector<mrpt::poses::CPosePDFGaussian>& frames, int max_side = 4000);

}  // namespace submap_slam
