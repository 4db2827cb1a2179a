#pragma once

#include <submap_slam/core/submap_joiner.h>

#include "coarse_to_fine.h"

namespace submap_slam {

/** Makes submap frames and global occupancy map jointly optimal.
 *
 * Pose-only Gauss-Newton of Wang, Zhao, Huang, "Grid-based Submap Joining" (2025), eq. (4)–(15), on a
 * pyramid, with a prior from the submaps' end poses. Starts from the frames it is given, which must be
 * roughly right (about 2 m and 5°).
 */
class GridGaussNewton : public SubmapJoiner {
  DEFINE_MRPT_OBJECT(GridGaussNewton, submap_slam)

 public:
  std::string name() const override { return "grid_gauss_newton"; }
  std::string description() const override {
    return "pose-only Gauss-Newton over submap frames and global occupancy map";
  }
  void describe(ParameterTable& table) override;
  void validate() const override;

  /** Throws InputError if the submaps' cells differ by anything else than powers of two. */
  JoinedMap join(const GridSubmaps& submaps, const JoinedMap& initial,
                 const ProgressCallback& progress) const override;

 private:
  grid_joining::CoarseToFineOptions options() const;

  /** finest_level, or the next coarser one where the evidence has at most max_cells cells. */
  int finestLevel(const GridSubmaps& submaps, const std::vector<int>& halvings) const;

  std::string solver_ = "pose_only", jacobian_ = "variable_projection", coarse_jacobian_ = "surface";
  int levels_ = 5, finest_level_ = 0, max_iterations_ = 40;
  double step_tolerance_ = 2e-4, turn_tolerance_ = 1e-5, cost_tolerance_ = 2e-4;
  double max_cells_ = 1e7;
  double prior_weight_ = 10, correlation_length_ = 1, lattice_angle_ = 0.41;
};

}  // namespace submap_slam
