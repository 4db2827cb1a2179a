#pragma once

#include <fmt/format.h>
#include <submap_slam/core/errors.h>

#include <cmath>

namespace submap_slam {

/** Throws ConfigError that names the member of a struct and what it must be. */
inline void require(bool holds, const char* member, const char* expected) {
  if (!holds) throw ConfigError(fmt::format("{} must be {}", member, expected));
}

inline void requireNotNegative(double value, const char* member) {
  require(value >= 0 && std::isfinite(value), member, "zero or positive");
}

}  // namespace submap_slam
