// An airborne cloud as a surface: heights, classes, tiles, and what is refused.
#include "scene/cloud_surface.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <random>

#include "las_files.h"
#include "scene/classes.h"
#include "scene/looks_like_scene.h"
#include "scene/tiles.h"
#include "temporary_folder.h"

using namespace colod;
using namespace colod::test;
using Catch::Contains;

namespace {

/// Points at random over a square, so many a m²; `at` says how high and of which class.
std::vector<LasPoint> scattered(double side, double density,
                                const std::function<LasPoint(double x, double y)>& at) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(0, side);
  std::vector<LasPoint> out;
  for (int i = 0; i < side * side * density; ++i) {
    const double x = place(random), y = place(random);
    out.push_back(at(x, y));
    out.back().at.head<2>() = Vec2(x, y);
  }
  return out;
}

CloudSurface surface(const std::vector<LasPoint>& points, int format = 0) {
  const TemporaryFolder folder;
  const std::string path = (folder / "a.las").string();
  std::ofstream(path, std::ios::binary) << las(points, format > 5 ? 4 : 2, format);
  return surface_of({path}, {});
}

/// A level of four gabled houses of 12 by 12 m, whose roofs rise by `slope`, on level ground.
LasPoint four_houses(double x, double y, double slope) {
  const double u = std::fmod(x, 40) - 20, v = std::fmod(y, 40) - 20;
  if (std::abs(u) > 6 || std::abs(v) > 6) return {{0, 0, 0}, 2};
  return {{0, 0, 4 + slope * (6 - std::abs(u))}, 6};
}

}  // namespace

TEST_CASE("a slope comes out as it is, at any density, and a step stays within a cell") {
  const double density = GENERATE(2, 8, 20), slope = GENERATE(0.0, 0.3, 1.0);
  CAPTURE(density, slope);
  const auto height = [&](double x) { return slope * x + (x > 20 ? 5 : 0); };
  const CloudSurface s = surface(scattered(40, density, [&](double x, double) {
    return LasPoint{{0, 0, height(x)}, 1};
  }));
  CHECK(s.density == Approx(density).epsilon(0.1));
  CHECK(s.map.cell >= 0.4);
  double off = 0;
  int far = 0, cells = 0;
  for (int y = 1; y + 1 < s.map.height; ++y)
    for (int x = 1; x + 1 < s.map.width; ++x) {
      const double at = s.map.middle(x, y).x() - kLasOffset.x();
      if (std::abs(at - 20) < 2.5 * s.map.cell) continue;
      const double d = std::abs(s.map.top[s.map.at(x, y)] - kLasOffset.z() - height(at));
      REQUIRE_FALSE(std::isnan(d));  // gaps are closed
      off += d, far += d > 0.3 * s.map.cell * slope + 0.01, ++cells;
    }
  CHECK(off / cells < 0.1 * s.map.cell * slope + 0.01);
  CHECK(far < 0.15 * cells);
}

TEST_CASE("roofs under crowns are seen where classes tell, and a bird is no surface") {
  auto points = scattered(40, 10, [](double x, double) {
    return x < 20 ? LasPoint{{0, 0, 6}, 6} : LasPoint{{0, 0, 0}, 2};
  });
  for (const LasPoint& p : scattered(40, 5, [](double, double) { return LasPoint{{0, 0, 11}, 5}; }))
    points.push_back(p);
  points.push_back({{30, 30, 90}, 1});
  const CloudSurface s = surface(points, GENERATE(0, 6));
  std::map<SceneClass, int> count;
  for (std::size_t i = 0; i < s.map.size(); ++i) ++count[s.map.told[i]];
  const auto all = static_cast<int>(s.map.size());
  CHECK(count[SceneClass::kBuilding] == Approx(all / 2).epsilon(0.05));
  CHECK(count[SceneClass::kPlant] > all / 3);
  for (const float z : s.map.top) CHECK(z < kLasOffset.z() + 12);
}

TEST_CASE("tiles of a cloud meet in the same vertices, and show each cell's square once") {
  const double side = GENERATE(30, 60, 140);
  const CloudSurface s = surface(scattered(side, 10, [](double x, double y) {
    return LasPoint{{0, 0, std::sin(x) + y}, 1};
  }));
  std::vector<Source> tiles;
  std::size_t faces = 0;
  for (int i = 0; i < tile_count(s.map); ++i) {
    tiles.push_back(surface_tile(s.map, i));
    faces += tiles.back().mesh.faces.size();
    CHECK(tiles.back().mesh.faces.size() > 5000);  // no slivers
  }
  CHECK(tiles.size() == (side > 100 ? 9 : 1));
  const Source whole = joined(tiles);
  CHECK(faces == 2 * static_cast<std::size_t>(s.map.width - 1) * (s.map.height - 1));
  CHECK(whole.mesh.vertices.size() == s.map.size());
}

TEST_CASE("four houses are told, by classes and without, on roofs of any slope") {
  const double slope = GENERATE(0.0, 0.5, 1.4), density = GENERATE(4, 12);
  CAPTURE(slope, density);
  auto points =
      scattered(80, density, [&](double x, double y) { return four_houses(x, y, slope); });
  const CloudSurface told = surface(points);
  CHECK(classify(told.map).buildings == 4);
  CHECK_THAT(looks_like_scene(told.map).place, Contains("4 buildings stand apart"));
  for (LasPoint& p : points) p.kind = 1;
  const CloudSurface untold = surface(points);
  CHECK(classify(untold.map).buildings == 4);
  CHECK_THAT(untold.warnings.at(0), Contains("no points of class 2"));
}

TEST_CASE("clouds that cannot become a place are refused in one line") {
  const auto house = [](double, double) { return LasPoint{{0, 0, 6}, 6}; };
  CHECK_THROWS_WITH(surface(scattered(20, 8, house)), Contains("buildings alone (class 6)"));
  const auto bare = [](double, double) { return LasPoint{{0, 0, 0}, 2}; };
  CHECK_THROWS_WITH(surface(scattered(60, 0.1, bare)), Contains("too few to tell buildings by"));
  CHECK(looks_like_scene(surface(scattered(60, 4, bare)).map).place.empty());
  CHECK_THROWS_WITH(surface({{{0, 0, 0}, 7}}), Contains("no points but noise"));
}
