#pragma once

#include <cstdint>

namespace submap_slam {

/** Grids of more cells a side are taken for a damaged file. */
constexpr uint32_t kMaxSide = 1u << 16;

}  // namespace submap_slam
