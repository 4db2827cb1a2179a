#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/serialization/CArchive.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/report/run_folder.h>

#include <cstdio>
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

std::vector<mrpt::math::TPoint2D> readLandmarks(const fs::path& file) {
  std::ifstream in(file);
  std::vector<mrpt::math::TPoint2D> landmarks;
  std::string line;
  std::getline(in, line);  // heading
  for (std::size_t number = 2; std::getline(in, line); ++number) {
    mrpt::math::TPoint2D p;
    if (std::sscanf(line.c_str(), "%*u,%lf,%lf", &p.x, &p.y) != 2)
      throw InputError(file.string() + ":" + std::to_string(number) + ": expected id,x,y,…");
    landmarks.push_back(p);
  }
  return landmarks;
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
  if (fs::exists(folder / "landmarks.csv")) run.landmarks = readLandmarks(folder / "landmarks.csv");
  return run;
}

}  // namespace submap_slam
