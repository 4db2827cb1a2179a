#include "landmark_info.h"

#include <fmt/format.h>
#include <submap_slam/core/path_length.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

namespace submap_slam {
namespace {

/** What all submaps have together. */
struct Totals {
  double path_m = 0;
  std::size_t poses = 0, features = 0, largest = 0;
  bool ids_known = true;
  std::set<uint32_t> ids;
};

/** From the start to the end pose (m). */
double pathLength(const LandmarkSubmap& submap) {
  std::vector<LandmarkNode> path = submap.nodes;
  path.push_back({submap.end_stamp, submap.end_pose});
  return submap_slam::pathLength(path);
}

/** Without poses only start and end are known. */
std::string pathText(std::size_t poses, double length) {
  return poses > 0 ? fmt::format("{:.1f}", length) : "-";
}

void printSubmap(const LandmarkSubmap& submap) {
  const auto& Q = submap.covariance;
  fmt::print("{:>4} {:>8} {:>6} {:>9} {:>10} {:>9.1f} {:>16}\n", submap.id,
             pathText(submap.nodes.size(), pathLength(submap)), submap.nodes.size(), submap.features.size(),
             submap.dimension(), submap.radius(),
             fmt::format("{:.3f} m {:.2f}°", std::sqrt(Q(0, 0) + Q(1, 1)), std::sqrt(Q(2, 2)) * 180 / M_PI));
}

void add(Totals& totals, const LandmarkSubmap& submap) {
  totals.path_m += pathLength(submap);
  totals.poses += submap.nodes.size();
  totals.features += submap.features.size();
  totals.largest = std::max(totals.largest, submap.dimension());
  totals.ids_known = totals.ids_known && submap.ids_known;
  for (const auto& feature : submap.features) totals.ids.insert(feature.id);
}

}  // namespace

void printLandmarkSubmaps(const LandmarkSubmaps& submaps) {
  Totals totals;
  fmt::print("{:>4} {:>8} {:>6} {:>9} {:>10} {:>9} {:>16}\n", "id", "path m", "poses", "features",
             "dimension", "radius m", "end pose sigma");
  for (const auto& submap : submaps) {
    printSubmap(*submap);
    add(totals, *submap);
  }
  fmt::print("{} landmark submaps, {} m, {} poses, {} features, dimension at most {}, {}\n", submaps.size(),
             pathText(totals.poses, totals.path_m), totals.poses, totals.features, totals.largest,
             totals.ids_known ? fmt::format("ids of {} landmarks", totals.ids.size()) : "ids not known");
}

}  // namespace submap_slam
