#include <submap_slam/mapping/evidence_renderer.h>

#include "evidence_canvas.h"

namespace submap_slam {

EvidenceGrid renderEvidence(const std::vector<PlacedScan>& scans, const EvidenceParams& params) {
  Bounds bounds;
  for (const auto& scan : scans) addBounds(bounds, *scan.scan, scan.pose, params);
  const double r = params.resolution;
  if (bounds.empty()) return EvidenceGrid(0, r, 0, r, r);
  EvidenceCanvas canvas(bounds, params);
  for (const auto& scan : scans) canvas.draw(*scan.scan, scan.pose);
  return canvas.cropped();
}

}  // namespace submap_slam
