#pragma once

#include <mrpt/math/TPose2D.h>
#include <submap_slam/core/frame.h>

#include <optional>

namespace submap_slam {

/** The pose of b seen from a by odometry; empty if one of them has none. */
inline std::optional<mrpt::math::TPose2D> incrementBetween(const Frame& a, const Frame& b) {
  if (!a.odometry || !b.odometry) return std::nullopt;
  return *b.odometry - *a.odometry;
}

}  // namespace submap_slam
