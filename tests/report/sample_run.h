#pragma once

#include <submap_slam/output/mrpt_files.h>
#include <submap_slam/output/trajectory_file.h>

#include <filesystem>
#include <string>

#include "../output/sample_results.h"
#include "../support/temp_folder.h"

namespace submap_slam {

/** Writes what compare reads of a run. */
inline std::string writeRun(const TempFolder& parent, const std::string& name, const Trajectory& trajectory,
                            const std::string& metrics, const std::string& ini) {
  const std::string folder = parent.file(name);
  std::filesystem::create_directories(folder);
  parent.write(name + "/metrics.json", metrics);
  parent.write(name + "/config.ini", ini);
  writeTum(folder + "/trajectory.tum", trajectory);
  writeGridMap(folder + "/map.gridmap.gz", sampleGrid());
  return folder;
}

}  // namespace submap_slam
