#include <submap_slam/simulation/simulate.h>

namespace submap_slam {
namespace {

/** A recording that is bundled with the project. */
struct Example {
  std::string file;  ///< without extension
  World world;
  double max_speed;  ///< m/s
  RawlogForm form;
  uint64_t seed;
};

void writeExample(const std::string& folder, const Example& example) {
  constexpr double kScanRate = 5;  // Hz
  DriveLimits limits;
  limits.max_speed = example.max_speed;
  const Path path = drive(example.world.route, limits, kScanRate);
  const SimulatedLog log = simulate(example.world, path, LaserModel{}, OdometryModel{}, example.seed);
  const std::string stem = folder + "/" + example.file;
  writeRawlog(stem + ".rawlog", log, example.form);
  writeTruth(stem + ".truth.tum", log.truth);
}

}  // namespace

void writeExampleLogs(const std::string& folder) {
  writeExample(folder, {"room", roomWorld(), 0.8, RawlogForm::kObservations, 1});
  writeExample(folder, {"corridor_sf", corridorWorld(), 1.0, RawlogForm::kActions, 2});
  writeExample(folder, {"loop", loopWorld(), 1.0, RawlogForm::kObservations, 3});
}

}  // namespace submap_slam
