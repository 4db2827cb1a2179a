#include <submap_slam/core/map_resolution.h>
#include <submap_slam/mapping/map_from_scans.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <vector>

#include "evidence_canvas.h"
#include "kept_scans.h"

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;

/** Submaps whose scans are held at once. */
constexpr std::size_t kTogether = 8;

struct KeptScan {
  LaserPoints points;
  TPose2D pose;  ///< T_w_robot
};

std::vector<KeptScan> keptScans(const GridSubmaps& submaps, const JoinedMap& joined, std::size_t k,
                                const GridMapperParams& mapper) {
  const auto scans = submaps[k]->scans();
  const auto poses = nodePosesOf(submaps, joined, k);
  const TPose2D T_w_s = joined.frames[k].mean.asTPose();
  std::vector<KeptScan> kept;
  for (std::size_t i = 0; i < scans.size(); ++i)
    if (!scans[i].empty()) kept.push_back({pointsOf(scans[i], mapper), T_w_s + poses[i]});
  return kept;
}

/** Calls f(k, scans) for each submap k, in order; they are read by all threads. */
template <class F>
void forEachSubmap(const GridSubmaps& submaps, const JoinedMap& joined, const GridMapperParams& mapper, F f) {
  for (std::size_t first = 0; first < submaps.size(); first += kTogether) {
    const std::size_t count = std::min(kTogether, submaps.size() - first);
    std::vector<std::vector<KeptScan>> scans(count);
    tbb::parallel_for(std::size_t{0}, count,
                      [&](std::size_t i) { scans[i] = keptScans(submaps, joined, first + i, mapper); });
    for (std::size_t i = 0; i < count; ++i) f(first + i, scans[i]);
  }
}

}  // namespace

std::optional<EvidenceGrid> mapFromScans(const GridSubmaps& submaps, const JoinedMap& joined,
                                         const GridMapperParams& mapper, double resolution) {
  EvidenceParams params = mapper.evidence;
  params.resolution = mapResolution(submaps, joined.frames, resolution);
  Bounds bounds;
  bool complete = true;
  forEachSubmap(submaps, joined, mapper, [&](std::size_t k, const std::vector<KeptScan>& scans) {
    complete = complete && (!scans.empty() || submaps[k]->evidenceSummary().stored_cells == 0);
    for (const auto& scan : scans) addBounds(bounds, scan.points, scan.pose, params);
  });
  if (!complete) return std::nullopt;
  if (bounds.empty() || params.resolution <= 0) return EvidenceGrid();
  EvidenceCanvas canvas(bounds, params);
  forEachSubmap(submaps, joined, mapper, [&](std::size_t, const std::vector<KeptScan>& scans) {
    for (const auto& scan : scans) canvas.draw(scan.points, scan.pose);
  });
  return canvas.cropped();
}

}  // namespace submap_slam
