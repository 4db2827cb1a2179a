#include <submap_slam/matching/submap_matcher.h>

#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;

/** Keeps the match regular along a corridor without holding it anywhere else. */
PosePrior loosePrior(const TPose2D& mean) {
  constexpr double kSigma_m = 0.5, kSigma_rad = 0.1;
  PosePrior prior;
  prior.mean = mean;
  prior.information.diagonal() << 1 / (kSigma_m * kSigma_m), 1 / (kSigma_m * kSigma_m),
      1 / (kSigma_rad * kSigma_rad);
  return prior;
}

MatchableSubmap matchable(const GridSubmap& submap, const SurfelMap& surfels,
                          const SubmapMatcherParams& params) {
  return {surfaceOf(surfels, params.surface), AgreementMap(*submap.packedEvidence(), params.agreement)};
}

}  // namespace

MatchableSubmap matchable(const GridSubmap& submap, const SubmapMatcherParams& params) {
  return matchable(submap, surfelMapOf(submap, params.map), params);
}

SubmapMatcher::SubmapMatcher(const GridSubmap& reference, const SubmapMatcherParams& params)
    : params_(params),
      surfels_(surfelMapOf(reference, params.map)),
      reference_(matchable(reference, surfels_, params)),
      pyramid_(*reference.packedEvidence(), params.pyramid),
      matcher_(params.matcher, params.map.search_radius) {}

MatchResult SubmapMatcher::refine(const SubmapSurface& surface, const TPose2D& start) const {
  return matcher_.match(surfels_, surface.dense, loosePrior(start));
}

/** The search takes the two faces of a thin wall for one; where the window's centre is a good guess it leads
 * to the right one. Farther away the match from there would be another place, which the search found to be
 * worse. */
const MatchResult& SubmapMatcher::better(const MatchResult& from_search,
                                         const MatchResult& from_centre) const {
  const TPose2D apart = from_centre.pose - from_search.pose;
  const bool same_place = std::hypot(apart.x, apart.y) <= params_.rivals.distance &&
                          std::abs(mrpt::math::wrapToPi(apart.phi)) <= params_.rivals.turn;
  return same_place && from_centre.cost < from_search.cost ? from_centre : from_search;
}

std::optional<SubmapMatch> SubmapMatcher::match(const MatchableSubmap& other,
                                                const PoseWindow& window) const {
  const SubmapSurface& surface = other.surface;
  const auto found = searchWindow(pyramid_, surface.sparse, window, params_.min_score);
  if (!found) return std::nullopt;
  const MatchResult refined = better(refine(surface, found->pose), refine(surface, window.centre));

  SubmapMatch match;
  match.T_ref_other = refined.pose;
  match.information = refined.information;
  match.searched = *found;
  const MapAgreement there = agreementOf(surface.dense, reference_.map, match.T_ref_other);
  const MapAgreement back = agreementOf(reference_.surface.dense, other.map, TPose2D() - match.T_ref_other);
  match.hit_share = std::max(there.hit_share, back.hit_share);
  match.agreement = std::min(there.agreement, back.agreement);
  return match;
}

double SubmapMatcher::rivalScore(const MatchableSubmap& other, const PoseWindow& window,
                                 const SubmapMatch& match) const {
  return searchRival(pyramid_, other.surface.sparse, window, match.searched, params_.rivals);
}

}  // namespace submap_slam
