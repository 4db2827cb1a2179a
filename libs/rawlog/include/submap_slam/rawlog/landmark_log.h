#pragma once

#include <submap_slam/core/landmark_submap.h>

#include <string>

namespace submap_slam {

/** True if the file begins as a sequence of landmark submaps in either form that readLandmarkSubmaps() takes,
 * gzip or not. Throws InputError if it cannot be opened. */
bool holdsLandmarkSubmaps(const std::string& file);

/** Landmark submaps in the order of the path; ids are set to their position. The file is a rawlog of
 * LandmarkSubmap objects or text, both also as gzip. For each submap the text has
 *
 *     MAP k n        number of the submap from 1, dimension n of its state
 *     id value       n lines: x, y, φ of the end pose with id 0, then x and y of each feature with its id
 *     c …            n lines: lower triangle of the covariance, row i has i + 1 numbers
 *
 * in metres and radians, in the frame of the submap's start pose. Blank lines may stand between submaps.
 * Throws InputError naming file and line (for a rawlog: the entry) and what was expected. */
LandmarkSubmaps readLandmarkSubmaps(const std::string& file);

/** Writes the text that readLandmarkSubmaps() reads, packed if the name ends in `.gz`; numbers read back to
 * the same bits. The text has no place for stamps and hits. Throws OutputError. */
void writeLandmarkText(const std::string& file, const LandmarkSubmaps& submaps);

}  // namespace submap_slam
