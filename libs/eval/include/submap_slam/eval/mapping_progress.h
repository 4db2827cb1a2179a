/** What each submap adds to the map, and how well its scans were matched: the figures of Huang et al., "A
 * Construction Optimization for Laser SLAM Based on Odometer Constraint Fusion" (ITC 53(2), 2024). */
#pragma once

#include <submap_slam/core/joined_map.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace submap_slam {

/** Match scores, shares of beams explained by the map, [0, 1]. */
struct MatchScores {
  double mean = 0, min = 0, max = 0;
};

/** A submap, and where mapping stands at its end. */
struct SubmapProgress {
  uint32_t id = 0;
  std::size_t scans = 0;      ///< placed in this submap
  std::size_t nodes = 0;      ///< of these, the ones inserted into its evidence (key nodes)
  std::size_t nodes_sum = 0;  ///< in this submap and all before (Table 5)
  MatchScores score;          ///< of its scans (Table 1)
  double map_share =
      0;  ///< of the area that all submaps observe, what this one and those before do (Table 6)
  double scan_share = 0;  ///< of all scans, those in this submap and the ones before
};

/** One entry for each submap, in their order. Areas are counted in squares of 0.2 m of the global map, each
 * hit by the centre of an observed cell. Throws std::invalid_argument if there are not as many frames as
 * submaps.
 * @param frames T_w_s of each submap */
std::vector<SubmapProgress> mappingProgress(const GridSubmaps& submaps,
                                            const std::vector<mrpt::poses::CPosePDFGaussian>& frames);

/** Mean over all scans, least and greatest of all submaps (Table 2); all zero for no scans. */
MatchScores overallScores(const std::vector<SubmapProgress>& progress);

/** Share of the map after the first ⌈s n / stages⌉ of n submaps, for s = 1 … stages (Table 3); empty for no
 * submaps.
 * @param stages at least 1 */
std::vector<double> stageShares(const std::vector<SubmapProgress>& progress, std::size_t stages);

/** CSV with a heading and a line for each submap: id, scans, nodes, nodes_sum, score_mean, score_min,
 * score_max, scan_share, map_share and map_share_gain, what this submap alone added (Table 7). */
std::string progressCsv(const std::vector<SubmapProgress>& progress);

}  // namespace submap_slam
