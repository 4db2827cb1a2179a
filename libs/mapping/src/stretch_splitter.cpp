#include <submap_slam/mapping/stretch_splitter.h>

#include <mrpt/math/wrap2pi.h>
#include <mrpt/poses/CPose2D.h>
#include <submap_slam/core/errors.h>

#include <algorithm>
#include <cmath>

namespace submap_slam {
namespace {

/** Below this the robot is taken to stand still (m, rad). */
constexpr double kStillM = 1e-3, kStillRad = 1e-3;

/** Bounds the memory of a robot that stands still for hours. */
constexpr std::size_t kMaxFramesPerNode = 10;

struct Motion {
  double distance = 0, turn = 0;
  bool known = false;  ///< by odometry

  bool moves() const { return !known || distance > kStillM || turn > kStillRad; }
};

Motion motionBetween(const Frame& a, const Frame& b) {
  if (!a.odometry || !b.odometry) return {};
  return {std::hypot(b.odometry->x - a.odometry->x, b.odometry->y - a.odometry->y),
          std::abs(mrpt::math::wrapToPi(b.odometry->phi - a.odometry->phi)), true};
}

double seconds(const Frame& a, const Frame& b) {
  return mrpt::Clock::toDouble(b.stamp) - mrpt::Clock::toDouble(a.stamp);
}

}  // namespace

void describe(ParameterTable& table, StretchParams& p) {
  table.section("submaps",
                "Where submaps begin: decided from odometry, stamps and the form of the scans alone, so that "
                "submaps are "
                "independent");
  table.add("extent", p.extent,
            "Whether submaps end after max_distance, or where the drift and overlap foretold for them say so",
            {"fixed", "auto"});
  table.add("max_distance", p.max_distance, "m", {0.1, 1e6},
            "Odometry path after which the next submap begins if the extent is fixed");
  table.add("max_nodes", p.max_nodes, "", {2, 1e6}, "Frames with motion after which the next submap begins");
  table.add("max_duration", p.max_duration, "s", {0, 1e9},
            "Time after which the next submap begins; 0 = no limit");
  table.add("max_blur", p.max_blur, "", {1e-6, 1e6},
            "Extent auto: drift that may blur a submap's surfaces, in cells of the evidence");
  table.add("min_overlap", p.min_overlap, "", {0.01, 0.99},
            "Extent auto: a submap ends when it would share less than this with the next one");
  table.add(
      "max_overlap", p.max_overlap, "", {0.01, 0.99},
      "Extent auto: a submap goes on while it would share more than this; the time of joining goes with "
      "1 / (1 - overlap)");
  table.add("warm_up_keys", p.warm_up_keys, "", {0, 1000},
            "Key scans before its start that prepare a submap's matching map (never its evidence)");
  table.add("key_distance", p.key_distance, "m", {1e-3, 100},
            "Distance between key scans, by odometry, in the warm-up");
  table.add("key_angle", p.key_angle, "rad", {1e-3, 3.1416},
            "Turn between key scans, by odometry, in the warm-up");
}

StretchSplitter::StretchSplitter(const StretchParams& params, const GridMapperParams& mapper)
    : params_(params), max_blur_m_(params.max_blur * mapper.evidence.resolution) {
  if (params.min_overlap >= params.max_overlap)
    throw ConfigError("[submaps] min_overlap must be below max_overlap");
  if (params.extent == "auto") forecast_.emplace(mapper);
}

bool StretchSplitter::reachesItsExtent() const {
  if (!forecast_) return distance_ >= params_.max_distance;
  const double overlap = forecast_->overlap();
  if (overlap < params_.min_overlap) return true;
  return overlap <= params_.max_overlap && forecast_->blur() >= max_blur_m_;
}

bool StretchSplitter::closes(const Frame& frame) const {
  const Frame& first = current_.frames[current_.warm_up];
  const std::size_t own_frames = current_.frames.size() - current_.warm_up;
  return reachesItsExtent() || nodes_ >= params_.max_nodes ||
         own_frames >= kMaxFramesPerNode * static_cast<std::size_t>(params_.max_nodes) ||
         (params_.max_duration > 0 && seconds(first, frame) >= params_.max_duration);
}

void StretchSplitter::startNext() {
  Stretch next;
  next.index = current_.index + 1;
  const auto& frames = current_.frames;  // the last one is the first of the next stretch
  // Walk back from there; frames without motion tell the warm-up nothing and, for a robot that stands still,
  // never end.
  std::vector<Frame> backwards{frames.back()};
  double distance = 0, turn = 0;
  int keys = 0;
  for (std::size_t i = frames.size() - 1; i-- > 0 && keys < params_.warm_up_keys;) {
    const Motion motion = motionBetween(frames[i], backwards.back());
    if (!motion.moves()) continue;
    backwards.push_back(frames[i]);
    distance += motion.distance;
    turn += motion.turn;
    const bool has_odometry = frames[i].odometry.has_value();
    if (distance < params_.key_distance && turn < params_.key_angle && has_odometry) continue;
    ++keys;
    distance = turn = 0;
  }
  next.warm_up = backwards.size() - 1;
  next.frames.assign(backwards.rbegin(), backwards.rend());
  current_ = std::move(next);
  if (forecast_) forecast_->begin(current_.frames.back());
  distance_ = 0;
  nodes_ = 1;
}

std::optional<Stretch> StretchSplitter::push(Frame frame) {
  const bool first = current_.frames.empty();
  const Motion motion = first ? Motion{} : motionBetween(current_.frames.back(), frame);
  distance_ += motion.distance;
  if (motion.moves()) ++nodes_;
  if (forecast_) first ? forecast_->begin(frame) : forecast_->add(frame);
  const bool close = !first && closes(frame);
  current_.frames.push_back(std::move(frame));
  if (!close) return std::nullopt;
  Stretch done = current_;
  startNext();
  return done;
}

std::optional<Stretch> StretchSplitter::finish() {
  if (current_.frames.empty()) return std::nullopt;
  current_.last = true;
  Stretch done = std::move(current_);
  current_ = {};
  return done;
}

}  // namespace submap_slam
