#include <fmt/format.h>
#include <mrpt/core/Clock.h>
#include <submap_slam/output/trajectory_file.h>

#include <cmath>
#include <unordered_map>
#include <vector>

#include "binary_file.h"

namespace submap_slam {

void writeTum(const std::string& file, const Trajectory& trajectory) {
  std::vector<const StampedPose*> lines;
  std::vector<std::string> stamps;
  std::unordered_map<std::string, std::size_t> line_of_stamp;
  for (const auto& p : trajectory) {
    const std::string stamp = fmt::format("{:.6f}", mrpt::Clock::toDouble(p.stamp));
    const auto [entry, is_new] = line_of_stamp.emplace(stamp, lines.size());
    if (is_new) {
      lines.push_back(&p);
      stamps.push_back(stamp);
    } else {
      lines[entry->second] = &p;
    }
  }
  std::string text = "# timestamp x y z qx qy qz qw\n";
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto& pose = lines[i]->pose;
    text += fmt::format("{} {:.12g} {:.12g} 0 0 0 {:.12g} {:.12g}\n", stamps[i], pose.x, pose.y,
                        std::sin(pose.phi / 2), std::cos(pose.phi / 2));
  }
  writeBytes(file, text);
}

}  // namespace submap_slam
