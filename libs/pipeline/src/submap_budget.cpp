#include <submap_slam/pipeline/submap_budget.h>

#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

namespace submap_slam {
namespace {

double heapInUse_bytes() {
  const auto heap = mallinfo2();
  return static_cast<double>(heap.uordblks) + static_cast<double>(heap.hblkhd);
}

/** Of the whole program; 0 if the system does not tell. */
double resident_bytes() {
  std::ifstream statm("/proc/self/statm");
  double size = 0, resident = 0;
  statm >> size >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

/** Gives back the holes that submaps leave in the heap, where nearly all memory is resident and a worthwhile
 * part of it came after the last time. */
class HeapTrim {
 public:
  explicit HeapTrim(double memory_bytes) : memory_(memory_bytes) {}

  void operator()() {
    constexpr double kNearlyAll = 0.9, kWorthwhile = 0.05;  // shares of the memory
    const double resident = resident_bytes();
    left_ = std::min(left_, resident);
    if (resident < kNearlyAll * memory_ || resident < left_ + kWorthwhile * memory_) return;
    malloc_trim(0);
    left_ = resident_bytes();
  }

 private:
  double memory_;
  double left_ = 0;  ///< the least that was resident since the last time (bytes)
};

}  // namespace

SubmapStore::Budget submapBudget(double memory_MB) {
  constexpr unsigned kAskedRarely = 8;  // glibc walks over all its free chunks to answer
  return [memory = 1e6 * memory_MB, calls = 0u, others = 0.0,
          trim = HeapTrim(1e6 * memory_MB)](std::size_t kept_bytes) mutable {
    if (calls++ % kAskedRarely == 0) {
      trim();
      others = heapInUse_bytes() - static_cast<double>(kept_bytes);
    }
    return static_cast<std::size_t>(std::max(0.0, memory - 1e6 * kLeastMemory_MB - others));
  };
}

}  // namespace submap_slam
