#pragma once

#include <chrono>

namespace submap_slam {

/** Wall time, and CPU time summed over all threads of the process (s). */
struct ElapsedTime {
  double wall_s = 0, cpu_s = 0;
};

/** Times one stage of a run. */
class StageTimer {
 public:
  StageTimer();
  ElapsedTime elapsed() const;

 private:
  std::chrono::steady_clock::time_point wall_start_;
  double cpu_start_s_;
};

/** Largest resident memory of the process so far (MB = 10⁶ bytes). */
double peakMemoryMb();

}  // namespace submap_slam
