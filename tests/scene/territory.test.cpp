// Surfaces cut along footprints.
#include "scene/territory.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <map>

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

/// Whose ground a place is; −1: no one's.
int owner(const Territories& t, const Vec2& p) {
  for (const Territories::Piece& piece : t.pieces()) {
    bool is_inside = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 &a = piece.corners[k], &b = piece.corners[(k + 1) % 3];
      is_inside &= (b - a).x() * (p - a).y() >= (b - a).y() * (p - a).x();
    }
    if (is_inside) return piece.building;
  }
  return -1;
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

TEST_CASE("a building's ground is in few pieces, whatever stands around it") {
  std::vector<Footprint> rows;
  for (int k = 0; k < 12; ++k) rows.push_back(square(9 * k, 0, 9, 10, std::to_string(k)));
  rows.push_back(square(40, 12.5, 20, 8, "beyond"));
  const Territories t(rows);
  std::vector<int> count(rows.size());
  for (const Territories::Piece& p : t.pieces()) ++count[static_cast<std::size_t>(p.building)];
  for (std::size_t b = 0; b < rows.size(); ++b) CHECK(count[b] < 24);
  CHECK(t.coarser(0.001).pieces().size() < 48);  // the row is one
  CHECK(t.coarser(0.5).pieces().size() < t.coarser(0.001).pieces().size());
  for (const auto& [x, y] : {std::array{4.0, 5.0}, {50.0, 16.0}, {50.0, 11.0}, {109.4, 5.0}}) {
    CHECK(t.covers({x, y}));
    CHECK(t.coarser(0.001).covers({x, y}));
  }
  CHECK_FALSE(t.coarser(0.001).covers({10, 12}));
  CHECK(t.coarser(0.001).area(0) == Approx(12 * 90 + 160));
}

TEST_CASE("between footprints that stand close the middle of the gap is the border") {
  const Source ground = level_ground(40, 8);
  const Territories t({square(10, 10, 9, 10, "a"), square(20, 10, 9, 10, "b")});
  for (const double y : {12.0, 15.0, 18.0}) {
    INFO(y);
    CHECK(owner(t, {19.49, y}) == 0);
    CHECK(owner(t, {19.51, y}) == 1);
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

TEST_CASE("what is left of faces hangs together, in few faces, with a rim at the border alone") {
  const double step = GENERATE(1.0, 2.5, 8.0);
  const double turn = GENERATE(0.05, 0.3, 1.1);
  Footprint f = square(-9, -6, 18, 12);
  f.parts[0][0] = {{-9, -6}, {9, -6}, {9, 6}, {2, 6}, {2, 1}, {-9, 1}};  // an L
  for (Vec2& p : f.parts[0][0])
    p = Vec2(20 + std::cos(turn) * p.x() - std::sin(turn) * p.y(),
             20 + std::sin(turn) * p.x() + std::cos(turn) * p.y());
  const Territories t({f, square(3, 3, 2, 2, "shed")});
  Source ground = level_ground(40, step);
  for (Vec3& p : ground.mesh.vertices) p.z() = 0.1 * p.x() + std::sin(p.x()) + std::cos(p.y() / 2);
  ground = joined({ground});
  const Source rest = t.cut_out(ground, -1);
  CAPTURE(step, turn, ground.mesh.faces.size(), rest.mesh.faces.size());
  double inside = 0;
  for (int b = 0; b < 2; ++b) inside += surface_area(t.cut_out(ground, b).mesh);
  CHECK(surface_area(rest.mesh) + inside == Approx(surface_area(ground.mesh)).epsilon(1e-6));
  CHECK(rest.mesh.faces.size() < 1.3 * ground.mesh.faces.size() + 60);
  std::map<std::array<int, 2>, int> uses;
  for (const Face& face : rest.mesh.faces)
    for (std::size_t k = 0; k < 3; ++k)
      ++uses[{std::min(face[k], face[(k + 1) % 3]), std::max(face[k], face[(k + 1) % 3])}];
  int inner = 0;
  for (const auto& [edge, count] : uses) {
    if (count == 2) continue;
    REQUIRE(count == 1);
    const Vec2 a = rest.mesh.vertices[static_cast<std::size_t>(edge[0])].head<2>(),
               b = rest.mesh.vertices[static_cast<std::size_t>(edge[1])].head<2>();
    const Vec2 middle = (a + b) / 2, aside = 1e-4 * Vec2(a.y() - b.y(), b.x() - a.x()).normalized();
    const bool is_rim = middle.minCoeff() < 1e-9 || middle.maxCoeff() > 40 - 1e-9;
    inner += !is_rim && t.covers(middle + aside) == t.covers(middle - aside);
  }
  CHECK(inner == 0);
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
