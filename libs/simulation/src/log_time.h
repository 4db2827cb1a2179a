#pragma once

#include <mrpt/core/Clock.h>

#include <chrono>
#include <cmath>
#include <cstddef>

namespace submap_slam {

/** Stamp of the pose with this index: 2020-01-01 00:00 UTC + index · period (s). */
inline mrpt::Clock::time_point stampOf(std::size_t index, double period) {
  constexpr double kEpoch = 1577836800;  // s
  const auto since_start = std::chrono::nanoseconds(std::llround(static_cast<double>(index) * period * 1e9));
  return mrpt::Clock::fromDouble(kEpoch) + std::chrono::duration_cast<mrpt::Clock::duration>(since_start);
}

/** The multiple of a step next to a value; step 0: the value. */
inline double rounded(double value, double step) {
  return step > 0 ? std::round(value / step) * step : value;
}

}  // namespace submap_slam
