#include <fmt/format.h>
#include <submap_slam/output/ros_map.h>

#include <filesystem>

#include "binary_file.h"

namespace submap_slam {
namespace {

constexpr double kOccupiedThreshold = 0.65, kFreeThreshold = 0.196;

constexpr char kOccupied = 0, kFree = static_cast<char>(254), kUnknown = static_cast<char>(205);

char grey(double occupancy) {
  if (occupancy > kOccupiedThreshold) return kOccupied;
  return occupancy < kFreeThreshold ? kFree : kUnknown;
}

std::string pgm(const PackedEvidence& map) {
  std::string out = fmt::format("P5\n{} {}\n255\n", map.sizeX(), map.sizeY());
  const std::size_t head = out.size(), width = static_cast<std::size_t>(map.sizeX());
  out.resize(head + width * static_cast<std::size_t>(map.sizeY()), kUnknown);
  map.forEachObserved([&](int cx, int cy, float log_odds, float) {
    const auto row = static_cast<std::size_t>(map.sizeY() - 1 - cy);
    out[head + row * width + static_cast<std::size_t>(cx)] = grey(occupancyOf(log_odds));
  });
  return out;
}

std::string yaml(const PackedEvidence& map, const std::string& image) {
  return fmt::format(
      "image: {}\n"
      "mode: trinary\n"
      "resolution: {:.9f}\n"
      "origin: [{:.9f}, {:.9f}, 0.0]\n"
      "negate: 0\n"
      "occupied_thresh: {}\n"
      "free_thresh: {}\n",
      image, map.resolution(), map.xMin(), map.yMin(), kOccupiedThreshold, kFreeThreshold);
}

}  // namespace

void writeRosMap(const std::string& yaml_file, const PackedEvidence& map) {
  const auto image = std::filesystem::path(yaml_file).replace_extension(".pgm");
  writeBytes(image.string(), pgm(map));
  writeBytes(yaml_file, yaml(map, image.filename().string()));
}

}  // namespace submap_slam
