#pragma once

#include <mrpt/img/TColor.h>
#include <mrpt/opengl/CTexturedPlane.h>
#include <submap_slam/core/packed_evidence.h>

namespace submap_slam {

/** Evidence as a flat picture in its own frame: unknown cells are transparent, free ones pale, occupied ones
 * in the given colour. Large grids are drawn with coarser cells, so that the picture stays below
 * kLargestPicture pixels a side; a cell is as occupied as the most occupied one in it. */
mrpt::opengl::CTexturedPlane::Ptr gridPicture(const PackedEvidence& evidence,
                                              const mrpt::img::TColor& occupied);
constexpr int kLargestPicture = 4000;

}  // namespace submap_slam
