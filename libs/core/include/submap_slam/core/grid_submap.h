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

using SubmapScans = std::vector<mrpt::obs::CObservation2DRangeScan::Ptr>;

/** One frame of the log, placed in the submap. */
struct SubmapNode {
  mrpt::Clock::time_point stamp;

  /** T_s_node: robot pose in the local map frame, matched to the submap (m, rad). */
  mrpt::math::TPose2D pose;

  /** T_odom_node, if the log has odometry there. */
  std::optional<mrpt::math::TPose2D> odometry;

  /** The scans, kept for key nodes only (those inserted into the evidence); empty otherwise, and while they
   * are stored away: whoever reads them takes GridSubmap::scans(). */
  SubmapScans scans;
  bool scans_are_stored_away = false;  ///< see GridSubmap::storeAway

  bool isKey() const { return scans_are_stored_away || !scans.empty(); }
};

/** What makes submaps large. */
struct SubmapBulk {
  std::shared_ptr<const PackedEvidence> evidence;  ///< never null
  std::vector<SubmapScans> scans;                  ///< of each node

  /** Memory it takes, roughly. */
  std::size_t bytes() const;
};

/** Where the bulk of a submap is while the submap does not hold it itself. */
class SubmapBulkSource {
 public:
  virtual ~SubmapBulkSource() = default;

  /** The bulk, never null; any number of threads may ask. Throws InputError if it cannot be read. */
  virtual std::shared_ptr<const SubmapBulk> bulk() const = 0;
};

/** What is known about the evidence of a submap without reading it. */
struct EvidenceSummary {
  double resolution = 0;              ///< m per cell
  double x_min = 0, y_min = 0;        ///< left and lower edge of the grid, local map frame (m)
  int columns = 0, rows = 0;          ///< cells
  std::size_t stored_cells = 0;       ///< PackedEvidence::storedCells
  std::size_t observed_cells = 0;     ///< those with hits > 0
  double least_log_odds_per_hit = 0;  ///< of all observed cells; 0 if there are none
};
EvidenceSummary summaryOf(const PackedEvidence& evidence);

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

  /** True for a submap that was made; false for one that was read, until load(), and after unload(). */
  bool evidenceIsLoaded() const { return loaded_; }

  /** Cell size of the evidence, loaded or not (m). */
  double resolution() const { return loaded_ ? evidence.resolution() : summary_.resolution; }

  /** Reads nothing from where the evidence is stored away. */
  EvidenceSummary evidenceSummary() const { return loaded_ ? summaryOf(*packedEvidence()) : summary_; }

  /** The evidence, wherever it is; never null. Throws InputError if it is stored away and cannot be read. */
  std::shared_ptr<const PackedEvidence> packedEvidence() const;

  /** The scans of each node, wherever they are. Throws as packedEvidence(). */
  std::vector<SubmapScans> scans() const;

  /** Evidence and scans as storeAway() expects to get them back. */
  SubmapBulk bulk() const { return {packedEvidence(), scans()}; }

  /** Drops evidence and scans, which come from `source` from now on. Not while another thread uses this
   * submap. */
  void storeAway(std::shared_ptr<const SubmapBulkSource> source);

  // mrpt::obs::CObservation
  /** Makes `evidence` the grid again that it was before unload(). As unload(), it must not run while another
   * thread uses this submap. */
  void load() const override;

  /** Keeps only the observed part of `evidence`, packed, or nothing of it if it is stored away, and frees the
   * grid: about a fifth of the memory. */
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
  void freeGrid() const;

  mutable bool loaded_ = true;
  mutable EvidenceSummary summary_;                       // while unloaded
  mutable std::shared_ptr<const PackedEvidence> packed_;  // while unloaded, unless stored away
  std::shared_ptr<const SubmapBulkSource> source_;        // if stored away
};

/** The evidence of a submap to read from, whether it is loaded or not: an unloaded one is unpacked for as
 * long as this lives, and the submap is left as it is. Throws as GridSubmap::packedEvidence(). */
class LoadedEvidence {
 public:
  explicit LoadedEvidence(const GridSubmap& submap) : submap_(submap) {
    if (!submap.evidenceIsLoaded()) unpacked_ = submap.packedEvidence()->unpacked();
  }

  const EvidenceGrid& operator*() const { return unpacked_ ? *unpacked_ : submap_.evidence; }
  const EvidenceGrid* operator->() const { return &**this; }

 private:
  const GridSubmap& submap_;
  std::optional<EvidenceGrid> unpacked_;
};

}  // namespace submap_slam
