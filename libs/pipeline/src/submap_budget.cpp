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
  return [memory_MB](std::size_t kept_bytes) {
    const double others = heapInUse_bytes() - static_cast<double>(kept_bytes);
    return static_cast<std::size_t>(std::max(0.0, 1e6 * (memory_MB - kLeastMemory_MB) - others));
  };
}

}  // namespace submap_slam
