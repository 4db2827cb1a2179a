#pragma once

#include <mrpt/math/TPose2D.h>
#include <submap_slam/mapping/evidence_renderer.h>
#include <submap_slam/mapping/laser_points.h>
#include <Eigen/Core>

#include <cmath>

#include "beam_tracing.h"

namespace submap_slam {

/** Draws beams into cells, which take evidence by `add(column, row, log_odds, hits)`; coordinates in cells.
 */
template <class Cells>
class BeamWriter {
 public:
  BeamWriter(Cells& cells, const EvidenceParams& params)
      : cells_(cells),
        free_(static_cast<float>(params.free_log_odds)),
        occupied_log_odds_(params.occupied_log_odds) {}

  /** Free evidence to every cell that the segment crosses, the cell of `to` excluded. */
  void crossFree(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
    forEachCrossedCell(from, to, [&](int cx, int cy) { cells_.add(cx, cy, free_, 1.0f); });
  }

  /** Occupied evidence of one observation, shared bilinearly by the four cells around the endpoint. */
  void hitAt(const Eigen::Vector2d& p) {
    const double x = p.x() - 0.5, y = p.y() - 0.5;  // cell centres
    const int cx = static_cast<int>(std::floor(x)), cy = static_cast<int>(std::floor(y));
    const double u = x - cx, v = y - cy;
    const double weights[4] = {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v};
    for (int k = 0; k < 4; ++k)
      cells_.add(cx + (k & 1), cy + (k >> 1), static_cast<float>(weights[k] * occupied_log_odds_),
                 static_cast<float>(weights[k]));
  }

 private:
  Cells& cells_;
  float free_;
  double occupied_log_odds_;
};

/** Draws the beams of a scan.
 * @param corner of cell (0, 0) (m) */
template <class Cells>
void drawScan(const LaserPoints& scan, const mrpt::math::TPose2D& pose, const EvidenceParams& params,
              const Eigen::Vector2d& corner, Cells& cells) {
  BeamWriter writer(cells, params);
  forEachBeam(scan, pose, params.max_range,
              [&](const Eigen::Vector2d& from, const Eigen::Vector2d& to, bool is_hit) {
                const Eigen::Vector2d a = (from - corner) / params.resolution;
                const Eigen::Vector2d b = (to - corner) / params.resolution;
                writer.crossFree(a, b);
                if (is_hit) writer.hitAt(b);
              });
}

}  // namespace submap_slam
