#include <submap_slam/pipeline/stage_timer.h>

#include <sys/resource.h>

namespace submap_slam {
namespace {

rusage usage() {
  rusage result = {};
  getrusage(RUSAGE_SELF, &result);
  return result;
}

double seconds(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

double cpuSeconds() {
  const rusage now = usage();
  return seconds(now.ru_utime) + seconds(now.ru_stime);
}

}  // namespace

StageTimer::StageTimer() : wall_start_(std::chrono::steady_clock::now()), cpu_start_s_(cpuSeconds()) {}

ElapsedTime StageTimer::elapsed() const {
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - wall_start_;
  return {wall.count(), cpuSeconds() - cpu_start_s_};
}

StageRecord StageTimer::record(const std::string& name) const { return {name, elapsed(), peakMemoryMb()}; }

double peakMemoryMb() { return static_cast<double>(usage().ru_maxrss) * 1024e-6; }

}  // namespace submap_slam
