#include <submap_slam/mapping/correlative_search.h>

#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;

/** 1 / (1 + r²), r the distance of a point from the nearest line in sigmas. */
double lineScore(const SurfelMap& map, double x, double y, double inverse_sigma) {
  const Surfel* surfel = map.nearest(x, y);
  if (!surfel) return 0;
  const double dx = x - static_cast<double>(surfel->line_x), dy = y - static_cast<double>(surfel->line_y);
  const double along_normal =
      dx * static_cast<double>(surfel->normal_x) + dy * static_cast<double>(surfel->normal_y);
  const double d2 = surfel->kind == Surfel::Kind::kLine ? along_normal * along_normal : dx * dx + dy * dy;
  return 1.0 / (1.0 + d2 * inverse_sigma * inverse_sigma);
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
class Volume {
 public:
  /** @param point_score score of a beam that ends at (x, y) */
  template <class PointScore>
  Volume(const LaserPoints& scan, const TPose2D& centre, const SearchWindow& window, PointScore point_score)
      : window_(window),
        centre_(centre),
        n_xy_(static_cast<int>(std::round(window.window_xy / window.step_xy))),
        n_phi_(static_cast<int>(std::round(window.window_phi / window.step_phi))) {
    const auto side = static_cast<std::size_t>(2 * n_xy_ + 1);
    scores_.reserve(side * side * static_cast<std::size_t>(2 * n_phi_ + 1));
    for (int kp = -n_phi_; kp <= n_phi_; ++kp) {
      const auto turned = turnedBy(scan, centre.phi + kp * window.step_phi, window.max_beams);
      for (int ky = -n_xy_; ky <= n_xy_; ++ky)
        for (int kx = -n_xy_; kx <= n_xy_; ++kx) {
          const TPose2D pose = poseAt(kx, ky, kp);
          double sum = 0;
          for (const auto& p : turned) sum += point_score(pose.x + p.x(), pose.y + p.y());
          scores_.push_back(turned.empty() ? 0.0 : sum / static_cast<double>(turned.size()));
        }
    }
  }

  double best() const { return *std::max_element(scores_.begin(), scores_.end()); }

  /** Local maxima with at least that score, in the order of the lattice. */
  std::vector<CorrelativePeak> peaks(double least) const {
    std::vector<CorrelativePeak> out;
    for (int kp = -n_phi_; kp <= n_phi_; ++kp)
      for (int ky = -n_xy_; ky <= n_xy_; ++ky)
        for (int kx = -n_xy_; kx <= n_xy_; ++kx) {
          const double score = scores_[index(kx, ky, kp)];
          if (score >= least && isPeak(kx, ky, kp)) out.push_back({poseAt(kx, ky, kp), score});
        }
    return out;
  }

 private:
  TPose2D poseAt(int kx, int ky, int kp) const {
    return {centre_.x + kx * window_.step_xy, centre_.y + ky * window_.step_xy,
            mrpt::math::wrapToPi(centre_.phi + kp * window_.step_phi)};
  }

  std::size_t index(int kx, int ky, int kp) const {
    const int side = 2 * n_xy_ + 1;
    return static_cast<std::size_t>(((kp + n_phi_) * side + ky + n_xy_) * side + kx + n_xy_);
  }

  bool isPeak(int kx, int ky, int kp) const {
    const double here = scores_[index(kx, ky, kp)];
    for (int p = std::max(kp - 1, -n_phi_); p <= std::min(kp + 1, n_phi_); ++p)
      for (int y = std::max(ky - 1, -n_xy_); y <= std::min(ky + 1, n_xy_); ++y)
        for (int x = std::max(kx - 1, -n_xy_); x <= std::min(kx + 1, n_xy_); ++x)
          if (scores_[index(x, y, p)] > here) return false;
    return true;
  }

  const SearchWindow& window_;
  TPose2D centre_;
  int n_xy_, n_phi_;  ///< half widths in steps
  std::vector<double> scores_;
};

}  // namespace

std::vector<CorrelativePeak> correlativeSearch(const SurfelMap& map, const LaserPoints& scan,
                                               const TPose2D& centre, const CorrelativeSearchParams& params) {
  const Volume volume(scan, centre, params, [&, inverse_sigma = 1.0 / params.sigma](double x, double y) {
    return lineScore(map, x, y, inverse_sigma);
  });
  std::vector<CorrelativePeak> peaks = volume.peaks(params.peak_ratio * volume.best());
  std::stable_sort(peaks.begin(), peaks.end(),
                   [](const auto& a, const auto& b) { return a.score > b.score; });
  if (peaks.size() > static_cast<std::size_t>(params.max_peaks))
    peaks.resize(static_cast<std::size_t>(params.max_peaks));
  return peaks;
}

CorrelativePeak correlativeSearch(const ProbabilityGrid& grid, const LaserPoints& scan, const TPose2D& centre,
                                  const SearchWindow& window) {
  const Volume volume(scan, centre, window, [&](double x, double y) {
    return grid.probability(static_cast<int>(std::lround(grid.columnOf(x))),
                            static_cast<int>(std::lround(grid.rowOf(y))));
  });
  return volume.peaks(volume.best()).front();
}

}  // namespace submap_slam
