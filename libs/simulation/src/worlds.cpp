#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/simulation/world.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "constants.h"

namespace submap_slam {
namespace {

using mrpt::math::TPoint2D;

constexpr double kWallThickness = 0.15;
constexpr double kDoorWidth = 1.1;

/** Collects the walls of a floor; all lengths in m. */
class FloorPlan {
 public:
  void polygon(const std::vector<TPoint2D>& corners) {
    for (std::size_t i = 0; i < corners.size(); ++i)
      walls_.push_back({corners[i], corners[(i + 1) % corners.size()]});
  }

  void box(double x_min, double y_min, double x_max, double y_max) {
    polygon({{x_min, y_min}, {x_max, y_min}, {x_max, y_max}, {x_min, y_max}});
  }

  /** A regular polygon; `turn` (rad) is the direction of its first corner. */
  void column(const TPoint2D& centre, double radius, int corners, double turn = 0) {
    std::vector<TPoint2D> outline;
    for (int i = 0; i < corners; ++i) {
      const double angle = turn + 2 * kPi * i / corners;
      outline.push_back({centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle)});
    }
    polygon(outline);
  }

  /** A wall with thickness at height y, with doors around the given x in ascending order. */
  void wallAlongX(double y, double x_min, double x_max, const std::vector<double>& doors = {}) {
    const double half = kWallThickness / 2;
    for (const auto& [begin, end] : piecesBetweenDoors(x_min, x_max, doors))
      box(begin, y - half, end, y + half);
  }

  /** The same at x, with doors around the given y. */
  void wallAlongY(double x, double y_min, double y_max, const std::vector<double>& doors = {}) {
    const double half = kWallThickness / 2;
    for (const auto& [begin, end] : piecesBetweenDoors(y_min, y_max, doors))
      box(x - half, begin, x + half, end);
  }

  World named(const std::string& name, WayPoints route) const { return {name, walls_, std::move(route)}; }

 private:
  static std::vector<std::pair<double, double>> piecesBetweenDoors(double begin, double end,
                                                                   const std::vector<double>& doors) {
    std::vector<std::pair<double, double>> pieces;
    for (const double door : doors) {
      pieces.emplace_back(begin, door - kDoorWidth / 2);
      begin = door + kDoorWidth / 2;
    }
    pieces.emplace_back(begin, end);
    return pieces;
  }

  std::vector<Wall> walls_;
};

struct Niches {
  std::vector<double> centres;  ///< ascending
  double width, depth;
};

constexpr double kCorridorLength = 40, kCorridorWidth = 2.5;

/** A figure drawn around the origin, moved to `centre` and turned by `angle` (rad). */
std::vector<TPoint2D> placed(std::vector<TPoint2D> figure, const TPoint2D& centre, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  for (TPoint2D& p : figure) p = {centre.x + c * p.x - s * p.y, centre.y + s * p.x + c * p.y};
  return figure;
}

/** Outlines of obstacles that are not convex, about `size` m wide and high. */
std::vector<TPoint2D> hook(double size, double arm) {
  const double h = size / 2;
  return {{-h, -h}, {h, -h}, {h, arm - h}, {arm - h, arm - h}, {arm - h, h}, {-h, h}};
}
std::vector<TPoint2D> bay(double size, double arm) {
  const double h = size / 2;
  return {{-h, -h},           {h, -h},      {h, h}, {h - arm, h}, {h - arm, arm - h},
          {arm - h, arm - h}, {arm - h, h}, {-h, h}};
}
std::vector<TPoint2D> tee(double size, double arm) {
  const double h = size / 2, a = arm / 2;
  return {{-h, h - arm}, {-a, h - arm}, {-a, -h}, {a, -h}, {a, h - arm}, {h, h - arm}, {h, h}, {-h, h}};
}
std::vector<TPoint2D> star(double size, int tips) {
  std::vector<TPoint2D> outline;
  for (int i = 0; i < 2 * tips; ++i) {
    const double angle = kPi * i / tips, radius = i % 2 == 0 ? size / 2 : size / 4;
    outline.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  return outline;
}

/** Outline of a corridor along x from the origin, with niches in its lower and upper side. */
std::vector<TPoint2D> corridorOutline(const Niches& lower, const Niches& upper) {
  std::vector<TPoint2D> outline{{0, 0}};
  for (const double x : lower.centres) {
    const double begin = x - lower.width / 2, end = x + lower.width / 2;
    outline.insert(outline.end(), {{begin, 0}, {begin, -lower.depth}, {end, -lower.depth}, {end, 0}});
  }
  outline.insert(outline.end(), {{kCorridorLength, 0}, {kCorridorLength, kCorridorWidth}});
  for (auto x = upper.centres.rbegin(); x != upper.centres.rend(); ++x) {
    const double begin = *x + upper.width / 2, end = *x - upper.width / 2;
    const double back = kCorridorWidth + upper.depth;
    outline.insert(outline.end(),
                   {{begin, kCorridorWidth}, {begin, back}, {end, back}, {end, kCorridorWidth}});
  }
  outline.push_back({0, kCorridorWidth});
  return outline;
}

void addRoomFurniture(FloorPlan& plan) {
  plan.box(0.3, 4.6, 1.9, 5.4);           // desk
  plan.box(4.9, 0.0, 5.9, 0.5);           // cupboard
  plan.box(6.3, 0.4, 7.1, 2.0);           // desk
  plan.box(12.2, 0.3, 14.0, 1.1);         // sofa
  plan.column({17.2, 3.2}, 0.3, 12);      // round column
  plan.box(19.2, 0.8, 19.8, 3.4);         // shelf
  plan.box(11.9, 6.575, 12.9, 6.95);      // cupboard in the corridor
  plan.column({2.4, 12.3}, 0.7, 4, 0.5);  // table set askew
  plan.box(6.2, 14.3, 7.8, 14.9);         // shelf
  plan.column({9.3, 13.8}, 0.3, 12);      // round column
  plan.box(12.3, 9.0, 12.9, 10.6);        // shelf
  plan.box(18.6, 8.9, 19.7, 9.7);         // desk
}

void addLoopRooms(FloorPlan& plan) {
  plan.wallAlongX(4, 0, 25, {2, 6.2, 12.5, 18.3});
  plan.wallAlongX(21, 0, 25, {8, 16.5, 23});
  plan.wallAlongY(4, 4, 21, {6.4, 13, 18.3});
  plan.wallAlongY(21, 4, 21, {7, 12, 17.5});
  for (const double x : {4.0, 9.0, 15.0, 21.0}) plan.wallAlongY(x, 0, 4);
  for (const double x : {4.0, 12.0, 21.0}) plan.wallAlongY(x, 21, 25);
  for (const double y : {8.5, 16.0}) plan.wallAlongX(y, 0, 4);
  for (const double y : {10.0, 14.0}) plan.wallAlongX(y, 21, 25);
}

void addLoopFurniture(FloorPlan& plan) {
  plan.box(6.8, 1.2, 8.2, 2.0);
  plan.column({11.2, 1.8}, 0.3, 12);
  plan.column({18.8, 1.6}, 0.6, 4, 0.3);
  plan.box(23.6, 5.2, 24.6, 8.0);
  plan.column({22.9, 12.4}, 0.3, 12);
  plan.box(22.4, 18.6, 23.8, 19.4);
  plan.box(15.0, 23.4, 17.4, 24.2);
  plan.column({7.2, 23.2}, 0.7, 4, 0.9);
  plan.box(0.4, 5.0, 1.2, 7.4);
  plan.box(1.4, 11.8, 2.2, 13.4);
  plan.box(10.2, 5.85, 11.2, 6.2);     // cupboard in the corridor
  plan.box(20.6, 14.4, 20.925, 15.6);  // bench in the corridor
}

/** Offices of unequal width on both sides of a corridor along y, each with a door and a desk.
 * @param inner, outer x of the corridor's wall and of the offices' back wall */
void addOffices(FloorPlan& plan, double inner, double outer, const std::vector<double>& partitions) {
  const double towards = outer > inner ? 1 : -1;
  std::vector<double> doors;
  for (std::size_t i = 1; i < partitions.size(); ++i) {
    const double begin = partitions[i - 1], end = partitions[i];
    doors.push_back(begin + (0.3 + 0.1 * static_cast<double>(i % 5)) * (end - begin));
    plan.wallAlongX(end, std::min(inner, outer), std::max(inner, outer));
    const double back = outer - towards * 0.3, y = end - 0.9 - 0.2 * static_cast<double>(i % 3);
    plan.box(std::min(back, back - towards * 1.4), y - 0.7, std::max(back, back - towards * 1.4), y);
  }
  plan.wallAlongY(inner, partitions.front(), partitions.back(), doors);
}

}  // namespace

World roomWorld() {
  FloorPlan plan;
  plan.polygon({{0, 0}, {20, 0}, {20, 12}, {17, 12}, {17, 15}, {0, 15}});
  plan.wallAlongX(6.5, 0, 20, {3, 8.5, 15});
  plan.wallAlongX(8.5, 0, 20, {4.5, 10.5, 15});
  plan.wallAlongY(6, 0, 6.5);
  plan.wallAlongY(11, 0, 6.5, {2.5});
  plan.wallAlongY(8, 8.5, 15, {12});
  plan.wallAlongY(13, 8.5, 15);
  addRoomFurniture(plan);
  return plan.named("room", {{1.5, 7.5},   {3, 7.5},    {3, 4.5},   {4.7, 2.4}, {2, 1.8},    {3, 4.5},
                             {3, 7.5},     {8.5, 7.5},  {8.5, 2.5}, {15, 2.5},  {15, 10},    {17.8, 10.5},
                             {15.2, 13.4}, {14.6, 10},  {15, 9.2},  {15, 7.5},  {10.5, 7.5}, {10.5, 12},
                             {6, 12},      {4.5, 10.5}, {4.5, 7.5}, {1.5, 7.5}});
}

World corridorWorld() {
  FloorPlan plan;
  plan.polygon(corridorOutline({{4.3, 13.1, 29.8}, 0.9, 0.15}, {{8.7, 21.4, 34.2}, 0.9, 0.15}));
  return plan.named("corridor", {{1, 1.2}, {20, 1.4}, {38.8, 1.2}, {1, 1.2}});
}

World periodicCorridorWorld() {
  constexpr double kPitch = 2.5;
  Niches niches{{}, 1.0, 0.3};
  for (double x = kPitch / 2; x < kCorridorLength; x += kPitch) niches.centres.push_back(x);
  FloorPlan plan;
  plan.polygon(corridorOutline(niches, niches));
  plan.box(39.2, 0, 40, 1);
  plan.column({38.9, 2}, 0.2, 12);
  return plan.named("periodic_corridor", {{1, 1.25}, {37.5, 1.25}, {1, 1.25}});
}

World symmetricRoomsWorld() {
  constexpr int kRooms = 8;
  constexpr double kPitch = 4, kCorridor = 2, kBack = 6;
  FloorPlan plan;
  plan.box(0, 0, kRooms * kPitch, kBack);
  std::vector<double> doors;
  for (int room = 0; room < kRooms; ++room) {
    const double x = room * kPitch;
    doors.push_back(x + kPitch / 2);
    plan.box(x + 0.4, 4.8, x + 1.5, 5.6);
    if (room > 0) plan.wallAlongY(x, kCorridor, kBack);
  }
  plan.wallAlongX(kCorridor, 0, kRooms * kPitch, doors);
  plan.column({22.9, 5.2}, 0.3, 12);
  return plan.named("symmetric_rooms",
                    {{1, 1}, {6, 1}, {6, 4.2}, {6, 1}, {22, 1}, {22, 4.2}, {22, 1}, {30.8, 1}});
}

World loopWorld() {
  FloorPlan plan;
  plan.box(0, 0, 25, 25);
  plan.polygon({{6.2, 6.2},
                {18.8, 6.2},
                {18.8, 18.8},
                {13.5, 18.8},
                {13.5, 17.6},
                {11.5, 17.6},
                {11.5, 18.8},
                {6.2, 18.8}});
  addLoopRooms(plan);
  addLoopFurniture(plan);
  return plan.named("loop",
                    {{10, 5.1}, {19.9, 5.1}, {19.9, 19.9}, {5.1, 19.9}, {5.1, 5.1}, {19.9, 5.1}, {19.9, 13}});
}

World nonConvexWorld() {
  FloorPlan plan;
  plan.polygon({{0, 0},
                {50, 0},
                {50, 30},
                {48.6, 31.5},
                {48.6, 35},
                {50, 36.5},
                {50, 50},
                {12, 50},
                {10, 48.4},
                {0, 50}});
  plan.polygon(placed(bay(7, 1.6), {10.2, 10.6}, 0.35));
  plan.polygon(placed(hook(7.5, 2), {24.2, 10.2}, -0.2));
  plan.polygon(placed(tee(7, 1.8), {38.6, 11}, 2.5));
  plan.polygon(placed(hook(6, 1.5), {10.4, 25.2}, 1.9));
  plan.polygon(placed(star(9, 5), {24, 24.8}, 0.25));
  plan.polygon(placed(bay(7, 2), {39, 25}, -1.2));
  plan.polygon(placed(tee(6.5, 1.5), {10, 39.4}, 0.6));
  plan.polygon(placed(bay(7.5, 1.5), {23.8, 39.6}, 3.4));
  plan.polygon(placed(star(8, 4), {39.2, 39}, 0.5));
  plan.column({14.4, 20.6}, 0.5, 7);
  plan.column({32.6, 33.8}, 0.6, 3, 0.4);
  return plan.named("non_convex", {{17.2, 3.6},
                                   {31.3, 3.4},
                                   {31.4, 17.9},
                                   {46.4, 17.8},
                                   {46.2, 32.2},
                                   {31.2, 31.6},
                                   {17.2, 32},
                                   {17, 17.8},
                                   {17.2, 4}});
}

World longCorridorsWorld() {
  FloorPlan plan;
  plan.polygon({{0, 0},       {9, 0},       {9, -0.4}, {10.2, -0.4}, {10.2, 0},  {27, 0},
                {27, -0.8},   {28.5, -0.8}, {28.5, 0}, {50, 0},      {50, 11},   {50.5, 11},
                {50.5, 12.4}, {50, 12.4},   {50, 50},  {31, 50},     {31, 50.5}, {29.4, 50.5},
                {29.4, 50},   {0, 50},      {0, 8.5},  {-0.5, 8.5},  {-0.5, 7},  {0, 7}});
  plan.polygon({{3, 3},
                {17, 3},
                {17, 3.5},
                {18.3, 3.5},
                {18.3, 3},
                {35, 3},
                {35, 12},
                {27.6, 12},
                {27.6, 11.5},
                {26, 11.5},
                {26, 12},
                {12, 12},
                {12, 11.3},
                {11, 11.3},
                {11, 12},
                {3, 12}});
  plan.polygon({{3, 15},
                {7, 15},
                {7, 15.7},
                {8.4, 15.7},
                {8.4, 15},
                {20, 15},
                {20, 15.5},
                {21.2, 15.5},
                {21.2, 15},
                {35, 15},
                {35, 47},
                {3, 47}});
  plan.polygon({{38, 3},
                {47, 3},
                {47, 47},
                {38, 47},
                {38, 35},
                {38.5, 35},
                {38.5, 33.2},
                {38, 33.2},
                {38, 21},
                {38.4, 21},
                {38.4, 20},
                {38, 20},
                {38, 8},
                {38.6, 8},
                {38.6, 7},
                {38, 7}});
  plan.column({37.5, 13.2}, 0.25, 8);
  plan.box(21.2, 2.6, 22.4, 3);
  return plan.named("long_corridors",
                    {{2, 1.4}, {36.5, 1.6}, {36.4, 13.5}, {1.6, 13.6}, {1.5, 1.6}, {8, 1.5}});
}

World officeFloorWorld() {
  const std::vector<double> west{0, 6, 11.5, 19, 24, 31, 36.5, 45, 52, 57.5, 66, 71, 79, 86, 92, 100};
  const std::vector<double> east{0, 8, 13, 20.5, 28, 33, 41, 47.5, 54, 63, 68, 75.5, 83, 88, 94.5, 100};
  FloorPlan plan;
  plan.box(0, 0, 30, 100);
  addOffices(plan, 6, 0, west);
  addOffices(plan, 24, 30, east);
  plan.polygon(
      {{8.5, 3}, {21.5, 3}, {21.5, 30}, {20.5, 30}, {20.5, 31.2}, {21.5, 31.2}, {21.5, 36}, {8.5, 36}});
  plan.polygon(
      {{8.5, 38.6}, {21.5, 38.6}, {21.5, 67}, {13.8, 67}, {13.8, 65.8}, {12.6, 65.8}, {12.6, 67}, {8.5, 67}});
  plan.polygon(
      {{8.5, 69.6}, {21.5, 69.6}, {21.5, 97}, {8.5, 97}, {8.5, 80}, {9.6, 80}, {9.6, 78.6}, {8.5, 78.6}});
  plan.box(21.5, 14, 21.9, 15.8);
  plan.box(8.1, 50, 8.5, 52.2);
  plan.column({22.75, 98.6}, 0.3, 12);
  return plan.named("floor", {{7.2, 1.5},
                              {22.8, 1.6},
                              {22.7, 37.3},
                              {7.3, 37.2},
                              {7.2, 68.3},
                              {22.8, 68.3},
                              {22.7, 97.9},
                              {7.3, 98.2},
                              {7.2, 68.2},
                              {22.8, 68.4},
                              {22.7, 37.3},
                              {7.2, 37.3},
                              {7.2, 1.6},
                              {14, 1.5}});
}

namespace {

struct NamedWorld {
  const char* name;
  World (*make)();
};

constexpr NamedWorld kWorlds[] = {{"room", roomWorld},
                                  {"corridor", corridorWorld},
                                  {"periodic_corridor", periodicCorridorWorld},
                                  {"symmetric_rooms", symmetricRoomsWorld},
                                  {"loop", loopWorld},
                                  {"non_convex", nonConvexWorld},
                                  {"long_corridors", longCorridorsWorld},
                                  {"floor", officeFloorWorld}};

}  // namespace

std::vector<std::string> worldNames() {
  std::vector<std::string> names;
  for (const NamedWorld& world : kWorlds) names.emplace_back(world.name);
  return names;
}

World makeWorld(const std::string& name) {
  for (const NamedWorld& world : kWorlds)
    if (name == world.name) return world.make();
  throw ConfigError(
      fmt::format("unknown world '{}': expected one of {}", name, fmt::join(worldNames(), ", ")));
}

}  // namespace submap_slam
