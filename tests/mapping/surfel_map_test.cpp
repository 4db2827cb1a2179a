#include <gtest/gtest.h>
#include <submap_slam/mapping/surfel_map.h>
#include <submap_slam/simulation/normal_generator.h>

#include <cmath>

#include "synthetic_scans.h"

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;

double distanceToLine(const Surfel& s, double x, double y) {
  return std::abs((x - static_cast<double>(s.line_x)) * static_cast<double>(s.normal_x) +
                  (y - static_cast<double>(s.line_y)) * static_cast<double>(s.normal_y));
}

/** Everything a matcher can see of a map in an area around the origin. */
std::vector<float> appearance(const SurfelMap& map) {
  std::vector<float> out;
  for (double y = -3; y < 3; y += 0.07)
    for (double x = -3; x < 3; x += 0.07) {
      const Surfel* s = map.nearest(x, y);
      if (s)
        out.insert(out.end(), {s->x, s->y, s->line_x, s->line_y, s->normal_x, s->normal_y, s->hits});
      else
        out.push_back(-1);
    }
  return out;
}

TEST(SurfelMap, AnEmptyMapHasNoNearestSurfel) {
  const SurfelMap map{SurfelMapParams{}};
  EXPECT_TRUE(map.empty());
  EXPECT_EQ(map.nearest(0, 0), nullptr);
  EXPECT_EQ(map.nearest(-1e4, 1e4), nullptr);
}

TEST(SurfelMap, AWallIsALineAtSubCellPosition) {
  SurfelMap map{SurfelMapParams{}};
  map.insert(wallPoints(-1, 1.013f, 1, 1.013f), {});
  for (const double x : {-0.7, 0.01, 0.52})
    for (const double y : {0.85, 1.013, 1.2}) {
      const Surfel* surfel = map.nearest(x, y);
      ASSERT_NE(surfel, nullptr);
      EXPECT_EQ(surfel->kind, Surfel::Kind::kLine);
      EXPECT_NEAR(std::abs(surfel->normal_y), 1, 1e-4);
      EXPECT_NEAR(distanceToLine(*surfel, x, 1.013), 0, 1e-4);
      EXPECT_NEAR(surfel->x, x, 0.06);
    }
}

TEST(SurfelMap, ANoisyWallIsNotShiftedByTheCellsItFallsInto) {
  // Noise takes some endpoints across the border of the cells at y = 1.
  NormalGenerator normal(1, 0);
  constexpr double kSigma = 0.02;
  for (const double wall : {1.005, 1.01, 1.02, 1.03, 1.045}) {
    SurfelMap map{SurfelMapParams{}};
    for (int scan = 0; scan < 200; ++scan) {
      LaserPoints points = wallPoints(-1, 0, 1, 0);
      for (auto& p : points.points) p.y = static_cast<float>(wall + kSigma * normal());
      map.insert(points, {});
    }
    double shift = 0;
    int count = 0;
    for (double x = -0.8; x < 0.8; x += 0.05, ++count) {
      const Surfel* surfel = map.nearest(x, wall);
      ASSERT_NE(surfel, nullptr);
      shift += static_cast<double>(surfel->line_y) - wall;
    }
    EXPECT_NEAR(shift / count, 0, 2e-3) << wall;
  }
}

TEST(SurfelMap, SlantingWallsKeepTheirDirection) {
  for (const double alpha : {0.1, 0.6, 1.3, 2.4, -0.8}) {
    const auto c = static_cast<float>(std::cos(alpha)), s = static_cast<float>(std::sin(alpha));
    SurfelMap map{SurfelMapParams{}};
    map.insert(wallPoints(-c, -s, c, s), {});
    const Surfel* surfel = map.nearest(0.3 * std::cos(alpha), 0.3 * std::sin(alpha));
    ASSERT_NE(surfel, nullptr);
    EXPECT_NEAR(std::abs(-surfel->normal_x * s + surfel->normal_y * c), 1, 1e-4) << alpha;
    EXPECT_NEAR(distanceToLine(*surfel, 0, 0), 0, 1e-3) << alpha;
  }
}

TEST(SurfelMap, TheSearchRadiusIsReached) {
  SurfelMapParams params;
  params.search_radius = 0.3;
  SurfelMap map(params);
  map.insert(wallPoints(-1, 0.025f, 1, 0.025f), {});
  EXPECT_NE(map.nearest(0, 0.31), nullptr);
}

TEST(SurfelMap, NothingIsFoundBeyondTheSearchRadius) {
  SurfelMapParams params;
  params.search_radius = 0.3;
  SurfelMap map(params);
  map.insert(wallPoints(-1, 0.025f, 1, 0.025f), {});
  EXPECT_NE(map.nearest(0, 0.25), nullptr);
  EXPECT_EQ(map.nearest(0, 0.39), nullptr);
  EXPECT_EQ(map.nearest(0, -0.39), nullptr);
  EXPECT_EQ(map.nearest(1.4, 0), nullptr);
}

TEST(SurfelMap, TheNearestOfTwoWallsIsFound) {
  SurfelMap map{SurfelMapParams{}};
  map.insert(wallPoints(-1, 0.025f, 1, 0.025f), {});
  map.insert(wallPoints(-1, 0.425f, 1, 0.425f), {});
  EXPECT_NEAR(map.nearest(0, 0.15)->y, 0.025, 1e-5);
  EXPECT_NEAR(map.nearest(0, 0.3)->y, 0.425, 1e-5);
}

TEST(SurfelMap, EndpointsAreMovedByThePose) {
  SurfelMap map{SurfelMapParams{}};
  map.insert(wallPoints(1, -0.5f, 1, 0.5f), {2, 3, M_PI / 2});  // lands on y = 4, x = 1.5 … 2.5
  const Surfel* surfel = map.nearest(2.1, 4.02);
  ASSERT_NE(surfel, nullptr);
  EXPECT_NEAR(distanceToLine(*surfel, 2.1, 4), 0, 1e-4);
  EXPECT_NEAR(std::abs(surfel->normal_y), 1, 1e-4);
  EXPECT_EQ(map.nearest(1, 0), nullptr);
}

TEST(SurfelMap, ScanNormalsAreMovedByThePoseToo) {
  SurfelMap map{SurfelMapParams{}};
  const double normal = 0.3, heading = 1.1;  // a lone point: only its scan normal can give a direction
  map.insert(pointsAt({{1, 0, static_cast<float>(0.6 * std::cos(normal)),
                        static_cast<float>(0.6 * std::sin(normal))}}),
             {0, 0, heading});
  ASSERT_EQ(map.surfels().size(), 1u);
  const Surfel& surfel = map.surfels()[0];
  EXPECT_EQ(surfel.kind, Surfel::Kind::kLine);
  const double along = static_cast<double>(surfel.normal_x) * std::cos(normal + heading) +
                       static_cast<double>(surfel.normal_y) * std::sin(normal + heading);
  EXPECT_NEAR(std::abs(along), 1, 1e-5);
}

/** Endpoints on y = height with the normal of one of its sides. */
LaserPoints faceAt(float height, float side) {
  LaserPoints face = wallPoints(-1, height, 1, height);
  for (auto& p : face.points) p.normal_y = side;
  return face;
}

TEST(SurfelMap, TheTwoFacesOfAThinWallKeepTheirOwnLines) {
  SurfelMap map{SurfelMapParams{}};
  map.insert(faceAt(0.025f, -1), {});
  map.insert(faceAt(0.125f, 1), {});
  for (const auto& [y, side] : {std::pair{0.025, -1.0f}, {0.125, 1.0f}}) {
    const Surfel* surfel = map.nearest(0, y);
    ASSERT_NE(surfel, nullptr);
    EXPECT_NEAR(distanceToLine(*surfel, 0, y), 0, 1e-4);
    EXPECT_FALSE(surfel->facesAwayFrom(0, side));
    EXPECT_TRUE(surfel->facesAwayFrom(0, -side));
    EXPECT_FALSE(surfel->facesAwayFrom(0, 0));
    EXPECT_FALSE(surfel->facesAwayFrom(1, 0));
    EXPECT_FALSE(surfel->facesAwayFrom(0.995f, -0.1f * side));  // grazing: either side
  }
}

TEST(SurfelMap, WhatWasSeenFromBothSidesFacesNowhere) {
  SurfelMap map{SurfelMapParams{}};
  map.insert(faceAt(0.025f, -1), {});
  map.insert(faceAt(0.025f, 1), {});
  const Surfel* surfel = map.nearest(0, 0.025);
  ASSERT_NE(surfel, nullptr);
  EXPECT_FALSE(surfel->facesAwayFrom(0, 1));
  EXPECT_FALSE(surfel->facesAwayFrom(0, -1));
}

TEST(SurfelMap, ALonePointWithoutNormalIsAPoint) {
  SurfelMap map{SurfelMapParams{}};
  map.insert(pointsAt({{1, 0}}), {});
  ASSERT_EQ(map.surfels().size(), 1u);
  EXPECT_EQ(map.surfels()[0].kind, Surfel::Kind::kPoint);
}

TEST(SurfelMap, ContradictingNormalsLeaveAPoint) {
  SurfelMap map{SurfelMapParams{}};
  map.insert(pointsAt({{1.01f, 0.01f, 1, 0}, {1.01f, 0.01f, 0, 1}}), {});
  EXPECT_EQ(map.surfels()[0].kind, Surfel::Kind::kPoint);
}

TEST(SurfelMap, EndpointsInOneCellAreAveraged) {
  SurfelMap map{SurfelMapParams{}};
  for (int k = 0; k < 1000; ++k) map.insert(pointsAt({{1.01f, 0.02f}, {1.03f, 0.04f}}), {});
  ASSERT_EQ(map.surfels().size(), 1u);
  EXPECT_EQ(map.surfels()[0].hits, 2000);
  EXPECT_NEAR(map.surfels()[0].x, 1.02, 1e-4);
  EXPECT_NEAR(map.surfels()[0].y, 0.03, 1e-4);
}

TEST(SurfelMap, CellsAreEquallyWideOnBothSidesOfTheOrigin) {
  SurfelMap map{SurfelMapParams{}};
  map.insert(pointsAt({{0.01f, 0.01f}, {-0.01f, 0.01f}, {-0.01f, -0.01f}, {0.01f, -0.01f}}), {});
  EXPECT_EQ(map.surfels().size(), 4u);
}

TEST(SurfelMap, AnEmptyScanChangesNothing) {
  SurfelMap map{SurfelMapParams{}};
  map.insert(LaserPoints{}, {1, 2, 3});
  EXPECT_TRUE(map.empty());
  map.insert(wallPoints(-1, 1, 1, 1), {});
  const auto before = appearance(map);
  map.insert(LaserPoints{}, {1, 2, 3});
  EXPECT_EQ(appearance(map), before);
}

TEST(SurfelMap, ACopyIsNotChangedThroughTheOriginal) {
  SurfelMap original{SurfelMapParams{}};
  original.insert(wallPoints(-1, 1, 1, 1), {});
  const SurfelMap copy = original;
  const auto before = appearance(copy);
  original.insert(wallPoints(-1, 1.02f, 1, 1.02f), {});  // the same tiles
  original.insert(wallPoints(-2, -2, 2, 0), {});         // others
  original.insert(wallPoints(200, 0, 201, 0), {});       // and a grown directory
  EXPECT_EQ(appearance(copy), before);
  EXPECT_NE(appearance(original), before);
}

TEST(SurfelMap, TheOriginalIsNotChangedThroughACopy) {
  SurfelMap original{SurfelMapParams{}};
  original.insert(wallPoints(-1, 1, 1, 1), {});
  const auto before = appearance(original);
  SurfelMap copy = original;
  copy.insert(wallPoints(-1, 1.02f, 1, 1.02f), {});
  EXPECT_EQ(appearance(original), before);
  EXPECT_NE(appearance(copy), before);
}

TEST(SurfelMap, ACopyThatGoesTheSameWayEndsUpEqual) {
  SurfelMap original{SurfelMapParams{}};
  original.insert(wallPoints(-1, 1, 1, 1), {});
  SurfelMap copy = original;
  original.insert(wallPoints(-2, -2, 2, 0), {0.1, 0.2, 0.3});
  copy.insert(wallPoints(-2, -2, 2, 0), {0.1, 0.2, 0.3});
  EXPECT_EQ(appearance(copy), appearance(original));
}

TEST(SurfelMap, GrowsInEveryDirection) {
  SurfelMap map{SurfelMapParams{}};
  const std::vector<TPose2D> places{{0, 0, 0}, {100, 0, 0}, {-80, 5, 0}, {3, 120, 0}, {7, -150, 0}};
  for (const auto& place : places) map.insert(wallPoints(-0.5f, 0, 0.5f, 0), place);
  for (const auto& place : places) {
    const Surfel* surfel = map.nearest(place.x, place.y);
    ASSERT_NE(surfel, nullptr);
    EXPECT_NEAR(distanceToLine(*surfel, place.x, place.y), 0, 1e-3);
  }
}

TEST(SurfelMap, ManyEndpointsAtOnePlaceKeepTheFitFinite) {
  SurfelMap map{SurfelMapParams{}};
  map.insert(pointsAt(std::vector<LaserPoint>(500, LaserPoint{1, 1, 0, 0})), {});
  const Surfel& surfel = map.surfels()[0];
  EXPECT_TRUE(std::isfinite(surfel.line_x) && std::isfinite(surfel.normal_x));
  EXPECT_NEAR(std::hypot(surfel.normal_x, surfel.normal_y), 1, 1e-5);
}

}  // namespace
}  // namespace submap_slam
