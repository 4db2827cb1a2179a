#pragma once

#include <mrpt/math/TPose2D.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/opengl/Visualizable.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <submap_slam/core/evidence_grid.h>
#include <submap_slam/core/packed_evidence.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace submap_slam {

/** One frame of the log, placed in the submap. */
struct SubmapNode {
  mrpt::Clock::time_point stamp;

  /** T_s_node: robot pose in the local map frame, matched to the submap (m, rad). */
  mrpt::math::TPose2D pose;

  /** T_odom_node, if the log has odometry there. */
  std::optional<mrpt::math::TPose2D> odometry;

  /** The scans, kept for key nodes only (those inserted into the evidence); empty otherwise. */
  std::vector<mrpt::obs::CObservation2DRangeScan::Ptr> scans;

  bool isKey() const { return !scans.empty(); }
};

/** How the submap came about, for reports. */
struct SubmapStatistics {
  float match_score_mean = 0, match_score_min = 0,
        match_score_max = 0;     ///< share of beams explained by the map, [0, 1]
  uint32_t rescues = 0;          ///< scans for which the correlative search replaced the matcher's result
  uint32_t max_particles = 1;    ///< most hypotheses alive at once
  uint32_t resamplings = 0;      ///< times the filter was resampled
  uint32_t ambiguous_scans = 0;  ///< scans during which more than one hypothesis was alive
  std::string closed_because;    ///< decision rule that closed the submap
};

/** A grid submap: evidence in its own local map frame, and every scan pose in that frame.
 *
 * Being an MRPT observation, a file of submaps is a rawlog which rawlog-edit and RawLogViewer can open when
 * this library is loaded as a plugin. The local map frame is the robot pose at the first node.
 */
class GridSubmap : public mrpt::obs::CObservation, public mrpt::opengl::Visualizable {
  DEFINE_SERIALIZABLE(GridSubmap, submap_slam)

 public:
  uint32_t id = 0;           ///< position in the sequence, from 0
  uint64_t first_frame = 0;  ///< Frame::index of the first node
  uint64_t end_frame = 0;    ///< Frame::index of the frame at `end_pose` (first frame of the next submap)

  /** Empty while unloaded, see unload(); whoever reads it takes a LoadedEvidence. */
  mutable EvidenceGrid evidence;
  std::vector<SubmapNode> nodes;  ///< one for each frame in [first_frame, end_frame), in log order

  /** T_s_end: frame `end_frame`, where the next submap starts, with covariance (m², m·rad, rad²). For the
   * last submap of a log it is the pose of the last node. */
  mrpt::poses::CPosePDFGaussian end_pose;

  /** True if the next submap starts at `end_pose`; false for the last one of a log. */
  bool has_successor = false;

  SubmapStatistics statistics;

  /** Bounding radius around the frame origin of the observed cells (m). */
  double radius() const;

  /** Length of the node trajectory (m). */
  double pathLength() const;

  std::size_t keyNodes() const;

  /** False after unload(), until load(). */
  bool evidenceIsLoaded() const { return !packed_; }

  /** Cell size of the evidence, loaded or not (m). */
  double resolution() const { return packed_ ? packed_->resolution() : evidence.resolution(); }

  /** What unload() keeps; null while the evidence is loaded. */
  std::shared_ptr<const PackedEvidence> packedEvidence() const { return packed_; }

  // mrpt::obs::CObservation
  /** Makes `evidence` the grid again that it was before unload(). As unload(), it must not run while another
   * thread uses this submap. */
  void load() const override;

  /** Keeps only the observed part of `evidence`, packed, and frees the grid: about a fifth of the memory. */
  void unload() const override;

  void getSensorPose(mrpt::poses::CPose3D& pose) const override;
  void setSensorPose(const mrpt::poses::CPose3D& pose) override;
  void getDescriptionAsText(std::ostream& out) const override;
  bool exportTxtSupported() const override { return true; }
  std::string exportTxtHeader() const override;
  std::string exportTxtDataRow() const override;

  // mrpt::opengl::Visualizable: the grid and the node trajectory in the local map frame
  void getVisualizationInto(mrpt::opengl::CSetOfObjects& out) const override;

 private:
  mutable std::shared_ptr<const PackedEvidence> packed_;
};

/** The evidence of a submap to read from, whether it is loaded or not: an unloaded one is unpacked for as
 * long as this lives, and the submap is left as it is. */
class LoadedEvidence {
 public:
  explicit LoadedEvidence(const GridSubmap& submap) : submap_(submap) {
    if (const auto packed = submap.packedEvidence()) unpacked_ = packed->unpacked();
  }

  const EvidenceGrid& operator*() const { return unpacked_ ? *unpacked_ : submap_.evidence; }
  const EvidenceGrid* operator->() const { return &**this; }

 private:
  const GridSubmap& submap_;
  std::optional<EvidenceGrid> unpacked_;
};

/** The packed evidence of a submap, which stays as it is: what it keeps if it is unloaded, else packed now.
 */
std::shared_ptr<const PackedEvidence> packedEvidenceOf(const GridSubmap& submap);

}  // namespace submap_slam
