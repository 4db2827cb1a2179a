#pragma once

#include <submap_slam/core/joined_map.h>
#include <submap_slam/mapping/grid_mapper.h>

#include <optional>

namespace submap_slam {

/** The global map drawn from the scans that the submaps keep, each where joining put it. These are the scans
 * that the submaps' evidence was drawn from; fuseEvidence has to interpolate in it between the cells of
 * turned lattices, which takes cells from walls, while here each beam is drawn once and into the cells of the
 * map.
 *
 * The beams are drawn with the parameters of `mapper`, and the scans of few submaps are in memory at a time.
 * The same for any number of threads.
 * @param resolution m per cell; 0: as mapResolution() says
 * @return nothing if a submap with evidence keeps no scan, or if `mapper` does not draw the scans of the
 * first one as its evidence was drawn: whoever made the submaps had other parameters, in a file that keeps
 * evidence alone. Throws std::invalid_argument if frames or nodes are not as many as those of the submaps. */
std::optional<PackedEvidence> mapFromScans(const GridSubmaps& submaps, const JoinedMap& joined,
                                           const GridMapperParams& mapper, double resolution);

}  // namespace submap_slam
