#pragma once

#include <string>

#include <submap_slam/pipeline/configuration.h>

namespace submap_slam {

/** Which forms of submaps a run builds; at least one. */
struct MapForms {
  bool grids = true, landmarks = false;
};

/** What [mapping] maps says; where it leaves it to the log, grids if the log has laser scans near its
 * beginning, else landmarks. Errors as those of RawlogReader. */
MapForms mapForms(const std::string& log, const Configuration& config);

/** How the log is read for these forms: grids need its scans, landmarks its landmark observations, or scans
 * in which they are detected. */
ReaderParams readerParams(const Configuration& config, const MapForms& forms);

/** The detector of landmarks in scans, enabled only if landmarks are mapped. */
PoleDetectorParams detectorParams(const Configuration& config, const MapForms& forms);

/** Where submaps begin: landmarks alone are cut as [landmark_mapper] says. */
StretchParams stretchParams(const Configuration& config, const MapForms& forms);

}  // namespace submap_slam
