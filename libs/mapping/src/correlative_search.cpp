#include <submap_slam/mapping/correlative_search.h>

#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;

/** Mean over beams of 1 / (1 + r²), r the distance to the nearest line in sigmas. */
double scoreAt(const SurfelMap& map, const std::vector<Eigen::Vector2d>& turned, double x, double y,
               double inverse_sigma) {
  double sum = 0;
  for (const auto& p : turned) {
    const double px = x + p.x(), py = y + p.y();
    const Surfel* surfel = map.nearest(px, py);
    if (!surfel) continue;
    const double dx = px - static_cast<double>(surfel->line_x), dy = py - static_cast<double>(surfel->line_y);
    const double along_normal =
        dx * static_cast<double>(surfel->normal_x) + dy * static_cast<double>(surfel->normal_y);
    const double d2 = surfel->kind == Surfel::Kind::kLine ? along_normal * along_normal : dx * dx + dy * dy;
    sum += 1.0 / (1.0 + d2 * inverse_sigma * inverse_sigma);
  }
  return turned.empty() ? 0.0 : sum / static_cast<double>(turned.size());
}

/** Endpoints, thinned evenly to `max_beams`, in the axes of the map. */
std::vector<Eigen::Vector2d> turnedBy(const LaserPoints& scan, double phi, int max_beams) {
  const double c = std::cos(phi), s = std::sin(phi);
  std::vector<Eigen::Vector2d> out;
  const std::size_t stride = scan.points.size() / static_cast<std::size_t>(max_beams) + 1;
  for (std::size_t i = 0; i < scan.points.size(); i += stride) {
    const auto& p = scan.points[i];
    const double x = static_cast<double>(p.x), y = static_cast<double>(p.y);
    out.emplace_back(c * x - s * y, s * x + c * y);
  }
  return out;
}

/** Scores on the lattice of the search window, φ slowest, x fastest. */
struct Volume {
  int n_xy, n_phi;  ///< half widths in steps
  std::vector<double> score;

  std::size_t index(int kx, int ky, int kp) const {
    const int side = 2 * n_xy + 1;
    return static_cast<std::size_t>(((kp + n_phi) * side + ky + n_xy) * side + kx + n_xy);
  }

  bool isPeak(int kx, int ky, int kp) const {
    const double here = score[index(kx, ky, kp)];
    for (int p = std::max(kp - 1, -n_phi); p <= std::min(kp + 1, n_phi); ++p)
      for (int y = std::max(ky - 1, -n_xy); y <= std::min(ky + 1, n_xy); ++y)
        for (int x = std::max(kx - 1, -n_xy); x <= std::min(kx + 1, n_xy); ++x)
          if (score[index(x, y, p)] > here) return false;
    return true;
  }
};

}  // namespace

std::vector<CorrelativePeak> correlativeSearch(const SurfelMap& map, const LaserPoints& scan,
                                               const TPose2D& centre, const CorrelativeSearchParams& params) {
  Volume volume{static_cast<int>(std::round(params.window_xy / params.step_xy)),
                static_cast<int>(std::round(params.window_phi / params.step_phi)),
                {}};
  const auto side = static_cast<std::size_t>(2 * volume.n_xy + 1);
  volume.score.resize(side * side * static_cast<std::size_t>(2 * volume.n_phi + 1));
  const auto poseAt = [&](int kx, int ky, int kp) {
    return TPose2D(centre.x + kx * params.step_xy, centre.y + ky * params.step_xy,
                   mrpt::math::wrapToPi(centre.phi + kp * params.step_phi));
  };
  for (int kp = -volume.n_phi; kp <= volume.n_phi; ++kp) {
    const auto turned = turnedBy(scan, centre.phi + kp * params.step_phi, params.max_beams);
    for (int ky = -volume.n_xy; ky <= volume.n_xy; ++ky)
      for (int kx = -volume.n_xy; kx <= volume.n_xy; ++kx) {
        const TPose2D pose = poseAt(kx, ky, kp);
        volume.score[volume.index(kx, ky, kp)] = scoreAt(map, turned, pose.x, pose.y, 1.0 / params.sigma);
      }
  }

  const double best = *std::max_element(volume.score.begin(), volume.score.end());
  std::vector<CorrelativePeak> peaks;
  for (int kp = -volume.n_phi; kp <= volume.n_phi; ++kp)
    for (int ky = -volume.n_xy; ky <= volume.n_xy; ++ky)
      for (int kx = -volume.n_xy; kx <= volume.n_xy; ++kx) {
        const double score = volume.score[volume.index(kx, ky, kp)];
        if (score >= params.peak_ratio * best && volume.isPeak(kx, ky, kp))
          peaks.push_back({poseAt(kx, ky, kp), score});
      }
  std::stable_sort(peaks.begin(), peaks.end(),
                   [](const auto& a, const auto& b) { return a.score > b.score; });
  if (peaks.size() > static_cast<std::size_t>(params.max_peaks))
    peaks.resize(static_cast<std::size_t>(params.max_peaks));
  return peaks;
}

}  // namespace submap_slam
