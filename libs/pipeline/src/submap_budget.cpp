#include <submap_slam/pipeline/submap_budget.h>

#include <malloc.h>

#include <algorithm>

namespace submap_slam {
namespace {

double heapInUse_bytes() {
  const auto heap = mallinfo2();
  return static_cast<double>(heap.uordblks) + static_cast<double>(heap.hblkhd);
}

}  // namespace

SubmapStore::Budget submapBudget(double memory_MB) {
  constexpr unsigned kAskedRarely = 8;  // glibc walks over all its free chunks to answer
  return [memory_MB, calls = 0u, others = 0.0](std::size_t kept_bytes) mutable {
    if (calls++ % kAskedRarely == 0) others = heapInUse_bytes() - static_cast<double>(kept_bytes);
    return static_cast<std::size_t>(std::max(0.0, 1e6 * (memory_MB - kLeastMemory_MB) - others));
  };
}

}  // namespace submap_slam
