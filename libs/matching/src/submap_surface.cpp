#include <submap_slam/matching/submap_surface.h>

#include <cmath>
#include <cstdint>
#include <set>
#include <utility>

namespace submap_slam {
namespace {

/** Passes the first point of each square only. */
class Thinning {
 public:
  explicit Thinning(double side) : side_(side) {}
  bool passes(double x, double y) {
    return taken_.insert({static_cast<int>(std::floor(x / side_)), static_cast<int>(std::floor(y / side_))})
        .second;
  }

 private:
  double side_;
  std::set<std::pair<int, int>> taken_;
};

/** With the normal of the side that was seen. */
LaserPoint pointOn(const Surfel& surfel) {
  return {surfel.x, surfel.y, surfel.facing_x / surfel.hits, surfel.facing_y / surfel.hits};
}

}  // namespace

SurfelMap surfelMapOf(const GridSubmap& submap, const SurfelMapParams& params) {
  constexpr double kNoLimit = 1e9;
  SurfelMap map(params);
  const std::vector<SubmapScans> scans = submap.scans();
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (scans[i].empty()) continue;
    Frame frame;
    frame.scans = scans[i];
    map.insert(toLaserPoints(frame, kNoLimit), submap.nodes[i].pose);
  }
  return map;
}

SubmapSurface surfaceOf(const SurfelMap& map, const SurfaceParams& params) {
  SubmapSurface surface;
  Thinning dense(params.spacing), sparse(params.sparse_spacing);
  for (const Surfel& surfel : map.surfels()) {
    if (surfel.hits < static_cast<float>(params.min_hits)) continue;
    const double x = static_cast<double>(surfel.x), y = static_cast<double>(surfel.y);
    if (dense.passes(x, y)) surface.dense.points.push_back(pointOn(surfel));
    if (sparse.passes(x, y)) surface.sparse.push_back({x, y});
  }
  return surface;
}

}  // namespace submap_slam
