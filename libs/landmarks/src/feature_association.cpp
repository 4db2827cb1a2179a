#include <submap_slam/landmarks/feature_association.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <tuple>

namespace submap_slam::landmark_mapping {

std::vector<Origin> assign(std::size_t measurements, std::vector<Pairing> pairings, double match_gate) {
  std::sort(pairings.begin(), pairings.end(), [](const Pairing& a, const Pairing& b) {
    return std::tie(a.distance2, a.measurement, a.feature) < std::tie(b.distance2, b.measurement, b.feature);
  });
  std::vector<Origin> origins(measurements);
  std::vector<std::size_t> taken;
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

double squaredDistance(const Eigen::Vector2d& v, const Eigen::Matrix2d& s) { return v.dot(s.inverse() * v); }

Innovation measure(const Eigen::Vector2d& v, const Eigen::Matrix2d& s) {
  return {squaredDistance(v, s), std::log(4 * M_PI * M_PI * s.determinant())};
}

}  // namespace submap_slam::landmark_mapping
