/** Small results that the writers are tested with. */
#pragma once

#include <mrpt/core/Clock.h>
#include <submap_slam/core/joined_map.h>

#include <vector>

namespace submap_slam {

using mrpt::poses::CPosePDFGaussian;

/** A pose with covariance diag(0.04, 0.01, 0.0025). */
inline CPosePDFGaussian gaussian(double x, double y, double phi) {
  mrpt::math::CMatrixDouble33 cov;
  cov.setDiagonal(std::vector<double>{0.04, 0.01, 0.0025});
  return {mrpt::poses::CPose2D(x, y, phi), cov};
}

inline void setCell(EvidenceGrid& grid, unsigned cx, unsigned cy, float log_odds) {
  *grid.log_odds.cellByIndex(cx, cy) = log_odds;
  *grid.hits.cellByIndex(cx, cy) = 1;
}

/** 4 × 3 cells of 0.5 m with lower-left corner (-1, 2); the rows from the lowest up, from left to right:
 * occupied, free, unknown, unknown / free, free, observed but undecided, unknown / unknown, unknown,
 * occupied, free. */
inline PackedEvidence sampleGrid() {
  EvidenceGrid grid(-1, 1, 2, 3.5, 0.5);
  setCell(grid, 0, 0, 4);
  setCell(grid, 1, 0, -4);
  setCell(grid, 0, 1, -4);
  setCell(grid, 1, 1, -4);
  setCell(grid, 2, 1, 0.1f);
  setCell(grid, 2, 2, 4);
  setCell(grid, 3, 2, -4);
  return PackedEvidence(grid);
}

inline StampedPose stamped(double t, double x, double y, double phi) {
  return {mrpt::Clock::fromDouble(t), {x, y, phi}};
}

inline Trajectory sampleTrajectory() {
  return {stamped(1000, -0.75, 2.25, 0), stamped(1001, 0, 2.75, 0.5), stamped(1002, 0.75, 3.25, 1)};
}

inline std::vector<CPosePDFGaussian> sampleFrames() {
  return {gaussian(-0.75, 2.25, 0), gaussian(0.5, 3, 0.6)};
}

}  // namespace submap_slam
