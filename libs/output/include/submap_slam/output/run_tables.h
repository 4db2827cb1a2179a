/** Tables of a run that are read again, to look at the run. */
#pragma once

#include <mrpt/poses/CPosePDFGaussian.h>
#include <submap_slam/core/joined_map.h>

#include <string>
#include <vector>

namespace submap_slam {

constexpr const char* kFramesFile = "frames.csv";
constexpr const char* kConstraintsFile = "constraints.csv";

/** Writes the submap frames with their covariance as a table (CSV): submap, x_m, y_m, phi_rad, and the upper
 * triangle of the covariance (m², m·rad, rad²). Throws OutputError. */
void writeFrames(const std::string& file, const std::vector<mrpt::poses::CPosePDFGaussian>& frames);

/** Reads what writeFrames wrote, of grid or of landmark submaps. Throws InputError naming file and line. */
std::vector<mrpt::poses::CPosePDFGaussian> readFrames(const std::string& file);

/** Reads what writeConstraints wrote: of the covariance only the standard deviations are there. Throws
 * InputError naming file and line. */
std::vector<Constraint> readConstraints(const std::string& file);

}  // namespace submap_slam
