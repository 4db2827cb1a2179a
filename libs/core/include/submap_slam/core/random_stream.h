/** Random numbers that are the same on every machine. */
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

namespace submap_slam {

/** Seed of a submap's own random stream (the finaliser of splitmix64 spreads neighbouring frame numbers). */
inline uint64_t streamSeed(uint64_t seed, uint64_t frame) {
  uint64_t z = seed + 0x9e3779b97f4a7c15ull * (frame + 1);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

/** A standard normal number by Box and Muller: std::normal_distribution gives other numbers in other standard
 * libraries. */
inline double standardNormal(std::mt19937_64& random) {
  const double u = 1.0 - std::generate_canonical<double, 53>(random);
  const double v = std::generate_canonical<double, 53>(random);
  return std::sqrt(-2 * std::log(u)) * std::cos(2 * M_PI * v);
}

}  // namespace submap_slam
