// What leans on buildings of made-up maps and is no building.
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "scene/classes.h"

using namespace colod;

namespace {

struct Plan {
  double x, y, width, depth;  // metres, from (45, 30) on
  float height = 6;
};

struct Settled {
  int buildings;
  double built, rest;  // m²
};

/// These, turned; those that come first lie on top.
Settled settled(const std::vector<Plan>& plans, double angle = 0, double cell = 0.4,
                bool is_told = false) {
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
      float top = 0;
      for (std::size_t n = plans.size(); n-- > 0;) {
        const Plan& plan = plans[n];
        if (u > plan.x && v > plan.y && u < plan.x + plan.width && v < plan.y + plan.depth)
          own = static_cast<int>(n), top = plan.height;
      }
      map.top.push_back(top);
      classes.of_cell.push_back(own < 0 ? SceneClass::kGround : SceneClass::kBuilding);
      classes.building.push_back(own);
    }
  classes.ground.assign(map.size(), 0);
  if (is_told) map.told = classes.of_cell;
  settle_annexes(map, classes);
  Settled out{classes.buildings, 0, 0};
  bool is_right = true;
  for (std::size_t i = 0; i < map.size(); ++i) {
    is_right &= (classes.building[i] >= 0) == (classes.of_cell[i] == SceneClass::kBuilding);
    out.built += (classes.building[i] >= 0) * cell * cell;
    out.rest += (classes.of_cell[i] == SceneClass::kRest) * cell * cell;
  }
  CHECK(is_right);
  return out;
}

constexpr Plan kHall = {0, 0, 50, 30};

}  // namespace

TEST_CASE("a wall that has melted is part of its hall, goods along it are the rest") {
  for (const double angle : {0.0, 0.3, 0.785, 1.2})
    for (const double cell : {0.4, 0.8})
      for (const double depth : {2.4, 4.0}) {
        CAPTURE(angle, cell, depth);
        const Settled wall = settled({kHall, {5, 30, 30, depth, 4}}, angle, cell);
        CHECK(wall.buildings == 1);
        CHECK(wall.rest == 0);
        const Settled goods = settled({kHall, {5, 30, 30, depth, 2.5}}, angle, cell);
        CHECK(goods.buildings == 1);
        CHECK(goods.built == Approx(1500).epsilon(0.03));
        CHECK(goods.rest == Approx(30 * depth).epsilon(0.15));
      }
}

TEST_CASE("what leans on an annex is part of the hall, too") {
  CHECK(settled({kHall, {5, 30, 25, 4}, {9, 34, 3, 2}}).buildings == 1);
}

TEST_CASE("a house that leans on a hall, or is not far smaller than its neighbour, stays") {
  for (const double angle : {0.0, 0.3, 0.785})
    for (const float height : {2.6f, 6.0f}) {
      CAPTURE(angle, height);
      CHECK(settled({kHall, {5, 30, 10, 8, height}}, angle).buildings == 2);
      CHECK(settled({{0, 0, 12, 9}, {12, 0, 3.5, 9, height}}, angle).buildings == 2);
    }
}

TEST_CASE("what stands apart from a hall, or touches it with its end, stays") {
  CHECK(settled({kHall, {5, 31, 30, 4}}).buildings == 2);
  CHECK(settled({kHall, {5, 30, 4, 30}}).buildings == 2);
}

TEST_CASE("what a source tells to be buildings stays so") {
  CHECK(settled({kHall, {5, 30, 30, 4, 2.5}}, 0, 0.4, true).rest == 0);
}

TEST_CASE("a place without buildings has no annexes") { CHECK(settled({}).buildings == 0); }
