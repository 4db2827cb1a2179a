#pragma once

#include <mrpt/math/TPose2D.h>

#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace submap_slam {

/** Tells how far a long work is and asks whether it should go on. An empty one tells nothing. */
class ProgressCallback {
 public:
  /** Called with the share done in [0, 1] and what is being done; returns false to ask for an early end. */
  using Step = std::function<bool(double fraction, const std::string& what)>;

  /** Called with T_w_s of each submap (m, rad) as an iteration left them. */
  using Frames = std::function<void(const std::vector<mrpt::math::TPose2D>&)>;

  ProgressCallback() = default;
  ProgressCallback(Step step, Frames frames) : step_(std::move(step)), frames_(std::move(frames)) {}

  /** From any function that a Step can hold. */
  template <class Function, class = std::enable_if_t<std::is_constructible_v<Step, Function>>>
  ProgressCallback(Function step) : step_(std::move(step)) {}  // NOLINT(google-explicit-constructor)

  explicit operator bool() const { return static_cast<bool>(step_); }
  bool operator()(double fraction, const std::string& what) const { return step_(fraction, what); }

  /** True if somebody watches the frames move; else they need not be made. */
  bool showsFrames() const { return static_cast<bool>(frames_); }

  /** Does nothing if nobody watches. */
  void showFrames(const std::vector<mrpt::math::TPose2D>& frames) const {
    if (frames_) frames_(frames);
  }

 private:
  Step step_;
  Frames frames_;
};

}  // namespace submap_slam
