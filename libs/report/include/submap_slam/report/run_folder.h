#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/math/TPoint2D.h>
#include <submap_slam/core/ini_file.h>
#include <submap_slam/eval/timed_trajectory.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace submap_slam {

/** A finished run, read back from the folder that it wrote. */
// NOLINTNEXTLINE(bugprone-exception-escape): takes asserts of the JSON library for throws
struct RunFolder {
  std::string name;                ///< of the folder
  nlohmann::ordered_json metrics;  ///< an object
  std::vector<IniEntry> settings;
  TimedTrajectory trajectory;                          ///< T_w_robot
  std::optional<mrpt::maps::COccupancyGridMap2D> map;  ///< of grid submaps
  std::vector<mrpt::math::TPoint2D> landmarks;         ///< of landmark submaps, global map frame (m)
};

/** Reads metrics.json, config.ini, trajectory.tum, and map.gridmap.gz or landmarks.csv. Throws InputError
 * naming the folder or the file if it holds no finished run or one of these cannot be read. */
RunFolder readRunFolder(const std::filesystem::path& folder);

}  // namespace submap_slam
