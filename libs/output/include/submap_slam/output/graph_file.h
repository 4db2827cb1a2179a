#pragma once

#include <mrpt/poses/CPosePDFGaussian.h>
#include <submap_slam/core/joined_map.h>

#include <string>
#include <vector>

namespace submap_slam {

/** Writes submap frames and constraints as a g2o graph: `VERTEX_SE2 id x y phi`, `FIX 0`, and for each
 * accepted constraint `EDGE_SE2 from to x y phi I11 I12 I13 I22 I23 I33` with the upper triangle of the
 * information matrix (inverse covariance).
 *
 * Numbers read back to the same bits. Variances are bounded below by (1 µm)² and (1 µrad)² along the
 * principal axes, so that an exactly known relation has finite information. Throws OutputError, also for a
 * covariance that is not finite. */
void writeG2o(const std::string& file, const std::vector<mrpt::poses::CPosePDFGaussian>& frames,
              const std::vector<Constraint>& constraints);

/** Writes every constraint, accepted or not, with its reason, as a table (CSV). T_a_b and its standard
 * deviations are in the axes of frame `from`; kind is "intra" for the chain of consecutive submaps, "inter"
 * for loop closures. Throws OutputError if the file cannot be written. */
void writeConstraints(const std::string& file, const std::vector<Constraint>& constraints);

}  // namespace submap_slam
