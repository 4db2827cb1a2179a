#pragma once

#include <submap_slam/core/packed_evidence.h>

#include <string>

namespace submap_slam {

/** Writes the map for ROS map_server: `yaml_file` and, beside it, the picture with the same name and ending
 * `.pgm`.
 *
 * Binary PGM, one pixel per cell, top row = largest y: 0 occupied (p > 0.65), 254 free (p < 0.196), 205
 * otherwise. `origin` is the lower-left corner of the grid (m). Throws OutputError. */
void writeRosMap(const std::string& yaml_file, const PackedEvidence& map);

}  // namespace submap_slam
