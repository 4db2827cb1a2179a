#pragma once

#include <cmath>
#include <cstddef>

namespace submap_slam {

/** When an incremental run makes its next map: when there are `growth` times the submaps of the last one,
 * rounded. */
class UpdateSchedule {
 public:
  /** @param growth at least 1, which means an update after each stretch of the log */
  explicit UpdateSchedule(double growth) : growth_(growth) {}

  /** True if a map of so many submaps is due; it then counts as the last one. */
  bool take(std::size_t submaps) {
    const bool due =
        submaps > last_ && static_cast<double>(submaps) >= std::round(growth_ * static_cast<double>(last_));
    if (due) last_ = submaps;
    return due;
  }

  /** Submaps of the last map that was due. */
  std::size_t last() const { return last_; }

 private:
  double growth_;
  std::size_t last_ = 0;
};

}  // namespace submap_slam
