#pragma once

#include <submap_slam/viewer/viewer_model.h>

#include <cmath>

namespace submap_slam {

/** Submaps along the x axis, each with `nodes` nodes 1 m apart and a wall of occupied cells at its left. */
inline GridSubmaps straightSubmaps(uint32_t count, std::size_t nodes = 4) {
  GridSubmaps submaps;
  const auto start = mrpt::Clock::fromDouble(1e9);
  for (uint32_t k = 0; k < count; ++k) {
    auto submap = GridSubmap::Create();
    submap->id = k;
    submap->evidence = EvidenceGrid(-2, 6, -2, 2, 0.1);
    for (std::size_t cx = 0; cx < submap->evidence.sizeX(); ++cx) {
      *submap->evidence.hits.cellByIndex(static_cast<unsigned>(cx), 35) = 5;
      *submap->evidence.log_odds.cellByIndex(static_cast<unsigned>(cx), 35) = 6;
      *submap->evidence.hits.cellByIndex(static_cast<unsigned>(cx), 20) = 5;
      *submap->evidence.log_odds.cellByIndex(static_cast<unsigned>(cx), 20) = -6;
    }
    for (std::size_t n = 0; n < nodes; ++n) {
      SubmapNode node;
      node.pose = {static_cast<double>(n), 0, 0};
      node.stamp = start + std::chrono::seconds(k * nodes + n);
      if (n % 2 == 0) {
        auto scan = mrpt::obs::CObservation2DRangeScan::Create();
        scan->aperture = static_cast<float>(M_PI);
        scan->maxRange = 10;
        scan->resizeScanAndAssign(3, 2.0f, true);
        node.scans.push_back(scan);
      }
      submap->nodes.push_back(node);
    }
    submap->end_pose.mean = mrpt::poses::CPose2D(static_cast<double>(nodes), 0, 0);
    submap->end_pose.cov.setDiagonal(0.01);
    submap->has_successor = k + 1 < count;
    submaps.push_back(submap);
  }
  return submaps;
}

/** Landmark submaps of 10 m along the x axis; each sees a landmark 2 m to the left of its start and one 2 m
 * to the left of its end, which is the first of the next. */
inline LandmarkSubmaps landmarkSubmaps(uint32_t count) {
  LandmarkSubmaps submaps;
  for (uint32_t k = 0; k < count; ++k) {
    auto submap = LandmarkSubmap::Create();
    submap->id = k;
    submap->end_pose = {10, 0, 0};
    submap->features = {{k + 1, 0, 2, 1}, {k + 2, 10, 2, 1}};
    submap->covariance.setIdentity(7);
    submap->covariance *= 0.01;
    submaps.push_back(submap);
  }
  return submaps;
}

inline Constraint loop(uint32_t from, uint32_t to, bool accepted) {
  Constraint constraint;
  constraint.from = from, constraint.to = to;
  constraint.inter = true;
  constraint.accepted = accepted;
  constraint.reason = accepted ? "agrees" : "no overlap";
  return constraint;
}

/** Four submaps; loops 0-2 (accepted), 0-3 (rejected), 1-3 (accepted). */
inline ViewerModel sampleModel() {
  ViewerModel model;
  model.addSubmaps(straightSubmaps(4));
  JoinedMap joined = chainSubmaps(model.submaps());
  joined.constraints = {loop(0, 2, true), loop(0, 3, false), loop(1, 3, true)};
  model.setJoined(joined);
  return model;
}

}  // namespace submap_slam
