/** Files that MRPT's own programs open, each a gzip-compressed MRPT archive. All functions throw OutputError.
 */
#pragma once

#include <mrpt/poses/CPosePDFGaussian.h>
#include <submap_slam/core/joined_map.h>
#include <submap_slam/core/packed_evidence.h>

#include <string>
#include <vector>

namespace submap_slam {

/** Writes an mrpt::maps::COccupancyGridMap2D (`.gridmap.gz`; int8 cells, so the evidence is clamped). */
void writeGridMap(const std::string& file, const PackedEvidence& map);

/** Writes an mrpt::maps::CSimpleMap (`.simplemap`): T_w_node of every key node, as CPose3DPDFGaussian with
 * the uncertainty of its submap's frame carried to the node, and its scans. */
void writeSimpleMap(const std::string& file, const GridSubmaps& submaps, const JoinedMap& joined);

/** Writes an mrpt::opengl::COpenGLScene (`.3Dscene`) of stock MRPT objects: the map, the trajectory as a
 * line, each submap frame T_w_s as a corner with its number and a 3-sigma ellipse of its position. */
void writeScene(const std::string& file, const PackedEvidence& map, const Trajectory& trajectory,
                const std::vector<mrpt::poses::CPosePDFGaussian>& frames);

/** Writes a rawlog with one mrpt::obs::CObservation3DScene that holds the same scene, stamped as the end of
 * the trajectory: RawLogViewer and rawlog-edit open it without any plugin. */
void writeSceneLog(const std::string& file, const PackedEvidence& map, const Trajectory& trajectory,
                   const std::vector<mrpt::poses::CPosePDFGaussian>& frames);

}  // namespace submap_slam
