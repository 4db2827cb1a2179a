#include "unknown_association.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "merging.h"
#include "prediction.h"

namespace submap_slam::landmark_joining {
namespace {

using Kind = FeatureAssociation::Kind;
constexpr double kNoNeighbour = std::numeric_limits<double>::infinity();

/** What to do with each feature of a submap. */
struct Decision {
  Kind kind = Kind::kNew;
  int landmark = -1;  ///< of a match
  double distance2 = kNoNeighbour;
};

/** A prediction into a submap need not be exact to the last digit. h is linear but for the headings: a change
 * of 0.02 rad leaves an error of 0.02 m over 100 m. */
SequentialOptions whileAssociating() {
  SequentialOptions options;
  options.relinearise_above_m = 1;
  options.relinearise_above_rad = 0.02;
  options.gauss_newton.max_step_m = 0.02;
  options.gauss_newton.max_step_rad = 1e-3;
  return options;
}

/** Features in a square metre (1/m²) of the area that they are spread over. */
double densityOf(const Eigen::VectorXd& z) { return static_cast<double>(z.size()) / 2 / areaOf(z); }

class SequentialAssociation {
 public:
  explicit SequentialAssociation(const AssociationOptions& options)
      : options_(options), filter_(whileAssociating()) {}

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

  /** After all others: keeps only the end pose of a submap. */
  void leaveOut(const LandmarkSubmap& submap) {
    for (const auto& feature : submap.features)
      associated_.associations.push_back({submap.id, feature.id, Kind::kDropped, 0, kNoNeighbour});
    associated_.observations.push_back(observationOf(submap, std::vector<bool>(submap.features.size())));
  }

  UnknownAssociation result() && {
    const std::size_t associated_submaps = filter_.problem().submaps();
    JointProblem& problem = associated_.problem = filter_.problem();
    JointState state = filter_.state();
    for (std::size_t k = associated_submaps; k < associated_.observations.size(); ++k) {
      problem.observations.push_back(&associated_.observations[k]);
      problem.landmarks.emplace_back();
      state.ends.push_back(compose(startOf(state, k), Pose(associated_.observations[k].z)));
    }
    return {std::move(associated_), std::move(state), associated_submaps};
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
  const auto rows = 2 * static_cast<Eigen::Index>(submap.features.size());
  Eigen::VectorXd z(rows);
  for (std::size_t i = 0; i < submap.features.size(); ++i)
    z.segment<2>(2 * static_cast<Eigen::Index>(i)) << submap.features[i].x, submap.features[i].y;
  const Prediction prediction =
      predictLandmarks(*filter_.form(), filter_.state(), z, options_.search_margin_m);
  const Eigen::MatrixXd q = submap.covariance.asEigen().bottomRightCorner(rows, rows);
  const Comparison comparison = compare(prediction, z, q, options_.match_gate);

  for (std::size_t i = 0; i < decisions.size(); ++i) {
    decisions[i].distance2 = comparison.nearest2[i];
    if (comparison.nearest2[i] <= options_.new_gate) decisions[i].kind = Kind::kDropped;
  }
  const auto& candidates = comparison.candidates;
  const auto agreeing =
      options_.joint_search ? jointUnlessNearestExplain(candidates) : nearestNeighbours(candidates);
  for (const std::size_t i : agreeing)
    decisions[static_cast<std::size_t>(candidates.pairings[i].feature)].kind = Kind::kNew;
  const auto chosen = convincing(candidates, agreeing, densityOf(z));
  for (const std::size_t i : chosen)
    decisions[static_cast<std::size_t>(candidates.pairings[i].feature)].kind = Kind::kDropped;
  for (const std::size_t i : undisputed(candidates, chosen)) {
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
  SequentialAssociation association(options);
  association.reserve(submaps.size());
  bool going_on = true;
  for (std::size_t k = 0; k < submaps.size(); ++k) {
    if (!going_on) {
      association.leaveOut(*submaps[k]);
      continue;
    }
    if (!association.add(*submaps[k])) return std::nullopt;
    const double share = static_cast<double>(k + 1) / static_cast<double>(submaps.size());
    going_on = !progress || progress(share * share);
  }
  UnknownAssociation result = std::move(association).result();
  if (!going_on) return result;
  InformationForm form(result.associated.problem);
  const auto joined = minimise(result.associated.problem, form, result.state, gauss_newton, {});
  if (joined.status == JoinStatus::kFailed) return std::nullopt;
  if (options.merge) mergeDuplicates(result.associated, result.state, options.match_gate, gauss_newton);
  return result;
}

}  // namespace submap_slam::landmark_joining
