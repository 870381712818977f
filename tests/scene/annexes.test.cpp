// What leans on buildings of made-up maps becomes part of them.
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "scene/classes.h"

using namespace colod;

namespace {

struct Plan {
  double x, y, width, depth;  // metres, from (30, 30) on
};

/// How many of these, turned, remain; those that come first lie on top.
int remain(const std::vector<Plan>& plans, double angle = 0, double cell = 0.4) {
  HeightMap map;
  map.cell = cell, map.width = map.height = static_cast<int>(110 / cell);
  const Vec2 along(std::cos(angle), std::sin(angle)), across(-along.y(), along.x());
  SceneClasses classes;
  classes.buildings = static_cast<int>(plans.size());
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      const Vec2 p = map.middle(x, y) - Vec2(45, 30);
      const double u = p.dot(along), v = p.dot(across);
      int own = -1;
      for (std::size_t n = plans.size(); n-- > 0;) {
        const Plan& plan = plans[n];
        if (u > plan.x && v > plan.y && u < plan.x + plan.width && v < plan.y + plan.depth)
          own = static_cast<int>(n);
      }
      classes.building.push_back(own);
    }
  map.top.assign(classes.building.size(), 5);
  join_annexes(map, classes);
  return classes.buildings;
}

constexpr Plan kHall = {0, 0, 50, 30};

}  // namespace

TEST_CASE("a canopy along a hall is part of it, whichever way the hall stands") {
  for (const double angle : {0.0, 0.3, 0.785, 1.2})
    for (const double cell : {0.4, 0.8})
      for (const double depth : {2.4, 4.0}) {
        CAPTURE(angle, cell, depth);
        CHECK(remain({kHall, {5, 30, 30, depth}}, angle, cell) == 1);
      }
}

TEST_CASE("a canopy of a canopy is part of the hall, too") {
  CHECK(remain({kHall, {5, 30, 25, 4}, {9, 34, 3, 2}}) == 1);
}

TEST_CASE("a house that leans on a hall, or is not far smaller than its neighbour, stays") {
  for (const double angle : {0.0, 0.3, 0.785}) {
    CAPTURE(angle);
    CHECK(remain({kHall, {5, 30, 10, 8}}, angle) == 2);
    CHECK(remain({{0, 0, 12, 9}, {12, 0, 3.5, 9}}, angle) == 2);
  }
}

TEST_CASE("what stands apart from a hall, or touches it with its end, stays") {
  CHECK(remain({kHall, {5, 31, 30, 4}}) == 2);
  CHECK(remain({kHall, {5, 30, 4, 30}}) == 2);
}

TEST_CASE("a place without buildings has no annexes") { CHECK(remain({}) == 0); }
