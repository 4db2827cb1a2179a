#pragma once

#include "covariances.h"

namespace submap_slam::landmark_joining {

/** Continues an estimate of the first submaps by those behind them without joining: end poses one after the
 * other, and each landmark that is not in the estimate yet as the first submap saw it; covariances to first
 * order. */
void chainOn(const JointProblem& problem, Estimate& estimate);

/** The estimate without any joining. */
Estimate chained(const JointProblem& problem);

}  // namespace submap_slam::landmark_joining
