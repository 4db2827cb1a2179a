/** Which measurement of a scan is of which feature. */
#pragma once

#include <submap_slam/landmarks/landmark_geometry.h>

#include <cstddef>
#include <vector>

namespace submap_slam::landmark_mapping {

/** A pairing within a gate wide enough to tell new features, so that its distance is known. */
struct Pairing {
  std::size_t measurement = 0, feature = 0;
  double distance2 = 0;  ///< squared Mahalanobis distance
};

/** What a measurement is of. */
struct Origin {
  enum class Kind { kFeature, kNew, kAmbiguous };
  Kind kind = Kind::kNew;
  std::size_t feature = 0;  ///< where kFeature
};

/** Pairs by ascending distance, each measurement and each feature once, up to `match_gate`; a measurement
 * with no feature within `new_gate` is of a new one, what is left is ambiguous. Of equal distances that of
 * the first measurement and feature comes first.
 * @param pairings all those within new_gate */
std::vector<Origin> assign(std::size_t measurements, std::vector<Pairing> pairings, double match_gate);

/** vᵀ S⁻¹ v, and log det(2π S). */
struct Innovation {
  double distance2 = 0, log_volume = 0;
  double logLikelihood() const { return -0.5 * (distance2 + log_volume); }
};
double squaredDistance(const Eigen::Vector2d& v, const Eigen::Matrix2d& s);
Innovation measure(const Eigen::Vector2d& v, const Eigen::Matrix2d& s);

}  // namespace submap_slam::landmark_mapping
