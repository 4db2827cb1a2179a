#pragma once

#include <submap_slam/core/landmark_submap.h>

#include <string>

namespace submap_slam {

/** True if the file begins as a sequence of landmark submaps in either form that readLandmarkSubmaps() takes,
 * gzip or not. Text is known by its first line that is neither blank nor a comment, which must begin in the
 * first 16 kB. Throws InputError if it cannot be opened. */
bool holdsLandmarkSubmaps(const std::string& file);

/** Landmark submaps in the order of the path; ids are set to their position. The file is a rawlog of
 * LandmarkSubmap objects or text, both also as gzip. For each submap the text has
 *
 *     MAP k n        number of the submap from 1, dimension n of its state
 *     id value       n lines: x, y, φ of the end pose with id 0, then x and y of each feature with its id
 *     c …            n lines: lower triangle of the covariance, row i has i + 1 numbers
 *
 * in metres and radians, in the frame of the submap's start pose. Blank lines and comments (#) may stand
 * between submaps. Throws InputError naming file and line (for a rawlog: the entry) and what was expected. */
LandmarkSubmaps readLandmarkSubmaps(const std::string& file);

/** What can be used of a file of landmark submaps. */
struct RecoveredLandmarkSubmaps {
  LandmarkSubmaps submaps;
  std::string damage;  ///< what is wrong behind them; empty: nothing
};

/** The submaps before the first damage of a rawlog; text has to be whole. Throws InputError if there are
 * none, and as readLandmarkSubmaps(). */
RecoveredLandmarkSubmaps recoverLandmarkSubmaps(const std::string& file);

/** Writes the text that readLandmarkSubmaps() reads, packed if the name ends in `.gz`; numbers read back to
 * the same bits. The text has no place for stamps, paths and hits. Ids are raised by 1 if one is 0, which
 * marks the end pose there; where they say nothing beyond a submap, features are numbered through, so that no
 * two of them have the same. Throws OutputError. */
void writeLandmarkText(const std::string& file, const LandmarkSubmaps& submaps);

}  // namespace submap_slam
