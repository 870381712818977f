// A mesh that is taken for one building: whether it is a place, a piece of one, or terrain.
#include "scene/looks_like_scene.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "meshes.h"
#include "scene/tiles.h"
#include "scenes.h"

using namespace colod;
using namespace colod::test;

namespace {

/// What a tiler cuts out of a measured place: bumpy ground, nothing quite level, straight sides.
Source tile_with(double side, const std::vector<Box>& houses) {
  Source s;
  s.mesh = terrain_with_boxes(side, 0.5, houses);
  for (Vec3& p : s.mesh.vertices)
    p += Vec3(0.005 * std::sin(5 * p.z()), 0.005 * std::cos(5 * p.z()),
              0.03 * p.x() + 0.1 * std::sin(p.y() / 5) + 0.02 * std::sin(7 * p.x() + 3 * p.y()));
  return joined({s});
}

Box house(double x, double y, double length, double width) {
  return {{x, y, 0}, {x + length, y + width, 6}};
}

}  // namespace

TEST_CASE("a tile whose border cuts a house off is a piece of a scene") {
  const double side = GENERATE(20, 30, 45, 70);
  CAPTURE(side);
  const PlaceDoubt doubt =
      looks_like_scene(tile_with(side, {house(side / 2, side - 6, 9, 6), house(3, 3, 6, 7)}));
  CHECK(doubt.is_certain);
  CHECK_THAT(doubt.why,
             Catch::Contains("cuts through buildings") || Catch::Contains("2 buildings"));
}

TEST_CASE("a tile is known whichever way its sides run") {
  const double side = GENERATE(20, 45), turn_deg = GENERATE(7, 30, 45), shear = GENERATE(0.0, 0.3);
  CAPTURE(side, turn_deg, shear);
  Source tile = tile_with(side, {house(side / 2, side - 6, 9, 6), house(3, 3, 6, 7)});
  const double turn = turn_deg * std::numbers::pi / 180;
  for (Vec3& p : tile.mesh.vertices) {
    const double x = p.x() + shear * p.y(), y = p.y();
    p = {std::cos(turn) * x - std::sin(turn) * y, std::sin(turn) * x + std::cos(turn) * y, p.z()};
  }
  CHECK(looks_like_scene(tile).is_certain);
}

TEST_CASE("a tile of terrain with a tree is a piece of terrain, one with a small house is not") {
  const double side = GENERATE(20, 35, 60);
  CAPTURE(side);
  const PlaceDoubt bare = looks_like_scene(tile_with(side, {house(side / 2, side / 2, 1, 1)}));
  CHECK(bare.is_certain);
  CHECK_THAT(bare.why, Catch::Contains("piece of terrain"));
  const double width = side * std::sqrt(0.06);
  const PlaceDoubt plot =
      looks_like_scene(tile_with(side, {house(side / 3, side / 3, width, width)}));
  CHECK_FALSE(plot.is_certain);
}

TEST_CASE(
    "one house is one building however large its plot, but not where the border cuts it off") {
  const double side = GENERATE(45, 60, 90);
  CAPTURE(side);
  CHECK_FALSE(looks_like_scene(tile_with(side, {house(side / 3, side / 3, 10, 6)})).is_certain);
  CHECK(looks_like_scene(tile_with(side, {house(side / 3, side - 5, 9, 5)})).is_certain);
}

TEST_CASE("a house whole on its plot is one building, with a word where the plot is cut straight") {
  const double side = GENERATE(20, 30, 45);
  CAPTURE(side);
  Source plot = tile_with(side, {house(side / 4, side / 4, side / 2, side / 2)});
  const PlaceDoubt straight = looks_like_scene(plot);
  CHECK_FALSE(straight.is_certain);
  CHECK_THAT(straight.why, Catch::Contains("cut off straight on 4 sides"));
  for (Vec3& p : plot.mesh.vertices)  // as a hand cuts
    p += Vec3(std::sin(p.y()), std::sin(p.x()), 0) * (0.05 * side / 20);
  CHECK(looks_like_scene(plot).why.empty());
}

TEST_CASE("one side that is cut straight is a word's worth, three ragged ones beside it or not") {
  const double side = GENERATE(12, 20, 45);
  CAPTURE(side);
  Source plot = tile_with(side, {house(side / 4, side / 4, side / 2, side / 2)});
  for (Vec3& p : plot.mesh.vertices)
    if (p.y() > 0.7) p += Vec3(std::sin(2 * p.y()), std::sin(2 * p.x()), 0) * (0.1 * side / 20);
  const PlaceDoubt doubt = looks_like_scene(plot);
  CHECK_FALSE(doubt.is_certain);
  CHECK_THAT(doubt.why, Catch::Contains("cut off straight on 1 side of"));
}

TEST_CASE("a scan that ends at the feet of its walls is no piece of a scene") {
  const double side = GENERATE(20, 45);
  Source s = tile_with(side, {house(1, 1, side - 2, side - 2)});
  std::vector<Face> kept;  // roof and walls, no ground
  for (const Face& f : s.mesh.faces) {
    double top = -1;
    for (const int v : f) top = std::max(top, s.mesh.vertices[static_cast<std::size_t>(v)].z());
    if (top > 3) kept.push_back(f);
  }
  s.mesh.faces = kept;
  std::vector<Vec3> used;
  std::vector<int> to(s.mesh.vertices.size(), -1);
  for (Face& f : s.mesh.faces)
    for (int& v : f) {
      int& at = to[static_cast<std::size_t>(v)];
      if (at < 0) {
        at = static_cast<int>(used.size());
        used.push_back(s.mesh.vertices[static_cast<std::size_t>(v)]);
      }
      v = at;
    }
  s.mesh.vertices = used;
  CHECK(looks_like_scene(s).why.empty());
}
