#include "unknown_association.h"

#include <algorithm>

#include "merging.h"
#include "prediction.h"
#include "sequential_filter.h"

namespace submap_slam::landmark_joining {
namespace {

using Kind = FeatureAssociation::Kind;

/** What to do with each feature of a submap. */
struct Decision {
  Kind kind = Kind::kNew;
  int landmark = -1;  ///< of a match
  double distance2 = 0;
};

class SequentialAssociation {
 public:
  SequentialAssociation(const AssociationOptions& options, const GaussNewtonOptions& gauss_newton)
      : options_(options), filter_({true, 0.01, gauss_newton}) {}

  /** Room for the observations must be there from the start, as the filter points to them. */
  void reserve(std::size_t submaps) { associated_.observations.reserve(submaps); }

  bool add(const LandmarkSubmap& submap) {
    const std::vector<Decision> decisions = decide(submap);
    std::vector<bool> keep;
    std::vector<int> landmarks;
    for (std::size_t i = 0; i < decisions.size(); ++i) {
      const SubmapFeature& feature = submap.features[i];
      keep.push_back(decisions[i].kind != Kind::kDropped);
      uint32_t id = 0;
      if (keep.back()) id = place(decisions[i], feature.hits, landmarks);
      associated_.associations.push_back(
          {submap.id, feature.id, decisions[i].kind, id, decisions[i].distance2});
    }
    associated_.observations.push_back(observationOf(submap, keep));
    return filter_.fuse(associated_.observations.back(), landmarks);
  }

  UnknownAssociation result() && {
    associated_.problem = filter_.problem();
    return {std::move(associated_), filter_.state()};
  }

 private:
  std::vector<Decision> decide(const LandmarkSubmap& submap);

  /** Id of the landmark of a feature, a new one if need be. */
  uint32_t place(const Decision& decision, uint32_t hits, std::vector<int>& landmarks) {
    int landmark = decision.landmark;
    if (decision.kind == Kind::kNew) {
      landmark = static_cast<int>(associated_.hits.size());
      associated_.hits.push_back(0);
      associated_.landmark_ids.push_back(static_cast<uint32_t>(landmark) + 1);
    }
    landmarks.push_back(landmark);
    associated_.hits[static_cast<std::size_t>(landmark)] += hits;
    return associated_.landmark_ids[static_cast<std::size_t>(landmark)];
  }

  AssociationOptions options_;
  AssociatedProblem associated_;
  SequentialFilter filter_;
};

std::vector<Decision> SequentialAssociation::decide(const LandmarkSubmap& submap) {
  std::vector<Decision> decisions(submap.features.size());
  if (filter_.form() == nullptr || submap.features.empty()) return decisions;
  const Prediction prediction =
      predictLandmarks(*filter_.form(), filter_.state(), submap.radius() + options_.search_margin_m);
  const auto rows = 2 * static_cast<Eigen::Index>(submap.features.size());
  Eigen::VectorXd z(rows);
  for (std::size_t i = 0; i < submap.features.size(); ++i)
    z.segment<2>(2 * static_cast<Eigen::Index>(i)) << submap.features[i].x, submap.features[i].y;
  const Eigen::MatrixXd q = submap.covariance.asEigen().bottomRightCorner(rows, rows);
  const Comparison comparison = compare(prediction, z, q, options_.match_gate);

  for (std::size_t i = 0; i < decisions.size(); ++i) {
    decisions[i].distance2 = comparison.nearest2[i];
    if (comparison.nearest2[i] <= options_.new_gate) decisions[i].kind = Kind::kDropped;
  }
  const auto& candidates = comparison.candidates;
  for (const std::size_t i :
       options_.joint_search ? jointCompatibility(candidates) : nearestNeighbours(candidates)) {
    const Pairing& pairing = candidates.pairings[i];
    decisions[static_cast<std::size_t>(pairing.feature)] = {Kind::kMatched, pairing.landmark,
                                                            pairing.distance2};
  }
  return decisions;
}

}  // namespace

std::optional<UnknownAssociation> associateByPosition(const LandmarkSubmaps& submaps,
                                                      const AssociationOptions& options,
                                                      const GaussNewtonOptions& gauss_newton,
                                                      const std::function<bool(double)>& progress) {
  SequentialAssociation association(options, gauss_newton);
  association.reserve(submaps.size());
  for (std::size_t k = 0; k < submaps.size(); ++k) {
    if (!association.add(*submaps[k])) return std::nullopt;
    const double share = static_cast<double>(k + 1) / static_cast<double>(submaps.size());
    if (progress && !progress(share * share)) return std::nullopt;
  }
  UnknownAssociation result = std::move(association).result();
  InformationForm form(result.associated.problem);
  const auto joined = minimise(result.associated.problem, form, result.state, gauss_newton, {});
  if (joined.status == JoinStatus::kFailed) return std::nullopt;
  if (options.merge) mergeDuplicates(result.associated, result.state, options.match_gate, gauss_newton);
  return result;
}

}  // namespace submap_slam::landmark_joining
