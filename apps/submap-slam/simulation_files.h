#pragma once

#include <submap_slam/simulation/scenario.h>

#include <cstdint>
#include <string>
#include <vector>

namespace submap_slam {

/** The files of a simulated log: one prefix, different endings. */
struct SimulationFiles {
  SimulationFiles(const std::string& prefix, const Scenario& scenario);

  std::string log;       ///< PREFIX.rawlog, written last: where it is, the others are complete
  std::string truth;     ///< PREFIX.truth.tum, the true pose at each scan
  std::string odometry;  ///< PREFIX.odometry.tum, the pose by odometry at each scan
  std::string ini;       ///< PREFIX.ini, the effective [simulation]

  // empty for a world without landmarks
  std::string map_ini;    ///< PREFIX.map.ini, what `map` has to know of the car
  std::string landmarks;  ///< PREFIX.landmarks.csv, true places (id,x,y)

  std::vector<std::string> all() const;
};

/** The scenario of a world with changes from an ini file (empty: none) and "section.key=value" settings.
 * Throws ConfigError or InputError. */
Scenario loadScenario(const std::string& world, const std::string& ini_file,
                      const std::vector<std::string>& settings);

/** The effective [simulation] of a scenario as an ini file. */
std::string scenarioIni(Scenario scenario);

/** Simulates and writes all files; returns the number of scans. Throws ConfigError or OutputError. */
std::size_t writeSimulation(const Scenario& scenario, uint64_t seed, RawlogForm form,
                            const SimulationFiles& files);

}  // namespace submap_slam
