#include <fmt/format.h>
#include <submap_slam/output/ros_map.h>

#include <filesystem>

#include "binary_file.h"

namespace submap_slam {
namespace {

constexpr double kOccupiedThreshold = 0.65, kFreeThreshold = 0.196;

char grey(double occupancy) {
  constexpr unsigned char kOccupied = 0, kFree = 254, kUnknown = 205;
  if (occupancy > kOccupiedThreshold) return static_cast<char>(kOccupied);
  return static_cast<char>(occupancy < kFreeThreshold ? kFree : kUnknown);
}

std::string pgm(const EvidenceGrid& map) {
  std::string out = fmt::format("P5\n{} {}\n255\n", map.sizeX(), map.sizeY());
  for (std::size_t row = map.sizeY(); row-- > 0;)
    for (std::size_t cx = 0; cx < map.sizeX(); ++cx) out += grey(map.occupancy(cx, row));
  return out;
}

std::string yaml(const EvidenceGrid& map, const std::string& image) {
  return fmt::format(
      "image: {}\n"
      "mode: trinary\n"
      "resolution: {:.9f}\n"
      "origin: [{:.9f}, {:.9f}, 0.0]\n"
      "negate: 0\n"
      "occupied_thresh: {}\n"
      "free_thresh: {}\n",
      image, map.resolution(), map.log_odds.getXMin(), map.log_odds.getYMin(), kOccupiedThreshold,
      kFreeThreshold);
}

}  // namespace

void writeRosMap(const std::string& yaml_file, const EvidenceGrid& map) {
  const auto image = std::filesystem::path(yaml_file).replace_extension(".pgm");
  writeBytes(image.string(), pgm(map));
  writeBytes(yaml_file, yaml(map, image.filename().string()));
}

}  // namespace submap_slam
