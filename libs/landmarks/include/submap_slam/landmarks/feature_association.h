/** Which measurement of a scan is of which feature. */
#pragma once

#include <submap_slam/landmarks/landmark_geometry.h>

#include <cstddef>
#include <utility>
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

/** Matches up to `match_gate` that nothing rivals: neither the measurement nor the feature is in another
 * pairing. Where all bearings are off alike, by a turn that odometry got wrong, these tell it, and what is
 * left is judged better once the filter has taken them.
 * @param pairings all those within new_gate */
std::vector<Origin> unrivalled(std::size_t measurements, const std::vector<Pairing>& pairings,
                               double match_gate);

/** Pairs by ascending distance, each measurement and each feature once, up to `match_gate`; a measurement
 * with no feature within `new_gate` is of a new one, what is left is ambiguous. Of equal distances that of
 * the first measurement and feature comes first.
 * @param origins those that are kFeature stay, and their features are taken
 * @param pairings all those of the other measurements within new_gate */
std::vector<Origin> assign(std::vector<Origin> origins, std::vector<Pairing> pairings, double match_gate);

/** (measurement, feature) of the matches that `now` has and `before` had not. */
std::vector<std::pair<std::size_t, std::size_t>> newMatches(const std::vector<Origin>& before,
                                                            const std::vector<Origin>& now);

/** vᵀ S⁻¹ v, and log det(2π S). */
struct Innovation {
  double distance2 = 0, log_volume = 0;
  double logLikelihood() const { return -0.5 * (distance2 + log_volume); }
};
double squaredDistance(const Eigen::Vector2d& v, const Eigen::Matrix2d& s);
Innovation measure(const Eigen::Vector2d& v, const Eigen::Matrix2d& s);

}  // namespace submap_slam::landmark_mapping
