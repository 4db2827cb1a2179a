#pragma once

#include <submap_slam/core/local_mapper.h>
#include <submap_slam/core/parameters.h>
#include <submap_slam/mapping/extent_forecast.h>

#include <optional>
#include <string>

namespace submap_slam {

/** Where submaps begin: decided from odometry, stamps and the form of the scans alone, before and
 * independently of any matching. */
struct StretchParams {
  std::string extent = "fixed";  ///< or "auto": see ExtentForecast
  double max_distance = 10.0;    ///< m of odometry path
  int max_nodes = 400;           ///< frames with motion
  double max_duration = 0;       ///< s, 0 = unlimited
  double max_blur = 0.1;         ///< cells of the evidence; this and the next two for "auto"
  double min_overlap = 0.2;      ///< share
  double max_overlap = 0.67;     ///< share
  int warm_up_keys = 15;         ///< key scans
  double key_distance = 0.15;    ///< m
  double key_angle = 0.1;        ///< rad
};

void describe(ParameterTable& table, StretchParams& params);

/** Cuts the stream of frames into stretches, each carrying the warm-up frames before it and the first frame
 * after it. Logs without odometry are cut by nodes and time.
 *
 * With the extent "auto" a submap ends when the drift that is to be expected in it blurs its surfaces by
 * `max_blur`. It must not end while it shares more than `max_overlap` with the next one, because the time of
 * joining goes with 1 / (1 − overlap), and must end when it shares less than `min_overlap`, which would leave
 * it loose. */
class StretchSplitter {
 public:
  /** @param mapper that will map the stretches; only "auto" looks at it. Throws ConfigError if the parameters
   * contradict each other. */
  explicit StretchSplitter(const StretchParams& params, const GridMapperParams& mapper = {});

  /** Takes the next frame; gives a stretch when this frame is the first of the next one. */
  std::optional<Stretch> push(Frame frame);

  /** The last stretch, if any frame was pushed. */
  std::optional<Stretch> finish();

 private:
  bool closes(const Frame& frame) const;
  bool reachesItsExtent() const;
  void startNext();

  StretchParams params_;
  double max_blur_m_;
  std::optional<ExtentForecast> forecast_;  ///< of the current stretch's own frames, for "auto"
  Stretch current_;
  double distance_ = 0;  ///< odometry path of the own frames (m)
  int nodes_ = 0;        ///< own frames with motion
};

}  // namespace submap_slam
