#pragma once

#include <submap_slam/core/joined_map.h>
#include <submap_slam/matching/submap_matcher.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "frame_graph.h"
#include "hand_edits.h"

namespace submap_slam::pose_graph {

/** How far the chain of end poses may be off. */
struct ChainNoise {
  double usual_xy_per_m = 0.004;    ///< m per √m of path, beside the covariance of the end pose
  double usual_phi_per_m = 0.0007;  ///< rad per √m of path
  double sigma_xy_per_m = 0.02;     ///< m per √m of path
  double sigma_phi_per_m = 0.005;   ///< rad per √m of path
  double odometry_share = 0.25;     ///< share of the difference between end pose and odometry
  double max_xy = 2.0;              ///< m, cap of that share
  double max_phi = 0.5;             ///< rad, cap of that share
};

struct LoopSearchParams {
  SubmapMatcherParams matcher;
  ChainNoise chain;
  double known = 0.1;           ///< m; pairs whose relation is known better are not searched
  double margin_xy = 0.6;       ///< m, of the window beyond 3 σ
  double margin_phi = 0.05;     ///< rad
  double max_window = 40;       ///< m
  double max_window_phi = 0.8;  ///< rad
  double sight = 10;            ///< m beyond their paths that two submaps may share something
  double min_hit_share = 0.3;
  double min_agreement = 0.75;
  double rival_window = 1.0;       ///< m; in wider windows a rival makes a match ambiguous
  double lone_window = 1.2;        ///< m; in wider windows a match needs another one that agrees
  int witnesses_from = 6;          ///< submaps among which that one must be
  double match_sigma_xy = 0.05;    ///< m, of a match beside what its information says
  double match_sigma_phi = 0.01;   ///< rad
  double usual_match_xy = 0.01;    ///< m, of a match beside what its information says, as it usually is
  double usual_match_phi = 0.002;  ///< rad
};

/** The submap graph after the search, and every candidate with what became of it. */
struct LoopSearchResult {
  FrameGraph graph;
  std::vector<Constraint> candidates;
  bool stopped = false;  ///< the rest of the submaps only follows the chain
};

/** Closes loops: submaps in time order are matched to all older ones that they may overlap, as far as the
 * graph so far says; matches that pass the gates and are borne out by another one go into the graph, which is
 * optimised before the next submap.
 *
 * What is found for a submap depends on it and the older ones alone, so the search goes on where it was when
 * submaps are added: the result has the same bits as that of a new search.
 */
class LoopSearch {
 public:
  explicit LoopSearch(const LoopSearchParams& params);
  ~LoopSearch();
  LoopSearch(const LoopSearch&) = delete;
  LoopSearch& operator=(const LoopSearch&) = delete;

  /** Searches the submaps that no call before has searched.
   * @param submaps  those of the call before, and any number behind them
   * @param progress called with the share done; false from it ends the search early
   * @param by_hand  its links are in the graph from the newer submap on; no match of a refused pair is used
   */
  LoopSearchResult search(const GridSubmaps& submaps, const std::function<bool(double)>& progress,
                          const HandEdits& by_hand = {});

  /** The frames of the submaps that were searched so far, T_w_s (m, rad). */
  const std::vector<mrpt::math::TPose2D>& frames() const;

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace submap_slam::pose_graph
