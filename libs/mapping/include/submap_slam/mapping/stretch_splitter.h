#pragma once

#include <submap_slam/core/local_mapper.h>
#include <submap_slam/core/parameters.h>

#include <optional>

namespace submap_slam {

/** Where submaps begin: decided from odometry and stamps alone, before and independently of any matching. */
struct StretchParams {
  double max_distance = 10.0;  ///< m of odometry path
  int max_nodes = 400;         ///< frames with motion
  double max_duration = 0;     ///< s, 0 = unlimited
  int warm_up_keys = 15;       ///< key scans
  double key_distance = 0.15;  ///< m
  double key_angle = 0.1;      ///< rad
};

void describe(ParameterTable& table, StretchParams& params);

/** Cuts the stream of frames into stretches, each carrying the warm-up frames before it and the first frame
 * after it. Logs without odometry are cut by nodes and time. */
class StretchSplitter {
 public:
  explicit StretchSplitter(const StretchParams& params) : params_(params) {}

  /** Takes the next frame; gives a stretch when this frame is the first of the next one. */
  std::optional<Stretch> push(Frame frame);

  /** The last stretch, if any frame was pushed. */
  std::optional<Stretch> finish();

 private:
  bool closes(const Frame& frame) const;
  void startNext();

  StretchParams params_;
  Stretch current_;
  double distance_ = 0;  ///< odometry path of the own frames (m)
  int nodes_ = 0;        ///< own frames with motion
};

}  // namespace submap_slam
