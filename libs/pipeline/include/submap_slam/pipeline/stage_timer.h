#pragma once

#include <chrono>
#include <string>

namespace submap_slam {

/** Wall time, and CPU time summed over all threads of the process (s). */
struct ElapsedTime {
  double wall_s = 0, cpu_s = 0;
};

/** What a stage of a run took. */
struct StageRecord {
  std::string name;
  ElapsedTime time;
  double peak_memory_mb = 0;  ///< of the process, until the end of the stage
};

/** Times one stage of a run. */
class StageTimer {
 public:
  StageTimer();
  ElapsedTime elapsed() const;

  /** What the stage took until now. */
  StageRecord record(const std::string& name) const;

 private:
  std::chrono::steady_clock::time_point wall_start_;
  double cpu_start_s_;
};

/** Largest resident memory of the process so far (MB = 10⁶ bytes). */
double peakMemoryMb();

}  // namespace submap_slam
