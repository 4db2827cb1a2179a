#include <submap_slam/pipeline/results.h>

#include <fmt/format.h>
#include <malloc.h>
#include <submap_slam/output/graph_file.h>
#include <submap_slam/output/map_image.h>
#include <submap_slam/output/mrpt_files.h>
#include <submap_slam/output/replace_file.h>
#include <submap_slam/output/ros_map.h>
#include <submap_slam/output/run_tables.h>
#include <submap_slam/output/text_file.h>
#include <submap_slam/output/trajectory_file.h>

#include <sstream>

namespace submap_slam {

void writeMapSoFar(const OutputDirectory& out, const GridSubmaps& submaps, const JoinedMap& joined) {
  using File = std::string;
  const Trajectory trajectory = trajectoryOf(submaps, joined);
  replaceFile(out.file("map.png"),
              [&](const File& file) { writeMapImage(file, joined.map, trajectory, joined.frames); });
  replaceFile(out.file("trajectory.tum"), [&](const File& file) { writeTum(file, trajectory); });
  replaceFile(out.file("graph.g2o"),
              [&](const File& file) { writeG2o(file, joined.frames, joined.constraints); });
  replaceFile(out.file(kFramesFile), [&](const File& file) { writeFrames(file, joined.frames); });
  replaceFile(out.file(kConstraintsFile),
              [&](const File& file) { writeConstraints(file, joined.constraints); });
}

void writeResults(const OutputDirectory& out, const GridSubmaps& submaps, const JoinedMap& joined) {
  writeSimpleMap(out.file("map.simplemap"), submaps, joined);  // the last one that reads submaps
  malloc_trim(0);                                              // it had all scans in memory
  writeMapSoFar(out, submaps, joined);
  writeRosMap(out.file("map.yaml"), joined.map);
  writeGridMap(out.file("map.gridmap.gz"), joined.map);
  const Trajectory trajectory = trajectoryOf(submaps, joined);
  writeScene(out.file("map.3Dscene"), joined.map, trajectory, joined.frames);
  writeSceneLog(out.file("map.rawlog"), joined.map, trajectory, joined.frames);
}

std::string iniOf(const Configuration& config) {
  std::ostringstream ini;
  config.table.writeIni(ini);
  return ini.str();
}

void writeRunRecord(const OutputDirectory& out, const Configuration& config,
                    const std::vector<std::string>& log) {
  writeText(out.file("config.ini"), iniOf(config));
  writeText(out.file("log.txt"), fmt::format("{}\n", fmt::join(log, "\n")));
}

}  // namespace submap_slam
