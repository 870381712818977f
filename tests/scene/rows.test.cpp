// Rows of houses on made-up height maps, parted along their party walls.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "scene/classes.h"

using namespace colod;

namespace {

struct RowHouse {
  double width, eaves;
  Rgb color = {170, 90, 80};
};

/// Houses side by side from (10, 10) on, 10 m deep, under one gable along the row, turned; noise of
/// 3 cm.
struct Row {
  HeightMap map;
  SceneClasses classes;
  std::vector<int> truth;  ///< per cell: the house; −1: none

  Row(const std::vector<RowHouse>& houses, double angle, double cell) {
    std::mt19937 random(3);
    std::normal_distribution<double> noise(0, 0.03);
    map.cell = cell, map.width = map.height = static_cast<int>(90 / cell);
    const Vec2 along(std::cos(angle), std::sin(angle)), across(-along.y(), along.x());
    for (int y = 0; y < map.height; ++y)
      for (int x = 0; x < map.width; ++x) {
        const Vec2 p = map.middle(x, y) - Vec2(35, 10);
        double u = p.dot(along);
        const double v = p.dot(across);
        int house = u < 0 || v < 0 || v > 10 ? -1 : 0;
        while (house >= 0 && u > houses[static_cast<std::size_t>(house)].width) {
          u -= houses[static_cast<std::size_t>(house)].width;
          if (++house == static_cast<int>(houses.size())) house = -1;
        }
        const auto h = static_cast<std::size_t>(std::max(0, house));
        const double z = house < 0 ? 0 : houses[h].eaves + 0.6 * (5 - std::abs(v - 5));
        map.top.push_back(static_cast<float>(z + noise(random)));
        map.color.push_back(house < 0 ? Rgb{120, 120, 120} : houses[h].color);
        truth.push_back(house);
      }
    classes.building = truth;
    for (int& b : classes.building) b = std::min(b, 0);
    classes.buildings = 1;
    classes.ground.assign(map.size(), 0);
    part_rows(map, classes);
  }

  /// Houses of which one building has at least seven tenths, and they of it: a wall may stand two
  /// cells beside where it is.
  int found(int houses) const {
    int count = 0;
    for (int h = 0; h < houses; ++h)
      for (int b = 0; b < classes.buildings; ++b) {
        double both = 0, any = 0;
        for (std::size_t i = 0; i < truth.size(); ++i) {
          const bool is_own = truth[i] == h, is_found = classes.building[i] == b;
          both += is_own && is_found, any += is_own || is_found;
        }
        count += both > 0.7 * any;
      }
    return count;
  }
};

/// Into how many buildings one block is parted, on a square map. `roof`: of a place, in metres from
/// its corner, the roof's height, 0 where there is none, and its colour.
template <typename Roof>
int parted(double side, Roof roof) {
  HeightMap map;
  map.cell = 0.4, map.width = map.height = static_cast<int>(side / map.cell);
  SceneClasses classes;
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      const auto [height, color] = roof(map.middle(x, y));
      map.top.push_back(height);
      map.color.push_back(color);
      classes.building.push_back(height > 0 ? 0 : -1);
    }
  classes.buildings = 1;
  classes.ground.assign(map.size(), 0);
  part_rows(map, classes);
  return classes.buildings;
}

constexpr Rgb kGrey = {120, 120, 120};

}  // namespace

TEST_CASE("rows are parted where roofs step, turned and in cells of any size") {
  for (const double angle : {0.0, 0.3, 1.2})
    for (const double cell : {0.4, 0.5}) {
      CAPTURE(angle, cell);
      const Row row({{6, 6}, {7, 6.8}, {6.5, 9}, {8, 8.2}}, angle, cell);
      CHECK(row.classes.buildings == 4);
      CHECK(row.found(4) == 4);
    }
}

TEST_CASE("two houses of a size are a pair, a small house with a lower third is one") {
  for (const double angle : {0.0, 0.3, 1.2}) {
    CAPTURE(angle);
    CHECK(Row({{6, 6}, {6, 7}}, angle, 0.4).found(2) == 2);
    CHECK(Row({{8, 6}, {3.8, 7}}, angle, 0.4).classes.buildings == 1);
    CHECK(Row({{4, 6}, {4.5, 7}}, angle, 0.4).classes.buildings == 1);
  }
}

TEST_CASE("rows of one height are parted where their colour changes") {
  const Row row({{7, 6}, {8, 6, {90, 90, 95}}, {6, 6, {190, 110, 90}}}, 0.2, 0.4);
  CHECK(row.classes.buildings == 3);
  CHECK(row.found(3) == 3);
}

TEST_CASE("what is alike, too small or too deep is not parted") {
  for (const double angle : {0.0, 0.5}) {
    CHECK(Row({{12, 6}}, angle, 0.4).classes.buildings == 1);
    CHECK(Row({{6, 6}, {7, 6}, {8, 6}}, angle, 0.4).classes.buildings == 1);
    CHECK(Row({{8, 6}, {2.5, 8}}, angle, 0.4).classes.buildings == 1);
  }
}

TEST_CASE("a house with a lower wing is one, two houses that stand out from each other are two") {
  const auto beside = [](double turned, double depth, double from) {
    return parted(60, [=](const Vec2& at) {
      const Vec2 p = at - Vec2(25, 10);
      const double u = p.x() * std::cos(turned) + p.y() * std::sin(turned);
      const double v = p.y() * std::cos(turned) - p.x() * std::sin(turned);
      const bool is_house = u > 0 && u < 9 && v > 0 && v < 12;
      const bool is_other = u >= 9 && u < 17 && v > from && v < from + depth;
      return std::pair(is_house ? 6.0f : is_other ? 5.5f : 0.0f, kGrey);
    });
  };
  for (const double turned : {0.0, 0.35}) {
    CAPTURE(turned);
    CHECK(beside(turned, 7, 0) == 1);
    CHECK(beside(turned, 6.5, 3) == 1);
    CHECK(beside(turned, 12, 0) == 2);
    CHECK(beside(turned, 12, 1.2) == 2);
  }
}

TEST_CASE("an office with a roof house is one building") {
  for (const double depth : {11.0, 14.0})
    for (const double gap : {1.6, 3.0}) {
      CAPTURE(depth, gap);
      CHECK(parted(40, [=](const Vec2& at) {
              const Vec2 p = at - Vec2(8, 8);
              const bool is_in = p.x() > 0 && p.x() < 20 && p.y() > 0 && p.y() < depth;
              const bool is_top = p.x() > 6 && p.x() < 13 && p.y() > gap && p.y() < depth - gap;
              return std::pair(is_top  ? 12.0f
                               : is_in ? 9.6f
                                       : 0.0f,
                               is_in ? Rgb{160, 160, 155} : kGrey);
            }) == 1);
    }
}

TEST_CASE("an area of another colour is a house in a block of houses, and a sign on a hall") {
  const auto block = [](double length, double depth) {
    return parted(length + 4, [=](const Vec2& at) {
      const Vec2 p = at - Vec2(2, 2);
      const bool is_roof = p.x() > 0 && p.y() > 0 && p.x() < length && p.y() < depth;
      const bool is_white = p.x() > 5 && p.y() > 6 && p.x() < 13 && p.y() < 12;
      return std::pair(is_roof ? 8.0f : 0.0f, is_roof && is_white ? Rgb{230, 230, 230} : kGrey);
    });
  };
  CHECK(block(20, 16) >= 2);
  CHECK(block(30, 20) >= 2);
  CHECK(block(80, 40) == 1);
  CHECK(block(150, 60) == 1);
}

TEST_CASE("a place without buildings stays as it is") {
  HeightMap map;
  map.width = map.height = 10, map.cell = 0.4;
  map.top.assign(100, 0);
  SceneClasses classes;
  classes.building.assign(map.size(), -1);
  part_rows(map, classes);
  CHECK(classes.buildings == 0);
}
