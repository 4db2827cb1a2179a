#include "results.h"

#include <fmt/format.h>
#include <submap_slam/output/graph_file.h>
#include <submap_slam/output/map_image.h>
#include <submap_slam/output/mrpt_files.h>
#include <submap_slam/output/ros_map.h>
#include <submap_slam/output/text_file.h>
#include <submap_slam/output/trajectory_file.h>

#include <sstream>

namespace submap_slam {

void writeResults(const OutputDirectory& out, const GridSubmaps& submaps, const JoinedMap& joined) {
  const Trajectory trajectory = trajectoryOf(submaps, joined);
  writeMapImage(out.file("map.png"), joined.map, trajectory, joined.frames);
  writeRosMap(out.file("map.yaml"), joined.map);
  writeGridMap(out.file("map.gridmap.gz"), joined.map);
  writeSimpleMap(out.file("map.simplemap"), submaps, joined);
  writeScene(out.file("map.3Dscene"), joined.map, trajectory, joined.frames);
  writeTum(out.file("trajectory.tum"), trajectory);
  writeG2o(out.file("graph.g2o"), joined.frames, joined.constraints);
  writeConstraints(out.file("constraints.csv"), joined.constraints);
}

void writeRunRecord(const OutputDirectory& out, const Configuration& config,
                    const std::vector<std::string>& log) {
  std::ostringstream ini;
  config.table.writeIni(ini);
  writeText(out.file("config.ini"), ini.str());
  writeText(out.file("log.txt"), fmt::format("{}\n", fmt::join(log, "\n")));
}

}  // namespace submap_slam
