#include <gmock/gmock.h>
#include <submap_slam/core/joined_landmarks.h>

#include <Eigen/Dense>
#include <cmath>

#include "eif_tree/compatibility.h"
#include "eif_tree/joining.h"
#include "eif_tree/merging.h"
#include "eif_tree/prediction.h"
#include "eif_tree/sequential_filter.h"
#include "eif_tree/unknown_association.h"
#include "landmark_joining_fixture.h"
#include "landmark_world.h"

namespace submap_slam {
namespace {

using namespace landmark_joining;
using ::testing::ElementsAre;
using testing::LandmarkWorldOptions;
using testing::simulateLandmarks;
using testing::submapOf;
using ::testing::UnorderedElementsAre;

/** Pairings on a line along x with what all features share (variance `common`) and what each has for itself.
 */
Candidates onALine(const std::vector<Pairing>& pairings, const std::vector<double>& innovations,
                   double common, double own) {
  Candidates c;
  c.pairings = pairings;
  const auto rows = 2 * static_cast<Eigen::Index>(pairings.size());
  c.innovation = Eigen::VectorXd::Zero(rows);
  c.covariance = Eigen::MatrixXd::Zero(rows, rows);
  for (std::size_t i = 0; i < pairings.size(); ++i) {
    const auto row = 2 * static_cast<Eigen::Index>(i);
    c.innovation[row] = innovations[i];
    c.pairings[i].distance2 = innovations[i] * innovations[i] / (common + own);
    for (std::size_t k = 0; k < pairings.size(); ++k) {
      const bool same = pairings[i].feature == pairings[k].feature;
      const auto column = 2 * static_cast<Eigen::Index>(k);
      c.covariance.block<2, 2>(row, column) = (common + (same ? own : 0)) * Eigen::Matrix2d::Identity();
    }
    c.covariance(row, row) += 1e-6, c.covariance(row + 1, row + 1) += 1e-6;
  }
  return c;
}

TEST(Compatibility, GateIsTheQuantileOfChiSquared) {
  const double p99 = -2 * std::log(0.01), p999 = -2 * std::log(0.001);
  EXPECT_NEAR(jointGate(p99, 2), p99, 1e-9);
  EXPECT_NEAR(jointGate(p99, 10), 23.209, 0.05);
  EXPECT_NEAR(jointGate(p99, 200), 249.445, 0.1);
  EXPECT_NEAR(jointGate(p999, 2), p999, 1e-9);
  EXPECT_NEAR(jointGate(p999, 10), 29.588, 0.3);
  EXPECT_GT(jointGate(0, 200), 0);
  EXPECT_LT(jointGate(0, 200), jointGate(p99, 200));
}

TEST(Compatibility, AWiderGateAlsoAcceptsASinglePairingBeyondTheUsualOne) {
  auto c = onALine({{0, 5, 0}}, {4}, 0.5, 0.5);  // squared distance 16
  EXPECT_TRUE(nearestNeighbours(c).empty());
  EXPECT_TRUE(jointCompatibility(c).empty());
  c.gate2 = 20;
  EXPECT_EQ(nearestNeighbours(c).size(), 1u);
  EXPECT_EQ(jointCompatibility(c).size(), 1u);
}

TEST(Compatibility, BothFindWhatIsClear) {
  const auto c = onALine({{0, 5, 0}, {1, 6, 0}}, {0.1, 0.1}, 1, 0.01);
  EXPECT_THAT(nearestNeighbours(c), UnorderedElementsAre(0u, 1u));
  EXPECT_THAT(jointCompatibility(c), UnorderedElementsAre(0u, 1u));
}

/** The whole submap is shifted by 2 m, a common error with a standard deviation of 2 m; landmarks stand every
 * 3 m, so that the second feature is nearer to a wrong one. */
Candidates shifted() {
  // Feature 0 may only be landmark 0 (2 off). Feature 1 may be landmark 1 (2 off) or landmark 2 (−1 off).
  return onALine({{0, 0, 0}, {1, 1, 0}, {1, 2, 0}, {2, 3, 0}}, {2, 2, -1, 2}, 4, 0.01);
}

TEST(Compatibility, JointSearchSeesACommonShiftThatNearestNeighboursDoNot) {
  const auto nearest = nearestNeighbours(shifted());
  EXPECT_EQ(nearest.front(), 2u) << "the nearest pairing is a wrong one";
  EXPECT_EQ(nearest.size(), 1u) << "and contradicts the right ones";
  EXPECT_THAT(jointCompatibility(shifted()), UnorderedElementsAre(0u, 1u, 3u));
}

TEST(Compatibility, TheJointSearchDecidesWhereItExplainsMuchMore) {
  EXPECT_THAT(jointUnlessNearestExplain(shifted()), UnorderedElementsAre(0u, 1u, 3u));
}

/** Five features in a row, a landmark every 3 m: as predicted the first four are known; shifted by one, all.
 */
TEST(Compatibility, InARowOfLandmarksThePredictionDecidesNotTheNumber) {
  std::vector<Pairing> pairings;
  std::vector<double> innovations;
  for (int i = 0; i < 4; ++i) pairings.push_back({i, i, 0}), innovations.push_back(0.4);
  for (int i = 0; i < 5; ++i) pairings.push_back({i, i - 1, 0}), innovations.push_back(-2.6);
  const auto c = onALine(pairings, innovations, 4, 0.01);
  EXPECT_EQ(jointCompatibility(c).size(), 5u);
  EXPECT_THAT(jointUnlessNearestExplain(c), UnorderedElementsAre(0u, 1u, 2u, 3u));
}

TEST(Compatibility, OneUncertainPairingConvincesNobodyButSeveralDo) {
  constexpr double kDensity = 0.1;
  const auto one = onALine({{0, 0, 0}}, {1}, 4, 0.01);
  EXPECT_TRUE(convincing(one, {0}, kDensity).empty());
  EXPECT_THAT(convincing(one, {0}, 1e-3), ElementsAre(0u)) << "where landmarks are rare it does";
  const auto three = onALine({{0, 0, 0}, {1, 1, 0}, {2, 2, 0}}, {1, 1, 1}, 4, 0.01);
  EXPECT_THAT(convincing(three, {0, 1, 2}, kDensity), ElementsAre(0u, 1u, 2u));
  const auto contradicting = onALine({{0, 0, 0}, {1, 1, 0}}, {1, -1}, 4, 0.01);
  EXPECT_TRUE(convincing(contradicting, {0, 1}, kDensity).empty());
  const auto precise = onALine({{0, 0, 0}}, {0.1}, 0.01, 0.01);
  EXPECT_THAT(convincing(precise, {0}, kDensity), ElementsAre(0u));
  EXPECT_TRUE(convincing({}, {}, kDensity).empty());
}

/** Features in a row, a landmark every 3 m, seen from a place known with a standard deviation of `sigma`: by
 * the first pairings they are off by `shift`, by the others, a landmark on, by `shift` − 3 m. The last
 * features have no landmark there. */
Candidates betweenTwoPlaces(double shift, double sigma, int features, int without_other) {
  std::vector<Pairing> pairings;
  std::vector<double> innovations;
  for (int i = 0; i < features; ++i) pairings.push_back({i, i, 0}), innovations.push_back(shift);
  for (int i = 0; i < features - without_other; ++i)
    pairings.push_back({i, i + 1, 0}), innovations.push_back(shift - 3);
  return onALine(pairings, innovations, sigma * sigma, 0.01);
}

TEST(Compatibility, BetweenTwoPlacesThatFitNothingIsCertain) {
  EXPECT_TRUE(undisputed(betweenTwoPlaces(1.4, 2, 5, 0), {0, 1, 2, 3, 4}).empty());
  EXPECT_TRUE(undisputed(betweenTwoPlaces(0.4, 2, 5, 1), {0, 1, 2, 3, 4}).empty());
}

TEST(Compatibility, APlaceIsCertainIfTheOtherIsUnlikely) {
  EXPECT_EQ(undisputed(betweenTwoPlaces(0.4, 0.5, 5, 0), {0, 1, 2, 3, 4}).size(), 5u);
}

TEST(Compatibility, APlaceIsCertainIfTheOtherExplainsTooFewFeatures) {
  EXPECT_EQ(undisputed(betweenTwoPlaces(1.4, 2, 5, 2), {0, 1, 2, 3, 4}).size(), 5u);
}

TEST(Compatibility, WhatEveryRivalHoldsTooIsCertain) {
  // Feature 3 is a landmark that moves with the robot's place: it fits at both.
  auto c = betweenTwoPlaces(1.4, 2, 3, 0);
  c.pairings.push_back({3, 9, 0});
  c.innovation.conservativeResize(14);
  c.innovation.tail<2>().setZero();
  Eigen::MatrixXd covariance = 0.01 * Eigen::MatrixXd::Identity(14, 14);
  covariance.topLeftCorner<12, 12>() = c.covariance;
  c.covariance = covariance;
  EXPECT_THAT(undisputed(c, {0, 1, 2, 6}), ElementsAre(6u));
}

TEST(Compatibility, OneFeatureOfTwoLandmarksMakesNoPlaceDoubtful) {
  const auto c = onALine({{0, 0, 0}, {1, 1, 0}, {2, 2, 0}, {2, 3, 0}}, {0, 0, 0.2, -0.2}, 1, 0.01);
  EXPECT_THAT(undisputed(c, {0, 1, 2}), ElementsAre(0u, 1u, 2u));
  EXPECT_THAT(undisputed(c, {2, 0, 1}), ElementsAre(0u, 1u, 2u)) << "in whatever order they were found";
}

TEST(Compatibility, LandmarksThatMayBeOneDisputeNothing) {
  // Landmarks 5 to 7 are as uncertain as they are far from landmarks 0 to 2.
  auto c = onALine({{0, 0, 0}, {1, 1, 0}, {2, 2, 0}, {0, 5, 0}, {1, 6, 0}, {2, 7, 0}},
                   {0.1, 0.1, 0.1, -0.9, -0.9, -0.9}, 1, 0.01);
  ASSERT_TRUE(undisputed(c, {0, 1, 2}).empty());
  c.covariance.bottomRightCorner<6, 6>() += Eigen::MatrixXd::Identity(6, 6);
  EXPECT_EQ(undisputed(c, {0, 1, 2}).size(), 3u);
}

TEST(Compatibility, ALandmarkIsMatchedOnce) {
  const auto c = onALine({{0, 5, 0}, {1, 5, 0}}, {0.2, 0.1}, 1, 0.01);
  EXPECT_THAT(nearestNeighbours(c), ElementsAre(1u));
  EXPECT_EQ(jointCompatibility(c).size(), 1u);
}

TEST(Compatibility, NothingComesOfNothing) {
  EXPECT_TRUE(nearestNeighbours({}).empty());
  EXPECT_TRUE(jointCompatibility({}).empty());
  EXPECT_TRUE(undisputed({}, {}).empty());
}

TEST(Prediction, HasTheCovarianceOfTheDenseInverse) {
  const auto submaps = simulateLandmarks({});
  SequentialFilter filter({});
  const auto associated = associateByIds({submaps[0]});
  std::vector<int> landmarks(submaps[0]->features.size());
  for (std::size_t i = 0; i < landmarks.size(); ++i) landmarks[i] = static_cast<int>(i);
  ASSERT_TRUE(filter.fuse(associated.observations[0], landmarks));
  const Prediction p = predictLandmarks(*filter.form(), filter.state(), Eigen::Vector2d::Zero(), 1000);
  ASSERT_EQ(p.landmarks.size(), landmarks.size());

  // After one submap the state is that submap with its covariance; the features are seen from its end.
  const Eigen::MatrixXd q = submaps[0]->covariance.asEigen();
  const auto& end = submaps[0]->end_pose;
  const auto& f = submaps[0]->features[1];
  const double c = std::cos(end.phi), s = std::sin(end.phi), dx = f.x - end.x, dy = f.y - end.y;
  const Eigen::Vector2d h(c * dx + s * dy, -s * dx + c * dy);
  EXPECT_LT((p.mean.segment<2>(2) - h).norm(), 1e-9);
  Eigen::Matrix<double, 2, 5> j;
  j << -c, -s, h.y(), c, s, s, -c, -h.x(), -s, c;
  const std::vector<int> rows{0, 1, 2, 5, 6};
  const Eigen::Matrix2d expected = j * q(rows, rows) * j.transpose();
  EXPECT_LT((p.covariance.block<2, 2>(2, 2) - expected).norm(), 1e-7 * expected.norm());
}

void expectTruth(const LandmarkWorldOptions& world, bool joint_search) {
  const auto submaps = simulateLandmarks(world);
  AssociationOptions options;
  options.joint_search = joint_search;
  const auto found = associateByPosition(submaps, options, {}, {});
  ASSERT_TRUE(found);
  const auto errors = compareWithIds(found->associated.associations);
  EXPECT_EQ(errors.wrong, 0u);
  EXPECT_EQ(errors.missed, 0u);
  EXPECT_LE(errors.dropped, 2u);
  EXPECT_EQ(found->state.landmarks.size(), associateByIds(submaps).problem.landmark_count);
}

TEST(UnknownAssociation, FindsTheTruthRoundALoop) {
  for (const uint32_t seed : {1u, 2u, 3u}) {
    LandmarkWorldOptions world;
    world.seed = seed;
    expectTruth(world, false);
    expectTruth(world, true);
  }
}

TEST(UnknownAssociation, DoesNotLookAtIds) {
  auto submaps = simulateLandmarks({});
  const auto found = associateByPosition(submaps, {}, {}, {});
  for (const auto& submap : submaps)
    for (std::size_t i = 0; i < submap->features.size(); ++i)
      submap->features[i].id = static_cast<uint32_t>(900 + i);
  const auto renamed = associateByPosition(submaps, {}, {}, {});
  ASSERT_TRUE(found && renamed);
  ASSERT_EQ(found->state.landmarks.size(), renamed->state.landmarks.size());
  EXPECT_EQ(found->state.landmarks.back(), renamed->state.landmarks.back());
}

TEST(UnknownAssociation, AFeatureBetweenTheGatesIsLeftOut) {
  // Poses are exact and both sigmas are 0.1 m: 0.45 m apart is a squared distance of 10.1, 0.55 m is 15.1.
  const auto decision = [](double shift) {
    LandmarkSubmaps submaps;
    for (const double x : {5.0, 5.0 + shift}) {
      auto submap = LandmarkSubmap::Create();
      submap->id = static_cast<uint32_t>(submaps.size());
      submap->features = {{1, x, 0, 1}};
      submap->covariance.setIdentity(5);
      submap->covariance *= 0.01;
      for (int i = 0; i < 3; ++i) submap->covariance(i, i) = 1e-8;
      submaps.push_back(submap);
    }
    return associateByPosition(submaps, {}, {}, {})->associated.associations.back();
  };
  using Kind = FeatureAssociation::Kind;
  EXPECT_EQ(decision(0.1).kind, Kind::kMatched);
  EXPECT_EQ(decision(0.45).kind, Kind::kDropped);
  EXPECT_NEAR(decision(0.45).distance2, 0.45 * 0.45 / 0.02, 0.01);
  EXPECT_EQ(decision(0.55).kind, Kind::kNew);
}

/** Six landmarks, one every 3 m, and then, from a place known to 2 m, five of them: half way between two
 * places that fit if the landmarks stand in a row. */
std::vector<FeatureAssociation> atARow(const std::vector<double>& offsets) {
  auto first = submapOf({0, 0, 0}, {}, 1e-4), second = submapOf({1, 0, 0}, {}, 1e-4);
  for (uint32_t i = 0; i < 6; ++i) first->features.push_back({i, 3.0 * i, 2 + offsets[i], 1});
  for (uint32_t i = 0; i < 5; ++i) second->features.push_back({i, 3.0 * i + 1.4, 2 + offsets[i], 1});
  second->id = 1;
  for (const auto& submap : {first, second}) {
    submap->covariance.setIdentity(submap->dimension());
    submap->covariance *= 1e-4;
  }
  first->covariance(0, 0) = 4;
  first->covariance(2, 2) = 1e-6;
  const auto found = associateByPosition({first, second}, {}, {}, {});
  EXPECT_TRUE(found);
  const auto& all = found->associated.associations;
  return {all.begin() + 6, all.end()};
}

TEST(UnknownAssociation, WhereTwoPlacesFitItIsLeftUndecided) {
  for (const auto& a : atARow({0, 0, 0, 0, 0, 0})) EXPECT_EQ(a.kind, FeatureAssociation::Kind::kDropped);
}

TEST(UnknownAssociation, LandmarksOutOfTheRowDecide) {
  uint32_t feature = 0;
  for (const auto& a : atARow({0, 0, 0, 0, 4, 0})) {
    EXPECT_EQ(a.kind, FeatureAssociation::Kind::kMatched);
    EXPECT_EQ(a.landmark, ++feature);
  }
}

TEST(UnknownAssociation, WithoutANeighbourThereIsNoDistance) {
  const auto submaps = simulateLandmarks({});
  const auto found = associateByPosition(submaps, {}, {}, {});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->associated_submaps, submaps.size());
  EXPECT_TRUE(std::isinf(found->associated.associations.front().distance2));
}

/** The submaps with every landmark that the last three saw under a name of its own there. */
LandmarkSubmaps withDuplicates() {
  auto submaps = simulateLandmarks({});
  for (std::size_t k = submaps.size() - 3; k < submaps.size(); ++k)
    for (auto& feature : submaps[k]->features) feature.id += 1000;
  return submaps;
}

TEST(Merging, MakesOneOfWhatAgrees) {
  auto associated = associateByIds(withDuplicates());
  const std::size_t truth = associateByIds(simulateLandmarks({})).problem.landmark_count;
  ASSERT_GT(associated.problem.landmark_count, truth);
  JointState state = joinBy({}, associated.problem, {}).state;
  const std::size_t before = associated.problem.landmark_count;
  const std::size_t merges = mergeDuplicates(associated, state, 9.21, {});
  EXPECT_EQ(associated.problem.landmark_count, truth);
  EXPECT_EQ(before - merges, truth);
  EXPECT_EQ(state.landmarks.size(), truth);
  EXPECT_EQ(associated.hits.size(), truth);
}

TEST(Merging, LeavesALandmarkThatIsMoreUncertainThanTheirSpacing) {
  const auto merges = [](double sigma) {
    auto first = submapOf({0, 0, 0}, {}, 1e-4);
    for (uint32_t i = 0; i < 5; ++i) first->features.push_back({i, 3.0 * i, 2, 1});
    first->covariance.setIdentity(first->dimension());
    first->covariance *= 1e-4;
    first->covariance(0, 0) = first->covariance(1, 1) = sigma * sigma;
    auto associated = associateByIds({first, submapOf({1, 0, 0}, {{9, 6 + sigma, 2, 1}}, 1e-4)});
    JointState state = joinBy({}, associated.problem, {}).state;
    return mergeDuplicates(associated, state, 9.21, {});
  };
  EXPECT_EQ(merges(0.3), 1u);
  EXPECT_EQ(merges(8), 0u);
}

TEST(Merging, LeavesWhatOneSubmapHoldsBothOf) {
  auto submaps = simulateLandmarks({});
  auto associated = associateByIds(submaps);
  const std::size_t before = associated.problem.landmark_count;
  JointState state = joinBy({}, associated.problem, {}).state;
  EXPECT_EQ(mergeDuplicates(associated, state, 9.21, {}), 0u);
  EXPECT_EQ(associated.problem.landmark_count, before);
}

}  // namespace
}  // namespace submap_slam
