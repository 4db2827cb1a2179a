#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace submap_slam {

/** Statistics of a set of errors e ≥ 0; all zero for an empty set. */
struct ErrorStatistics {
  std::size_t count = 0;
  double mean = 0, std = 0;                  ///< of e; std with n − 1, 0 for one sample
  double squared_mean = 0, squared_std = 0;  ///< of e²
  double rmse = 0;
  double median = 0, percentile_95 = 0;  ///< element ⌊f n⌋ of the sorted set, f = 0.5 and 0.95
  double max = 0;
};

ErrorStatistics errorStatistics(std::vector<double> errors);

}  // namespace submap_slam
