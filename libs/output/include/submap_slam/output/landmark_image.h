#pragma once

#include <submap_slam/core/joined_landmarks.h>

#include <string>

namespace submap_slam {

/** Writes a PNG for people: landmarks as dots with their 3-sigma ellipses, the path from the first
 * frame on (blue at its start, red at its end), and a scale bar. x points right, y up. Throws OutputError.
 * @param max_side longest side of the picture in pixels, at least 200 */
void writeLandmarkImage(const std::string& file, const JoinedLandmarks& joined, const Trajectory& path,
                        int max_side = 1600);

}  // namespace submap_slam
