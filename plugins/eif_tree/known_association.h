#pragma once

#include <submap_slam/core/joined_landmarks.h>

#include <cstdint>
#include <vector>

#include "observation.h"

namespace submap_slam::landmark_joining {

/** A joint problem with the observations that it points to, and what became of each feature. */
struct AssociatedProblem {
  AssociatedProblem() = default;
  AssociatedProblem(AssociatedProblem&&) = default;
  AssociatedProblem& operator=(AssociatedProblem&&) = default;

  std::vector<Observation> observations;
  JointProblem problem;                ///< points into `observations`
  std::vector<uint32_t> landmark_ids;  ///< of each landmark
  std::vector<uint32_t> hits;          ///< of each landmark, summed over the submaps
  std::vector<FeatureAssociation> associations;
};

/** Features with equal ids are one landmark; landmarks are ordered by id. */
AssociatedProblem associateByIds(const LandmarkSubmaps& submaps);

}  // namespace submap_slam::landmark_joining
