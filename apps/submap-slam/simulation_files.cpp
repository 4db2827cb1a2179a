#include "simulation_files.h"

#include <submap_slam/output/replace_file.h>
#include <submap_slam/output/text_file.h>
#include <submap_slam/output/trajectory_file.h>

#include <sstream>
#include <utility>

namespace submap_slam {

SimulationFiles::SimulationFiles(const std::string& prefix, const Scenario& scenario)
    : log(prefix + ".rawlog"),
      truth(prefix + ".truth.tum"),
      odometry(prefix + ".odometry.tum"),
      ini(prefix + ".ini"),
      map_ini(scenario.hasLandmarks() ? prefix + ".map.ini" : ""),
      landmarks(scenario.hasLandmarks() ? prefix + ".landmarks.csv" : "") {}

std::vector<std::string> SimulationFiles::all() const {
  std::vector<std::string> files{log, truth, odometry, ini};
  for (const std::string& file : {map_ini, landmarks})
    if (!file.empty()) files.push_back(file);
  return files;
}

Scenario loadScenario(const std::string& world, const std::string& ini_file,
                      const std::vector<std::string>& settings) {
  Scenario scenario = makeScenario(world);
  ParameterTable table;
  describe(table, scenario);
  if (!ini_file.empty()) table.loadIni(ini_file);
  for (const auto& setting : settings) table.set(setting);
  return scenario;
}

namespace {

template <class Params>
std::string iniOf(Params params) {
  ParameterTable table;
  describe(table, params);
  std::ostringstream ini;
  table.writeIni(ini);
  return ini.str();
}

}  // namespace

std::string scenarioIni(Scenario scenario) { return iniOf(std::move(scenario)); }

std::size_t writeSimulation(const Scenario& scenario, uint64_t seed, RawlogForm form,
                            const SimulationFiles& files) {
  const SimulatedLog log = simulate(scenario, seed);
  writeText(files.ini, scenarioIni(scenario));
  writeTum(files.truth, log.truth);
  writeTum(files.odometry, odometryOf(log.frames));
  if (!files.map_ini.empty()) writeText(files.map_ini, iniOf(vehicleOf(scenario.control)));
  if (!files.landmarks.empty()) writeTrueLandmarks(files.landmarks, log.landmarks);
  replaceFile(files.log, [&](const std::string& file) { writeRawlog(file, log, form); });
  return log.frames.size();
}

}  // namespace submap_slam
