#pragma once

#include <functional>
#include <optional>

#include "gauss_newton.h"
#include "known_association.h"
#include "sequential_filter.h"

namespace submap_slam::landmark_joining {

struct AssociationOptions {
  bool joint_search = false;   ///< branch and bound; false: nearest neighbours
  double match_gate = 9.21;    ///< largest squared distance of a match (χ², 2 degrees of freedom: 99 %)
  double new_gate = 13.8;      ///< a feature farther from every landmark is a new one (99.9 %)
  double search_margin_m = 5;  ///< landmarks this far from a feature are looked at
  bool merge = true;           ///< landmarks that turn out to be one
};

/** The association of a sequence whose ids are ignored, and the state that it was found with. */
struct UnknownAssociation {
  AssociatedProblem associated;
  JointState state;
  std::size_t associated_submaps = 0;  ///< fewer than all if stopped
};

/** Associates submap by submap while they are joined by the iterated sequential filter (Algorithm 1 of
 * Combined SLAM): landmarks near the start pose are predicted into the submap with their joint covariance;
 * features are matched, new, or dropped where they are neither. In the end landmarks that agree are merged as
 * long as the joint estimate agrees with it.
 * @param progress called with the share of the work done; false ends it: features of the other submaps are
 * dropped and their end poses chained, and nothing is merged
 * @return empty if an information matrix was not positive definite */
std::optional<UnknownAssociation> associateByPosition(const LandmarkSubmaps& submaps,
                                                      const AssociationOptions& options,
                                                      const GaussNewtonOptions& gauss_newton,
                                                      const std::function<bool(double)>& progress);

}  // namespace submap_slam::landmark_joining
