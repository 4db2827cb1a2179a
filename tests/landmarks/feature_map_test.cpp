#include <gmock/gmock.h>
#include <submap_slam/landmarks/feature_map.h>

namespace submap_slam::landmark_mapping {
namespace {

using ::testing::UnorderedElementsAre;

Feature featureAt(double x, double y, uint32_t id) {
  Feature feature;
  feature.id = id;
  feature.mean << x, y;
  return feature;
}

std::vector<uint32_t> idsOf(const FeatureMap& map, const std::vector<FeatureMap::Place>& places) {
  std::vector<uint32_t> ids;
  for (const auto& place : places) ids.push_back(map.at(place).id);
  return ids;
}

FeatureMap sample() {
  FeatureMap map;
  map.insert(featureAt(0, 0, 1));
  map.insert(featureAt(100, 0, 2));
  map.insert(featureAt(-3, -4, 3));
  return map;
}

TEST(FeatureMap, FindsWhatIsNear) {
  const FeatureMap map = sample();
  EXPECT_THAT(idsOf(map, map.around({0, 0}, 5)), UnorderedElementsAre(1u, 3u));
  EXPECT_THAT(idsOf(map, map.around({0, 0}, 4.9)), UnorderedElementsAre(1u));
  EXPECT_THAT(idsOf(map, map.around({95, 3}, 10)), UnorderedElementsAre(2u));
  EXPECT_THAT(idsOf(map, map.all()), UnorderedElementsAre(1u, 2u, 3u));
}

TEST(FeatureMap, CopiesShareAllButTheTileThatChanged) {
  const FeatureMap map = sample();
  FeatureMap copy = map;
  const auto near = copy.around({0, 0}, 1).front(), far = copy.around({100, 0}, 1).front();
  EXPECT_TRUE(copy.sharesTile(map, near) && copy.sharesTile(map, far));
  copy.update({{near, featureAt(0.1, 0, 1)}});
  EXPECT_FALSE(copy.sharesTile(map, copy.around({0, 0}, 1).front()));
  EXPECT_TRUE(copy.sharesTile(map, copy.around({100, 0}, 1).front()));
  EXPECT_EQ(map.at(map.around({0, 0}, 1).front()).mean.x(), 0) << "the original is untouched";
}

TEST(FeatureMap, AFeatureThatMovesToAnotherTileIsFoundThere) {
  FeatureMap map = sample();
  map.update({{map.around({0, 0}, 1).front(), featureAt(40, 40, 1)}});
  EXPECT_THAT(idsOf(map, map.around({40, 40}, 1)), UnorderedElementsAre(1u));
  EXPECT_THAT(idsOf(map, map.around({0, 0}, 5)), UnorderedElementsAre(3u));
  EXPECT_EQ(map.size(), 3u);
}

TEST(FeatureMap, WhatNothingSpeaksForIsRemoved) {
  FeatureMap map = sample();
  Feature gone = featureAt(0, 0, 1), stays = featureAt(-3, -4, 3);
  gone.evidence = -0.1;
  const auto places = map.around({0, 0}, 6);
  ASSERT_EQ(places.size(), 2u);
  std::vector<std::pair<FeatureMap::Place, Feature>> changes;
  for (const auto& place : places) changes.emplace_back(place, map.at(place).id == 1 ? gone : stays);
  map.update(changes);
  EXPECT_THAT(idsOf(map, map.all()), UnorderedElementsAre(2u, 3u));
  EXPECT_EQ(map.size(), 2u);
}

TEST(FeatureMap, WhatIsMissedLosesEvidenceAndGoesWhenNoneIsLeft) {
  FeatureMap map = sample();
  Feature certain = featureAt(0, 0, 1);
  certain.evidence = 0.5;
  const auto places = map.around({0, 0}, 6);
  ASSERT_EQ(places.size(), 2u);
  const std::size_t first = map.at(places[0]).id == 1 ? 0 : 1;
  map.update({{places[first], certain}});
  map.update({}, places, 0.3);
  ASSERT_THAT(idsOf(map, map.all()), UnorderedElementsAre(1u, 2u)) << "3 had none";
  EXPECT_DOUBLE_EQ(map.at(map.around({0, 0}, 1).front()).evidence, 0.2);
}

}  // namespace
}  // namespace submap_slam::landmark_mapping
