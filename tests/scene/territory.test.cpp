// Surfaces cut along footprints.
#include "scene/territory.h"

#include <catch2/catch.hpp>

#include "scene/tiles.h"
#include "scenes.h"

using namespace colod;
using namespace colod::test;

namespace {

constexpr double kEaves = 1.5;

Footprint square(double x, double y, double w, double h, const std::string& id = "a") {
  return {id, {{{{x, y}, {x + w, y}, {x + w, y + h}, {x, y + h}}}}, {}};
}

Source level_ground(double side, double step) {
  Source s;
  s.mesh = terrain_with_boxes(side, step, {});
  return s;
}

Box box_of(const Source& s) { return bounding_box(s.mesh.vertices); }

}  // namespace

TEST_CASE("faces are cut exactly at the border that two footprints share") {
  const Source ground = level_ground(40, 8);  // no edge of it lies at x = 19
  const Territories t({square(10, 10, 9, 10, "a"), square(19, 10, 9, 10, "b")});
  const Source a = t.cut_out(ground, 0), b = t.cut_out(ground, 1);
  CHECK(box_of(a).max.x() == Approx(19).margin(1e-9));
  CHECK(box_of(b).min.x() == Approx(19).margin(1e-9));
  CHECK(t.area(0) == Approx(90));
  CHECK(t.area(1) == Approx(90));
  const double eaves = kEaves * (9 + 9 + 10);  // three free sides, corners apart
  CHECK(surface_area(a.mesh) > 90 + eaves);
  CHECK(surface_area(a.mesh) < 90 + eaves + 2 * 4 * kEaves * kEaves);
  const Source rest = t.cut_out(ground, -1);
  CHECK(surface_area(a.mesh) + surface_area(b.mesh) + surface_area(rest.mesh) ==
        Approx(1600).epsilon(1e-9));
}

TEST_CASE("between footprints that stand close the middle of the gap is the border") {
  const Source ground = level_ground(40, 8);
  const Territories t({square(10, 10, 9, 10, "a"), square(20, 10, 9, 10, "b")});
  for (const double y : {12.0, 15.0, 18.0}) {
    INFO(y);
    const auto reach = [&](int b) {
      Box box;
      for (const Territories::Piece& p : t.pieces())
        for (const Vec2& c : p.corners)
          if (p.building == b && std::abs(c.y() - y) < 4) box.extend(Vec3(c.x(), c.y(), 0));
      return box;
    };
    CHECK(reach(0).max.x() == Approx(19.5).margin(0.01));
    CHECK(reach(1).min.x() == Approx(19.5).margin(0.01));
  }
}

TEST_CASE("a courtyard is a hole of its footprint but for the eaves in it") {
  Footprint f = square(5, 5, 30, 30);
  f.parts[0].push_back({{15, 15}, {15, 25}, {25, 25}, {25, 15}});
  const Territories t({f});
  CHECK(t.area(0) == Approx(800));
  const Source inside = t.cut_out(level_ground(40, 8), -1);
  Box box;
  for (const Vec3& p : inside.mesh.vertices)
    if (p.x() > 10 && p.x() < 30 && p.y() > 10 && p.y() < 30) box.extend(p);
  CHECK(box.min.x() == Approx(15 + kEaves).margin(1e-6));
  CHECK(box.max.y() == Approx(25 - kEaves).margin(1e-6));
}

TEST_CASE("upright walls on a border go to one side only, and textures go along") {
  Source s;
  s.mesh.vertices = {{19, 12, 0}, {19, 18, 0}, {19, 18, 6}, {15, 12, 0}, {23, 12, 0}, {19, 18, 0}};
  s.mesh.faces = {{0, 1, 2}, {3, 4, 5}};
  s.look.images = {{"picture.jpg"}};
  s.look.materials.resize(1);
  s.look.materials[0].image = 0;
  s.look.face_material = {0, 0};
  for (const Face& f : s.mesh.faces) {
    std::array<Vec2f, 3> uvs;
    for (std::size_t k = 0; k < 3; ++k)
      uvs[k] = s.mesh.vertices[static_cast<std::size_t>(f[k])].head<2>().cast<float>() / 100;
    s.look.uvs.push_back(uvs);
  }
  const Territories t({square(10, 10, 9, 10, "a"), square(19, 10, 9, 10, "b")});
  const Source a = t.cut_out(s, 0), b = t.cut_out(s, 1);
  CHECK(surface_area(a.mesh) + surface_area(b.mesh) == Approx(surface_area(s.mesh)));
  for (const Source* part : {&a, &b}) {
    REQUIRE(part->look.uvs.size() == part->mesh.faces.size());
    for (std::size_t f = 0; f < part->mesh.faces.size(); ++f)
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& p = part->mesh.vertices[static_cast<std::size_t>(part->mesh.faces[f][k])];
        CHECK((part->look.uvs[f][k] - p.head<2>().cast<float>() / 100).norm() < 1e-5f);
      }
  }
}

TEST_CASE("of ground that two footprints cover the first has it") {
  const Territories t({square(10, 10, 10, 10, "a"), square(15, 10, 10, 10, "b")});
  CHECK(t.area(0) == Approx(100));
  CHECK(t.area(1) == Approx(50));
}

TEST_CASE("tiles are joined where their vertices are equal") {
  Source a = level_ground(8, 4), b = a;
  for (Vec3& p : b.mesh.vertices) p.x() += 8;
  const Source both = joined({a, b});
  CHECK(both.mesh.faces.size() == a.mesh.faces.size() + b.mesh.faces.size());
  CHECK(both.mesh.vertices.size() == 15);  // 5 by 3 corners
}

TEST_CASE("content that lies on its side is turned where nothing says how it stands") {
  const TempFolder folder;
  const Mesh ground = terrain_with_boxes(40, 4, {Box{{8, 8, 0}, {20, 24, 6}}});
  folder.write("z.glb", glb_of(ground));
  const std::string path = folder.write("tileset.json", tileset_of(tile_of("z.glb")));
  const auto box = [&](Up up, bool may_turn) {
    ReadOptions options;
    options.up = up;
    const SceneTiles tiles(list_tiles(path), Eigen::Matrix4d::Identity(), 0, may_turn, options);
    return tiles.box().size();
  };
  CHECK((box(Up::kUnsaid, true) - Vec3(40, 40, 6)).norm() < 1e-6);
  CHECK((box(Up::kZ, true) - Vec3(40, 40, 6)).norm() < 1e-6);
  CHECK((box(Up::kY, true) - Vec3(40, 6, 40)).norm() < 1e-6);
  CHECK((box(Up::kUnsaid, false) - Vec3(40, 6, 40)).norm() < 1e-6);
}
