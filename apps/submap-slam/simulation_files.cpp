#include "simulation_files.h"

#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/output/trajectory_file.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace submap_slam {
namespace fs = std::filesystem;
namespace {

Trajectory odometryOf(const SimulatedLog& log) {
  Trajectory trajectory;
  for (const Frame& frame : log.frames) trajectory.push_back({frame.stamp, *frame.odometry});
  return trajectory;
}

void writeText(const std::string& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.close();
  if (!out) throw OutputError(fmt::format("{}: cannot be written", file));
}

}  // namespace

SimulationFiles::SimulationFiles(const std::string& prefix)
    : log(prefix + ".rawlog"),
      truth(prefix + ".truth.tum"),
      odometry(prefix + ".odometry.tum"),
      ini(prefix + ".ini") {}

Scenario loadScenario(const std::string& world, const std::string& ini_file,
                      const std::vector<std::string>& settings) {
  Scenario scenario = makeScenario(world);
  ParameterTable table;
  describe(table, scenario);
  if (!ini_file.empty()) table.loadIni(ini_file);
  for (const auto& setting : settings) table.set(setting);
  return scenario;
}

std::string scenarioIni(Scenario scenario) {
  ParameterTable table;
  describe(table, scenario);
  std::ostringstream ini;
  table.writeIni(ini);
  return ini.str();
}

std::size_t writeSimulation(const Scenario& scenario, uint64_t seed, RawlogForm form,
                            const SimulationFiles& files) {
  const SimulatedLog log = simulate(scenario, seed);
  writeText(files.ini, scenarioIni(scenario));
  writeTum(files.truth, log.truth);
  writeTum(files.odometry, odometryOf(log));
  const std::string unfinished = files.log + ".part";
  writeRawlog(unfinished, log, form);
  fs::rename(unfinished, files.log);
  return log.frames.size();
}

}  // namespace submap_slam
