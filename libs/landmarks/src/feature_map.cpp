#include <submap_slam/landmarks/feature_map.h>

#include <algorithm>
#include <cmath>

namespace submap_slam::landmark_mapping {
namespace {

constexpr double kTileSize = 16;  // m

}  // namespace

FeatureMap::Key FeatureMap::keyOf(const Point& point) {
  return {static_cast<int>(std::floor(point.x() / kTileSize)),
          static_cast<int>(std::floor(point.y() / kTileSize))};
}

std::vector<FeatureMap::Tile>::iterator FeatureMap::find(const Key& key) {
  return std::lower_bound(tiles_.begin(), tiles_.end(), key,
                          [](const Tile& tile, const Key& k) { return tile.key < k; });
}

FeatureMap::Features& FeatureMap::writable(Tile& tile) {
  if (tile.features.use_count() > 1) tile.features = std::make_shared<Features>(*tile.features);
  return *tile.features;
}

std::vector<FeatureMap::Place> FeatureMap::around(const Point& centre, double radius_m) const {
  const Point corner(radius_m, radius_m);
  const Key low = keyOf(centre - corner), high = keyOf(centre + corner);
  std::vector<Place> places;
  for (std::size_t t = 0; t < tiles_.size(); ++t) {
    const Key& key = tiles_[t].key;
    if (key.first < low.first || key.first > high.first || key.second < low.second ||
        key.second > high.second)
      continue;
    const Features& features = *tiles_[t].features;
    for (std::size_t i = 0; i < features.size(); ++i)
      if ((features[i].mean - centre).squaredNorm() <= radius_m * radius_m) places.push_back({t, i});
  }
  return places;
}

std::vector<FeatureMap::Place> FeatureMap::all() const {
  std::vector<Place> places;
  for (std::size_t t = 0; t < tiles_.size(); ++t)
    for (std::size_t i = 0; i < tiles_[t].features->size(); ++i) places.push_back({t, i});
  return places;
}

void FeatureMap::insert(const Feature& feature) {
  const Key key = keyOf(feature.mean);
  auto tile = find(key);
  if (tile == tiles_.end() || tile->key != key)
    tile = tiles_.insert(tile, {key, std::make_shared<Features>()});
  writable(*tile).push_back(feature);
  ++size_;
}

void FeatureMap::update(const std::vector<std::pair<Place, Feature>>& changes,
                        const std::vector<Place>& missed, double lost_evidence) {
  std::vector<Place> leaving;
  std::vector<Feature> moved;
  for (const auto& [place, feature] : changes) {
    const bool gone = feature.evidence < 0;
    if (!gone && keyOf(feature.mean) == tiles_[place.tile].key) {
      writable(tiles_[place.tile])[place.index] = feature;
      continue;
    }
    leaving.push_back(place);
    if (!gone) moved.push_back(feature);
  }
  for (const Place& place : missed) {
    Feature& feature = writable(tiles_[place.tile])[place.index];
    feature.evidence -= lost_evidence;
    if (feature.evidence < 0) leaving.push_back(place);
  }
  std::sort(leaving.begin(), leaving.end(), [](const Place& a, const Place& b) {
    return std::make_pair(a.tile, a.index) > std::make_pair(b.tile, b.index);
  });
  for (const Place& place : leaving) {
    Features& features = writable(tiles_[place.tile]);
    features.erase(features.begin() + static_cast<std::ptrdiff_t>(place.index));
    --size_;
  }
  for (const Feature& feature : moved) insert(feature);
}

bool FeatureMap::sharesTile(const FeatureMap& other, const Place& place) const {
  const Tile& tile = tiles_[place.tile];
  return std::any_of(other.tiles_.begin(), other.tiles_.end(),
                     [&](const Tile& t) { return t.features == tile.features; });
}

}  // namespace submap_slam::landmark_mapping
