#pragma once

#include <submap_slam/core/joined_landmarks.h>

#include <optional>
#include <string>

namespace submap_slam {

/** A feature and how far its submap has it from where the joined map has its landmark. */
struct Misfit {
  uint32_t submap = 0;    ///< id
  uint32_t landmark = 0;  ///< id
  double distance_m = 0;
  double distance2 = 0;  ///< squared Mahalanobis distance by the feature's covariance in its submap
};

/** The feature that fits worst; nothing if no submap has any. Requires of `joined` a frame for each submap
 * and an association for each feature, those of the submaps one behind the other. */
std::optional<Misfit> worstMisfit(const LandmarkSubmaps& submaps, const JoinedLandmarks& joined);

/** Says so where submaps do not fit together, and which feature fits worst: the objective is then far above
 * its χ² distribution. Else empty. Requires the same as worstMisfit(), unless joining failed. */
std::string describeContradiction(const LandmarkSubmaps& submaps, const JoinedLandmarks& joined);

}  // namespace submap_slam
