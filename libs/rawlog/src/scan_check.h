#pragma once

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <submap_slam/rawlog/log_report.h>

namespace submap_slam {

enum class ScanVerdict { kUsable, kEmpty, kTilted, kBadGeometry };

/** Whether the scan is one of a horizontal scanner with beams and a geometry that makes sense. */
ScanVerdict judge(const mrpt::obs::CObservation2DRangeScan& scan);

/** Whether all six numbers are finite. */
bool isFinite(const mrpt::math::TPose3D& pose);

/** Corrupt data can leave a bool that is neither true nor false, which must not be used as one. */
bool isSound(const bool& flag);

/** Marks beams without a usable range as invalid (see RawlogReader) and adds them to the counts. */
void invalidateBeams(mrpt::obs::CObservation2DRangeScan& scan, double min_range, ScannerReport& counts);

}  // namespace submap_slam
