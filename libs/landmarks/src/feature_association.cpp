#include <submap_slam/landmarks/feature_association.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <tuple>

namespace submap_slam::landmark_mapping {

std::vector<Origin> unrivalled(std::size_t measurements, const std::vector<Pairing>& pairings,
                               double match_gate) {
  std::vector<int> of_measurement(measurements), of_feature;
  for (const Pairing& p : pairings) {
    if (p.feature >= of_feature.size()) of_feature.resize(p.feature + 1);
    ++of_measurement[p.measurement], ++of_feature[p.feature];
  }
  std::vector<Origin> origins(measurements);
  for (const Pairing& p : pairings)
    if (p.distance2 <= match_gate && of_measurement[p.measurement] == 1 && of_feature[p.feature] == 1)
      origins[p.measurement] = {Origin::Kind::kFeature, p.feature};
  return origins;
}

std::vector<Origin> assign(std::vector<Origin> origins, std::vector<Pairing> pairings, double match_gate) {
  std::sort(pairings.begin(), pairings.end(), [](const Pairing& a, const Pairing& b) {
    return std::tie(a.distance2, a.measurement, a.feature) < std::tie(b.distance2, b.measurement, b.feature);
  });
  std::vector<std::size_t> taken;
  for (const Origin& origin : origins)
    if (origin.kind == Origin::Kind::kFeature) taken.push_back(origin.feature);
  for (const Pairing& p : pairings) {
    Origin& origin = origins[p.measurement];
    if (origin.kind == Origin::Kind::kFeature) continue;
    origin.kind = Origin::Kind::kAmbiguous;
    if (p.distance2 > match_gate || std::find(taken.begin(), taken.end(), p.feature) != taken.end()) continue;
    origin = {Origin::Kind::kFeature, p.feature};
    taken.push_back(p.feature);
  }
  return origins;
}

std::vector<std::pair<std::size_t, std::size_t>> newMatches(const std::vector<Origin>& before,
                                                            const std::vector<Origin>& now) {
  std::vector<std::pair<std::size_t, std::size_t>> matches;
  for (std::size_t m = 0; m < now.size(); ++m)
    if (now[m].kind == Origin::Kind::kFeature && before[m].kind != Origin::Kind::kFeature)
      matches.emplace_back(m, now[m].feature);
  return matches;
}

double squaredDistance(const Eigen::Vector2d& v, const Eigen::Matrix2d& s) { return v.dot(s.inverse() * v); }

Innovation measure(const Eigen::Vector2d& v, const Eigen::Matrix2d& s) {
  return {squaredDistance(v, s), std::log(4 * M_PI * M_PI * s.determinant())};
}

}  // namespace submap_slam::landmark_mapping
