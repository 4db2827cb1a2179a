/** Random changes of parameters, to see whether a result hangs on their exact values. */
#pragma once

#include <submap_slam/core/parameters.h>

#include <cstdint>
#include <string>
#include <vector>

namespace submap_slam {

/** Which parameters are multiplied by random factors. */
struct ParameterVariation {
  double share = 0;               ///< factors are uniform in [1 - share, 1 + share]
  std::vector<std::string> keys;  ///< "section.key", of numbers
};

/** Multiplies each key by a factor of its own that depends on seed, key and share alone; whole numbers are
 * rounded, values outside of the allowed range become its end. Throws ConfigError for a key that is unknown
 * or no number. */
void vary(ParameterTable& table, const ParameterVariation& variation, uint64_t seed);

}  // namespace submap_slam
