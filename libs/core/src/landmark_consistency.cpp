#include <submap_slam/core/landmark_consistency.h>

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <unordered_map>

namespace submap_slam {
namespace {

/** More than this is said of an objective only if the submaps contradict each other. */
double largestUsualObjective(double freedom) {
  constexpr double kUsual = 3;  // covariances of filters are often too small by as much
  return kUsual * (freedom + 5 * std::sqrt(2 * freedom));
}

double degreesOfFreedom(const LandmarkSubmaps& submaps, const JoinedLandmarks& joined) {
  double observed = 0;
  for (const auto& submap : submaps) observed += static_cast<double>(submap->dimension());
  return observed - static_cast<double>(3 * submaps.size() + 2 * joined.landmarks.size());
}

}  // namespace

std::optional<Misfit> worstMisfit(const LandmarkSubmaps& submaps, const JoinedLandmarks& joined) {
  std::unordered_map<uint32_t, const JoinedLandmark*> landmarks;
  for (const auto& landmark : joined.landmarks) landmarks[landmark.id] = &landmark;
  std::optional<Misfit> worst;
  auto association = joined.associations.begin();
  for (std::size_t k = 0; k < submaps.size(); ++k)
    for (std::size_t i = 0; i < submaps[k]->features.size(); ++i, ++association) {
      if (association->kind == FeatureAssociation::Kind::kDropped) continue;
      const auto found = landmarks.find(association->landmark);
      if (found == landmarks.end()) continue;
      const SubmapFeature& feature = submaps[k]->features[i];
      const auto expected =
          joined.frames[k].mean.asTPose().inverseComposePoint({found->second->x, found->second->y});
      const Eigen::Vector2d r(feature.x - expected.x, feature.y - expected.y);
      const auto at = static_cast<Eigen::Index>(3 + 2 * i);
      const Eigen::Matrix2d covariance = submaps[k]->covariance.asEigen().block<2, 2>(at, at);
      const double distance2 = r.dot(covariance.ldlt().solve(r));
      if (!worst || distance2 > worst->distance2) worst = {submaps[k]->id, found->first, r.norm(), distance2};
    }
  return worst;
}

std::string describeContradiction(const LandmarkSubmaps& submaps, const JoinedLandmarks& joined) {
  const double freedom = degreesOfFreedom(submaps, joined);
  if (joined.status == JoinStatus::kFailed || freedom <= 0 ||
      joined.objective <= largestUsualObjective(freedom))
    return {};
  std::string text =
      fmt::format("the landmark submaps contradict each other: objective {:.4g} at {} degrees of freedom",
                  joined.objective, freedom);
  if (const auto worst = worstMisfit(submaps, joined))
    text += fmt::format("; worst is landmark {} in submap {}, {:.2f} m ({:.0f} sigma) from its place",
                        worst->landmark, worst->submap, worst->distance_m, std::sqrt(worst->distance2));
  return text + (joined.association_known
                     ? "; if ids may be wrong, map with landmark_mapper.known_ids = false, or join with "
                       "--unknown-association"
                     : "; landmarks may be matched wrongly, or noise is set too small");
}

}  // namespace submap_slam
