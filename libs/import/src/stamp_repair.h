#pragma once

#include <cstddef>
#include <vector>

namespace submap_slam {

/** Stamps that increase. */
struct RepairedStamps {
  std::vector<double> stamps_s;
  std::size_t replaced = 0;
  double largest_shift_s = 0;
};

/** Makes the stamps of consecutive messages of one sensor increase: keeps the largest set that does (longest
 * increasing subsequence) and interpolates the others between those around them. The order of messages is
 * taken to be right. In front of the first and behind the last kept one steps have the median length. */
RepairedStamps repairStamps(const std::vector<double>& stamps_s);

}  // namespace submap_slam
