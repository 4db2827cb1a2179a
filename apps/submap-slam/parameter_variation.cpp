#include "parameter_variation.h"

#include <fmt/format.h>
#include <submap_slam/core/errors.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace submap_slam {
namespace {

/** FNV-1a: std::hash gives other numbers in other standard libraries. */
uint64_t hashOf(const std::string& text) {
  uint64_t hash = 0xcbf29ce484222325ull;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
  return hash;
}

const Parameter& find(const ParameterTable& table, const std::string& key) {
  const auto& all = table.parameters();
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const Parameter& p) { return p.section + "." + p.key == key; });
  if (found == all.end()) throw ConfigError(fmt::format("'{}': no such parameter to vary", key));
  return *found;
}

std::string varied(const Parameter& parameter, double factor) {
  const auto within = [&](double value) {
    return std::clamp(value, parameter.range.min, parameter.range.max);
  };
  if (const auto* real = std::get_if<double*>(&parameter.target))
    return fmt::format("{}", within(**real * factor));
  if (const auto* whole = std::get_if<int*>(&parameter.target))
    return fmt::format("{:.0f}", within(std::round(**whole * factor)));
  throw ConfigError(fmt::format("'{}.{}': only numbers can be varied", parameter.section, parameter.key));
}

}  // namespace

void vary(ParameterTable& table, const ParameterVariation& variation, uint64_t seed) {
  for (const std::string& key : variation.keys) {
    std::mt19937_64 random(seed ^ hashOf(key));
    const double factor = 1 + variation.share * (2 * std::generate_canonical<double, 53>(random) - 1);
    const Parameter& parameter = find(table, key);
    table.set(parameter.section, parameter.key, varied(parameter, factor));
  }
}

}  // namespace submap_slam
