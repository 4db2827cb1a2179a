#pragma once

#include <mrpt/math/TPose2D.h>
#include <submap_slam/core/evidence_grid.h>
#include <submap_slam/mapping/evidence_renderer.h>
#include <submap_slam/mapping/laser_points.h>

#include "beam_tracing.h"

namespace submap_slam {

/** Adds what a scan draws into the evidence to the bounds (m). */
void addBounds(Bounds& bounds, const LaserPoints& scan, const mrpt::math::TPose2D& pose,
               const EvidenceParams& params);

/** Evidence that scans are drawn into one by one, as renderEvidence says. */
class EvidenceCanvas {
 public:
  /** @param bounds of all scans to come; not empty */
  EvidenceCanvas(const Bounds& bounds, const EvidenceParams& params);

  void draw(const LaserPoints& scan, const mrpt::math::TPose2D& pose);

  /** Cropped to what was seen. */
  EvidenceGrid cropped() const { return grid_.cropped(); }

 private:
  EvidenceParams params_;
  EvidenceGrid grid_;
};

}  // namespace submap_slam
