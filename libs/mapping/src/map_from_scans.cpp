#include <submap_slam/mapping/map_from_scans.h>

#include <malloc.h>
#include <submap_slam/core/map_resolution.h>
#include <submap_slam/mapping/evidence_renderer.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <vector>

#include "beam_writer.h"
#include "kept_scans.h"
#include "tiled_evidence.h"

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

bool haveEqualCells(const EvidenceLayer& a, const EvidenceLayer& b) {
  return a.getXMin() == b.getXMin() && a.getYMin() == b.getYMin() && a.getSizeX() == b.getSizeX() &&
         std::equal(a.begin(), a.end(), b.begin(), b.end());
}

/** Whether the parameters draw the scans of a submap as they were drawn into its evidence. */
bool drawsItsEvidence(const GridSubmap& submap, const GridMapperParams& mapper) {
  const auto scans = submap.scans();
  std::vector<LaserPoints> points;
  points.reserve(scans.size());
  std::vector<PlacedScan> placed;
  for (std::size_t i = 0; i < scans.size(); ++i)
    if (!scans[i].empty())
      placed.push_back({&points.emplace_back(pointsOf(scans[i], mapper)), submap.nodes[i].pose});
  EvidenceParams params = mapper.evidence;
  params.resolution = submap.resolution();
  const EvidenceGrid drawn = renderEvidence(placed, params), kept = submap.packedEvidence()->unpacked();
  return haveEqualCells(drawn.hits, kept.hits) && haveEqualCells(drawn.log_odds, kept.log_odds);
}

/** Calls f(k, scans) for each submap k, in order, until it returns false; all threads read submaps. */
template <class F>
void forEachSubmap(const GridSubmaps& submaps, const JoinedMap& joined, const GridMapperParams& mapper, F f) {
  for (std::size_t first = 0; first < submaps.size(); first += kTogether) {
    const std::size_t count = std::min(kTogether, submaps.size() - first);
    std::vector<std::vector<KeptScan>> scans(count);
    tbb::parallel_for(std::size_t{0}, count,
                      [&](std::size_t i) { scans[i] = keptScans(submaps, joined, first + i, mapper); });
    for (std::size_t i = 0; i < count; ++i)
      if (!f(first + i, scans[i])) return;
  }
}

}  // namespace

std::optional<PackedEvidence> mapFromScans(const GridSubmaps& submaps, const JoinedMap& joined,
                                           const GridMapperParams& mapper, double resolution) {
  EvidenceParams params = mapper.evidence;
  params.resolution = mapResolution(submaps, joined.frames, resolution);
  if (params.resolution <= 0) return PackedEvidence();
  const auto first = std::find_if(submaps.begin(), submaps.end(), [](const auto& submap) {
    return submap->evidenceSummary().stored_cells > 0;
  });
  if (!drawsItsEvidence(**first, mapper)) return std::nullopt;
  TiledEvidence cells;
  bool complete = true;
  forEachSubmap(submaps, joined, mapper, [&](std::size_t k, const std::vector<KeptScan>& scans) {
    for (const auto& scan : scans) drawScan(scan.points, scan.pose, params, Eigen::Vector2d::Zero(), cells);
    complete = !scans.empty() || submaps[k]->evidenceSummary().stored_cells == 0;
    return complete;
  });
  if (!complete) return std::nullopt;
  malloc_trim(0);  // the scans left holes in the heap, and the cells are about to be there twice
  return cells.take(params.resolution);
}

}  // namespace submap_slam
