#pragma once

#include <submap_slam/rawlog/submap_store.h>

namespace submap_slam {

/** Programs and libraries, and what a map and its writers take when no submap is read any more (MB). */
constexpr double kLeastMemory_MB = 130;

/** Lets a SubmapStore keep what everything else on the heap leaves of that much memory (MB). */
SubmapStore::Budget submapBudget(double memory_MB);

}  // namespace submap_slam
