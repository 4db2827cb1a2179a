#include <submap_slam/simulation/scenario.h>

namespace submap_slam {
namespace {

Scenario atSpeed(const std::string& world, double speed) {
  Scenario scenario = makeScenario(world);
  scenario.drive.max_speed = speed;
  return scenario;
}

/** Fewer scans and beams, so that the file is small; odometry then errs at every scan. */
Scenario small(const std::string& world) {
  Scenario scenario = makeScenario(world);
  scenario.scan_rate = 3;
  scenario.laser.beams = 181;
  scenario.odometry.fixed_every = 1;
  return scenario;
}

void writeExample(const std::string& stem, const Scenario& scenario, RawlogForm form, uint64_t seed) {
  const SimulatedLog log = simulate(scenario, seed);
  writeRawlog(stem + ".rawlog", log, form);
  writeTruth(stem + ".truth.tum", log.truth);
  if (!log.landmarks.empty()) writeTrueLandmarks(stem + ".landmarks.csv", log.landmarks);
}

}  // namespace

void writeExampleLogs(const std::string& folder) {
  const std::string in = folder + "/";
  writeExample(in + "room", atSpeed("room", 0.8), RawlogForm::kObservations, 1);
  writeExample(in + "corridor_sf", atSpeed("corridor", 1.0), RawlogForm::kActions, 2);
  writeExample(in + "loop", atSpeed("loop", 1.0), RawlogForm::kObservations, 3);
  writeExample(in + "non_convex", small("non_convex"), RawlogForm::kObservations, 4);
  writeExample(in + "long_corridors", small("long_corridors"), RawlogForm::kObservations, 5);
  writeExample(in + "landmarks", makeScenario("landmarks_block"), RawlogForm::kObservations, 6);
}

}  // namespace submap_slam
