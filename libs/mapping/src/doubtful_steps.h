#pragma once

#include <submap_slam/core/frame.h>
#include <submap_slam/mapping/grid_mapper.h>
#include <submap_slam/mapping/local_path.h>
#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace submap_slam {

/** A step that may be wrong as a whole. */
struct DoubtfulStep {
  std::size_t to;       ///< frame that it ends at
  Eigen::Vector3d off;  ///< standard deviations of what it may be off by (m, m, rad)
};

/** Finds steps at which the path may be broken:
 *
 * - leaps, much longer than other steps of these frames, of which scans and odometry say quite different
 * things: where data were lost, scans overlap little and may be matched wrongly;
 * - steps to scans that fit nothing that came before. */
class DoubtfulSteps {
 public:
  DoubtfulSteps(const ClosingParams& limits, const std::vector<Frame>& frames);

  /** The first one that is found out at a frame in (from, to].
   * @param path  its first node is that of frame `begin`
   * @param last  true if nothing behind `to` is looked at any more: what may be the first stray scan of many
   * counts */
  std::optional<DoubtfulStep> find(const LocalPath& path, std::size_t begin, std::size_t from, std::size_t to,
                                   bool last) const;

 private:
  std::optional<Eigen::Vector3d> contradiction(const LocalPath& path, std::size_t begin, std::size_t i) const;
  bool isLeap(const mrpt::math::TPose2D& step) const;

  const ClosingParams& limits_;
  const std::vector<Frame>& frames_;
  double leap_xy_ = 0, leap_phi_ = 0;  ///< m, rad
};

}  // namespace submap_slam
