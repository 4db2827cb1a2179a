#pragma once

#include <submap_slam/mapping/scan_matcher.h>
#include <submap_slam/matching/branch_and_bound.h>
#include <submap_slam/matching/map_agreement.h>
#include <submap_slam/matching/submap_surface.h>
#include <Eigen/Core>

#include <optional>

namespace submap_slam {

struct SubmapMatcherParams {
  SurfelMapParams map;
  MatcherParams matcher;
  ScorePyramidParams pyramid;
  SurfaceParams surface;
  AgreementParams agreement;
  RivalParams rivals;
  double min_score = 0.42;  ///< of the search of the window
};

/** What a submap shows to others that it is matched to, small enough to be kept for all submaps. */
struct MatchableSubmap {
  SubmapSurface surface;
  AgreementMap map;
};
MatchableSubmap matchable(const GridSubmap& submap, const SubmapMatcherParams& params = {});

/** Where another submap fits best into a reference submap, and how well. */
struct SubmapMatch {
  mrpt::math::TPose2D T_ref_other;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< Hessian of the point-to-line match at that pose
  WindowMatch searched;                                   ///< what the search of the window found
  double hit_share = 0;  ///< of the better direction: other's surfaces in the reference or the reverse
  double agreement = 0;  ///< with free space, of the worse direction
};

/** A submap to which others are matched: by branch and bound in a window, then by points to lines.
 *
 * Holds the matching map of the reference, a few MB; any number of threads may match to it at once.
 */
class SubmapMatcher {
 public:
  SubmapMatcher(const GridSubmap& reference, const SubmapMatcherParams& params);

  /** The reference as others need it. */
  const MatchableSubmap& reference() const { return reference_; }
  const SurfelMap& surfels() const { return surfels_; }

  /** Best match in the window of T_ref_other; empty if none reaches min_score. */
  std::optional<SubmapMatch> match(const MatchableSubmap& other, const PoseWindow& window) const;

  /** See searchRival. */
  double rivalScore(const MatchableSubmap& other, const PoseWindow& window, const SubmapMatch& match) const;

 private:
  MatchResult refine(const SubmapSurface& surface, const mrpt::math::TPose2D& start) const;
  const MatchResult& better(const MatchResult& from_search, const MatchResult& from_centre) const;

  SubmapMatcherParams params_;
  SurfelMap surfels_;
  MatchableSubmap reference_;
  ScorePyramid pyramid_;
  ScanMatcher matcher_;
};

}  // namespace submap_slam
