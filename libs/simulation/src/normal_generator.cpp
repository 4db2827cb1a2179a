#include <submap_slam/simulation/normal_generator.h>

#include <cmath>

#include "constants.h"

namespace submap_slam {
namespace {

std::mt19937_64 seededEngine(uint64_t seed, uint32_t stream) {
  std::seed_seq sequence{static_cast<uint32_t>(seed), static_cast<uint32_t>(seed >> 32), stream};
  return std::mt19937_64(sequence);
}

}  // namespace

NormalGenerator::NormalGenerator(uint64_t seed, uint32_t stream) : engine_(seededEngine(seed, stream)) {}

double NormalGenerator::operator()() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  const double radius = std::sqrt(-2 * std::log(uniform()));
  const double angle = 2 * kPi * uniform();
  spare_ = radius * std::sin(angle);
  has_spare_ = true;
  return radius * std::cos(angle);
}

/** Uniform in (0, 1]: the logarithm of 0 must not occur. */
double NormalGenerator::uniform() { return (static_cast<double>(engine_() >> 11) + 1) * 0x1p-53; }

}  // namespace submap_slam
