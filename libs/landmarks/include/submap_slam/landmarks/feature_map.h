#pragma once

#include <submap_slam/landmarks/landmark_geometry.h>

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace submap_slam::landmark_mapping {

/** A feature of one particle: a small Kalman filter, given the particle's path. */
struct Feature {
  uint32_t id = 0;     ///< known id, or index of the first measurement of it
  bool known = false;  ///< the id is from the log
  Point mean = Point::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  uint32_t hits = 1;
  double evidence = 0;  ///< log-odds that it exists
};

/** The features of a particle, in square tiles by their position. Copies share tiles until one of them
 * changes a feature: then only its tile is copied. Looking for the features around a place visits the tiles
 * there alone. */
class FeatureMap {
 public:
  /** Where a feature is, until the map changes next. */
  struct Place {
    std::size_t tile = 0, index = 0;
    bool operator==(const Place& o) const { return tile == o.tile && index == o.index; }
  };

  std::size_t size() const { return size_; }
  const Feature& at(const Place& place) const { return (*tiles_[place.tile].features)[place.index]; }

  /** Features at most so far from the centre, in an order that does not depend on how they came in. */
  std::vector<Place> around(const Point& centre, double radius_m) const;
  std::vector<Place> all() const;

  void insert(const Feature& feature);

  /** Replaces features, takes evidence from others that were missed, and removes those of both whose evidence
   * is below 0 then. Places are of the map before. */
  void update(const std::vector<std::pair<Place, Feature>>& changes, const std::vector<Place>& missed = {},
              double lost_evidence = 0);

  /** True if both maps hold the tile of the place in the same memory. */
  bool sharesTile(const FeatureMap& other, const Place& place) const;

 private:
  using Features = std::vector<Feature>;
  using Key = std::pair<int, int>;
  struct Tile {
    Key key;
    std::shared_ptr<Features> features;
  };
  static Key keyOf(const Point& point);
  std::vector<Tile>::iterator find(const Key& key);
  Features& writable(Tile& tile);

  std::vector<Tile> tiles_;  // by key
  std::size_t size_ = 0;
};

}  // namespace submap_slam::landmark_mapping
