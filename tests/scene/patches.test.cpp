// Regions of made-up height maps parted at necks and where their colours change.
#include "scene/patches.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <set>

using namespace colod;

namespace {

constexpr Rgb kRed = {170, 90, 80}, kGrey = {120, 120, 120}, kWhite = {220, 220, 215};

/// Roofs on a map whose corner they are turned about.
struct Roofs {
  HeightMap map;
  std::vector<int> region;
  double angle;

  Roofs(double side, double turned, double cell) : angle(turned) {
    map.cell = cell, map.width = map.height = static_cast<int>(side / cell);
    map.top.assign(static_cast<std::size_t>(map.width) * map.height, 0);
    map.color.assign(map.size(), kGrey);
    region.assign(map.size(), -1);
  }

  /// Level at 6 m.
  Roofs& add(double x, double y, double w, double h, const Rgb& color = kGrey) {
    return add(x, y, w, h, color, [](double, double) { return 6.0; });
  }
  template <typename Height>
  Roofs& add(double x, double y, double w, double h, const Rgb& color, Height height) {
    for_each(x, y, w, h, [&](std::size_t i, double u, double v) {
      region[i] = 0, map.color[i] = color, map.top[i] = static_cast<float>(height(u, v));
    });
    return *this;
  }

  int patches(const std::vector<int>& patch) const {
    std::set<int> all;
    for (std::size_t i = 0; i < map.size(); ++i) {
      REQUIRE((patch[i] >= 0) == (region[i] >= 0));
      if (patch[i] >= 0) all.insert(patch[i]);
    }
    return static_cast<int>(all.size());
  }
  /// Of a rectangle the share that one patch has.
  double held(const std::vector<int>& patch, double x, double y, double w, double h) {
    std::vector<double> cells(map.size(), 0);
    double all = 0;
    for_each(x, y, w, h, [&](std::size_t i, double, double) {
      ++all, ++cells[static_cast<std::size_t>(patch[i])];
    });
    return *std::max_element(cells.begin(), cells.end()) / all;
  }

 private:
  template <typename Body>
  void for_each(double x, double y, double w, double h, Body body) {
    const Vec2 along(std::cos(angle), std::sin(angle)), across(-along.y(), along.x());
    const Vec2 corner(map.width * map.cell * std::sin(angle) * std::cos(angle), 0);
    for (int row = 0; row < map.height; ++row)
      for (int column = 0; column < map.width; ++column) {
        const Vec2 p = map.middle(column, row) - corner;
        const double u = p.dot(along), v = p.dot(across);
        if (u >= x && u < x + w && v >= y && v < y + h) body(map.at(column, row), u, v);
      }
  }
};

}  // namespace

TEST_CASE("roofs that touch at a corner or by a passage are parted, wings are not") {
  const double size = GENERATE(10.0, 14.0, 40.0), angle = GENERATE(0.0, 0.5),
               cell = GENERATE(0.4, 0.47);
  CAPTURE(size, angle, cell);
  const double side = 4 * size;
  Roofs corner(side, angle, cell);  // 1.5 m of both sides in common
  corner.add(2, 2, size, size).add(2 + size, 2 + size - 1.5, size, size);
  const std::vector<int> two = part_at_necks(corner.map, corner.region);
  CHECK(corner.patches(two) == 2);
  CHECK(corner.held(two, 2, 2, size, size) > 0.95);
  CHECK(corner.held(two, 2 + size, 2 + size - 1.5, size, size) > 0.95);
  Roofs passage(side, angle, cell);
  passage.add(2, 2, size, size).add(2 + size, 4, 3, 1.6).add(5 + size, 2, size, size);
  CHECK(passage.patches(part_at_necks(passage.map, passage.region)) == 2);
  Roofs wing(side, angle, cell);
  wing.add(2, 2, size, size).add(2 + size, 2, size, 4.2);
  CHECK(wing.patches(part_at_necks(wing.map, wing.region)) == 1);
  Roofs porch(side, angle, cell);  // too small to be a building of its own
  porch.add(2, 2, size, size).add(2 + size, 4, 1.5, 1.6).add(3.5 + size, 2, 3, 4);
  CHECK(porch.patches(part_at_necks(porch.map, porch.region)) == 1);
}

TEST_CASE("roofs of one height are parted where colours change, whichever way the border runs") {
  const double size = GENERATE(8.0, 15.0), angle = GENERATE(0.0, 0.5, 1.2),
               cell = GENERATE(0.4, 0.6);
  CAPTURE(size, angle, cell);
  Roofs four(3 * size + 6, angle, cell);
  four.add(2, 2, size, size, kRed).add(2 + size, 2, size, size, kWhite);
  four.add(2, 2 + size, size, size).add(2 + size, 2 + size, size, size, kRed);
  const std::vector<int> patch = part_at_tints(four.map, four.region);
  CHECK(four.patches(patch) == 4);
  for (const double x : {2.0, 2 + size})
    for (const double y : {2.0, 2 + size}) CHECK(four.held(patch, x, y, size, size) > 0.9);
  HeightMap grey = four.map;
  grey.color.clear();
  CHECK(four.patches(part_at_tints(grey, four.region)) == 1);
  HeightMap points = four.map;
  points.is_sharp = true;
  CHECK(four.patches(part_at_tints(points, four.region)) == 1);
}

TEST_CASE("the two sides of a ridge, small houses and what stands about on roofs are one patch") {
  const double cell = GENERATE(0.4, 0.5);
  const auto gable = [](double, double v) { return 6 + 0.6 * (5 - std::abs(v - 7)); };
  Roofs ridge(40, 0.3, cell);  // the sun is on one side
  ridge.add(2, 2, 14, 5, {90, 60, 62}, gable).add(2, 7, 14, 5, {200, 120, 105}, gable);
  CHECK(ridge.patches(part_at_tints(ridge.map, ridge.region)) == 1);
  Roofs small(40, 0.3, cell);
  small.add(2, 2, 4, 10, kRed).add(6, 2, 4, 10, kWhite);
  CHECK(small.patches(part_at_tints(small.map, small.region)) == 1);
  Roofs hall(60, 0.3, cell);
  hall.add(2, 2, 30, 20).add(8, 8, 1.2, 1.2, kRed).add(20, 12, 1.4, 1.4, kWhite);
  CHECK(hall.patches(part_at_tints(hall.map, hall.region)) == 1);
}

TEST_CASE("colours that are noise part nothing") {
  const double size = GENERATE(11.0, 25.0);
  const int stripe = GENERATE(1, 3);  // cells
  Roofs roof(size + 4, 0.3, 0.4);
  roof.add(2, 0, size, size);
  std::mt19937 random(4);
  std::vector<std::uint8_t> grey(roof.map.size());
  for (std::size_t i = 0; i < grey.size(); ++i)
    grey[i] = static_cast<std::uint8_t>(i % static_cast<std::size_t>(stripe) ? grey[i - 1]
                                                                             : random() % 256);
  for (std::size_t i = 0; i < grey.size(); ++i) roof.map.color[i] = {grey[i], 100, 90};
  CHECK(roof.patches(part_at_tints(roof.map, roof.region)) == 1);
}

TEST_CASE("an empty map and one without a region have no patch") {
  Roofs none(20, 0, 0.4);
  CHECK(none.patches(part_at_necks(none.map, none.region)) == 0);
  CHECK(none.patches(part_at_tints(none.map, none.region)) == 0);
  CHECK(part_at_necks(HeightMap(), {}).empty());
  CHECK(part_at_tints(HeightMap(), {}).empty());
}
