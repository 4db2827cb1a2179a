#include <submap_slam/pipeline/map_forms.h>

#include <submap_slam/core/errors.h>

#include <limits>

namespace submap_slam {
namespace {

bool hasLaserScans(const std::string& log, const ReaderParams& params) {
  constexpr int kFrames = 200;
  RawlogReader reader(log, params);
  bool landmarks = false;
  try {
    for (int k = 0; k < kFrames; ++k) {
      const auto frame = reader.next();
      if (!frame) break;
      if (!frame->scans.empty()) return true;
      landmarks = landmarks || !frame->landmark_scans.empty();
    }
  } catch (const InputError&) {
    // whoever reads the log to map it says what is wrong with it
  }
  return !landmarks;
}

}  // namespace

MapForms mapForms(const std::string& log, const Configuration& config) {
  if (config.maps == "grid") return {true, false};
  if (config.maps == "landmarks") return {false, true};
  if (config.maps == "grid, landmarks") return {true, true};
  const bool grids = hasLaserScans(log, config.reader);
  return {grids, !grids};
}

ReaderParams readerParams(const Configuration& config, const MapForms& forms) {
  ReaderParams params = config.reader;
  const bool detected = detectorParams(config, forms).enabled;
  params.use_scans = forms.grids || detected;
  params.use_landmarks = forms.landmarks && !detected;
  return params;
}

PoleDetectorParams detectorParams(const Configuration& config, const MapForms& forms) {
  PoleDetectorParams params = config.detector;
  params.enabled = params.enabled && forms.landmarks;
  return params;
}

StretchParams stretchParams(const Configuration& config, const MapForms& forms) {
  StretchParams params = config.stretches;
  if (forms.grids) return params;
  params.warm_up_keys = 0;
  params.max_distance = config.landmark_mapper.max_distance;
  if (!config.landmark_mapper.single_map) return params;
  params.max_distance = std::numeric_limits<double>::infinity();
  params.max_nodes = std::numeric_limits<int>::max();
  params.max_duration = 0;
  return params;
}

}  // namespace submap_slam
