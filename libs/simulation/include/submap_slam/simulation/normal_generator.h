#pragma once

#include <cstdint>
#include <random>

namespace submap_slam {

/** Standard normal random numbers that are the same with every standard library.
 *
 * std::normal_distribution leaves its algorithm to the implementation; this one is Box and Muller's (1958) on
 * std::mt19937_64. Streams of one seed are independent of each other.
 */
class NormalGenerator {
 public:
  NormalGenerator(uint64_t seed, uint32_t stream);

  /** One sample of N(0, 1). */
  double operator()();

 private:
  double uniform();

  std::mt19937_64 engine_;
  double spare_ = 0;
  bool has_spare_ = false;
};

}  // namespace submap_slam
