#pragma once

#include <submap_slam/rawlog/submap_log.h>

#include "log_builder.h"

namespace submap_slam {

/** A small submap that differs from those of other ids. */
inline GridSubmap::Ptr sampleSubmap(uint32_t id) {
  auto submap = GridSubmap::Create();
  submap->id = id;
  submap->timestamp = at(id);
  submap->first_frame = 10 * id;
  submap->end_frame = 10 * id + 2;
  submap->evidence = EvidenceGrid(-1, 1, -2, 2 + id, 0.1);
  *submap->evidence.log_odds.cellByIndex(3, 4) = 0.5f + static_cast<float>(id);
  *submap->evidence.hits.cellByIndex(3, 4) = 2;
  for (int k = 0; k < 2; ++k) {
    SubmapNode node;
    node.stamp = at(id + 0.1 * k);
    node.pose = {0.2 * k, 0, 0.01 * id};
    if (k == 0) node.scans.push_back(mrpt::obs::CObservation2DRangeScan::Create(scanAt(id)));
    submap->nodes.push_back(node);
  }
  submap->end_pose.mean = mrpt::poses::CPose2D(0.4, 0.1 * id, 0);
  submap->has_successor = true;
  return submap;
}

inline GridSubmaps sampleSubmaps(uint32_t first, uint32_t count) {
  GridSubmaps submaps;
  for (uint32_t k = 0; k < count; ++k) submaps.push_back(sampleSubmap(first + k));
  return submaps;
}

inline ResumeState sampleRun() {
  ResumeState run;
  run.version = "1.2.3";
  run.config_hash = "abc";
  run.log = "a.rawlog";
  run.log_bytes = 1234;
  run.log_hash = "def";
  return run;
}

}  // namespace submap_slam
