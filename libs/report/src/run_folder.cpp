#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/serialization/CArchive.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/eval/landmark_errors.h>
#include <submap_slam/report/run_folder.h>

#include <fstream>

namespace submap_slam {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

void requireFinishedRun(const fs::path& folder) {
  if (!fs::exists(folder)) throw InputError(folder.string() + ": no such folder");
  if (!fs::is_directory(folder))
    throw InputError(folder.string() + ": is no folder, expected one that `map` or `join` wrote");
  if (!fs::exists(folder / "metrics.json"))
    throw InputError(folder.string() + ": holds no finished run of `map` or `join`: metrics.json is missing");
}

Json readMetrics(const fs::path& file) {
  std::ifstream in(file);
  Json metrics = Json::parse(in, nullptr, false);
  if (!metrics.is_object())
    throw InputError(file.string() + ": is no JSON object, expected the figures of a run");
  return metrics;
}

mrpt::maps::COccupancyGridMap2D readGridMap(const fs::path& file) {
  try {
    mrpt::io::CFileGZInputStream in(file.string());
    mrpt::maps::COccupancyGridMap2D map;
    mrpt::serialization::archiveFrom(in) >> map;
    return map;
  } catch (const std::exception&) {  // MRPT's text holds a stack trace
    throw InputError(file.string() + ": cannot be read, expected an MRPT grid map");
  }
}

}  // namespace

RunFolder readRunFolder(const fs::path& folder) {
  requireFinishedRun(folder);
  RunFolder run;
  run.name = (folder / "").parent_path().filename().string();
  run.metrics = readMetrics(folder / "metrics.json");
  run.settings = readIni((folder / "config.ini").string());
  run.trajectory = readTum((folder / "trajectory.tum").string());
  if (fs::exists(folder / "map.gridmap.gz")) run.map = readGridMap(folder / "map.gridmap.gz");
  if (fs::exists(folder / "landmarks.csv"))
    for (const auto& l : readMappedLandmarks((folder / "landmarks.csv").string()))
      run.landmarks.emplace_back(l.x, l.y);
  return run;
}

}  // namespace submap_slam
