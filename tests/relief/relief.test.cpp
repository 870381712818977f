#include "relief/relief.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <map>

#include "meshes.h"
#include "pipeline/pipeline.h"
#include "planes/planes_helpers.h"

using namespace colod;

namespace {

using Heights = std::function<double(double x, double y)>;

/// The surface over a square of side `side`, in uneven triangles of about `edge`: walls lean by one
/// of them.
Mesh field(double side, double edge, const Heights& height) {
  const int n = static_cast<int>(std::ceil(side / edge));
  Mesh m;
  for (int r = 0; r <= n; ++r)
    for (int c = 0; c <= n; ++c) {
      const double x = side * ((c + 0.2 * std::sin(37.0 * r + 11.0 * c)) / n - 0.5);
      const double y = side * ((r + 0.2 * std::sin(23.0 * r + 53.0 * c)) / n - 0.5);
      m.vertices.emplace_back(x, y, height(x, y));
    }
  for (int r = 0; r < n; ++r)
    for (int c = 0; c < n; ++c) {
      const int a = r * (n + 1) + c, b = a + 1, d = a + n + 1;
      m.faces.push_back({a, b, d + 1});
      m.faces.push_back({a, d + 1, d});
    }
  return m;
}

/// Bumps some metres wide.
double bump(double x, double y, double most) {
  return most * std::sin(1.9 * x + 0.7) * std::cos(1.3 * y - 0.4);
}

/// An L of `size`, a third of it missing, on ground.
Heights ell(double size, double height, double bulge) {
  return [=](double x, double y) {
    const double h = size / 2;
    const bool is_in = std::abs(x) < h && std::abs(y) < h && !(x > h / 3 && y > h / 3);
    return (is_in ? height : 0) + bump(x, y, bulge);
  };
}

int count(const Relief& relief, bool is_wall) {
  return static_cast<int>(std::count_if(
      relief.parts.begin(), relief.parts.end(),
      [&](const Relief::Part& p) { return p.is_wall == is_wall && !p.rings.empty(); }));
}

Source named(Mesh mesh) {
  Source source;
  source.name = source.given_name = "house";
  source.mesh = std::move(mesh);
  return source;
}

}  // namespace

TEST_CASE("a melted hall is its walls and one roof, at any size and density") {
  struct Case {
    double size, height, edge, bulge;
  };
  for (const Case c :
       {Case{12, 5, 0.3, 0.08}, {30, 8, 0.5, 0.1}, {30, 8, 1.5, 0.15}, {120, 8, 1.2, 0.15}}) {
    INFO(c.size << " m, edges of " << c.edge);
    const auto relief = find_relief(field(c.size + 4, c.edge, ell(c.size, c.height, c.bulge)));
    REQUIRE(relief);
    CHECK(count(*relief, false) == 1);
    CHECK(count(*relief, true) == 6);
    CHECK(relief->foot == Approx(0).margin(2 * c.bulge));
    for (const Relief::Part& p : relief->parts) {
      if (p.rings.empty()) continue;
      CHECK(p.normal.z() == Approx(p.is_wall ? 0 : 1).margin(1e-9));
      if (!p.is_wall) CHECK(p.offset == Approx(c.height).margin(c.bulge));
    }
  }
}

TEST_CASE("its layers are closed, upright, few, and hold its volume") {
  for (const double size : {14.0, 40.0}) {
    INFO(size);
    Options options;
    options.ns = 40;
    const Scene scene =
        build_scene({{named(field(size + 4, 0.6, ell(size, 9, 0.1)))}, {}}, options);
    REQUIRE(scene.buildings.size() == 1);
    const Building& b = scene.buildings[0];
    REQUIRE(b.failure.empty());
    const double volume = 9 * size * size * (1 - 1.0 / 9);
    for (const Layer& layer : b.layers) {
      CHECK(layer.validity.is_watertight);
      CHECK(layer.mesh.facets.size() <= 12);  // eight, and half as many again
      CHECK(signed_volume(layer.mesh.mesh()) == Approx(volume).epsilon(0.05));
      for (const PolygonMesh::Facet& f : layer.mesh.facets)
        CHECK((std::abs(f.normal.z()) < 0.01 || std::abs(f.normal.z()) > 0.99));
    }
  }
}

TEST_CASE("a pitched roof is two slopes of one tilt with a level ridge") {
  const auto house = [](double x, double y) {
    const bool is_in = std::abs(x) < 8 && std::abs(y) < 5;
    return (is_in ? 6 + 0.7 * (5 - std::abs(y)) : 0) + bump(x, y, 0.08);
  };
  const auto relief = find_relief(field(20, 0.4, house));
  REQUIRE(relief);
  std::vector<Vec3> normals;
  for (const Relief::Part& p : relief->parts)
    if (!p.is_wall && !p.rings.empty()) normals.push_back(p.normal);
  REQUIRE(normals.size() == 2);
  CHECK(normals[0].z() == Approx(normals[1].z()));
  CHECK((normals[0].head<2>() + normals[1].head<2>()).norm() < 1e-6);
  CHECK(std::atan(normals[0].head<2>().norm() / normals[0].z()) ==
        Approx(std::atan(0.7)).margin(0.05));
}

TEST_CASE("what stands around is left out, and told") {
  const auto garden = [](double x, double y) {
    const bool is_in = std::abs(x) < 6 && std::abs(y) < 6;
    const double crown = 4 - 1.5 * std::hypot(x - 9.5, y - 2);  // of a tree
    return (is_in ? 7 : std::max(0.0, crown) + bump(3 * x, 3 * y, 0.1)) + bump(x, y, 0.06);
  };
  const Mesh mesh = field(24, 0.4, garden);
  const auto relief = find_relief(mesh);
  REQUIRE(relief);
  CHECK(count(*relief, false) == 1);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Vec3& v = mesh.vertices[mesh.faces[f][0]];
    const double out = std::max(std::abs(v.x()), std::abs(v.y()));
    if (out > 7.5) CHECK(relief->is_left_out[f]);
    if (out < 5) CHECK(!relief->is_left_out[f]);
  }
}

TEST_CASE(
    "a strip of next door at the mesh's end is left out, of a fine mesh and of a coarse one") {
  for (const double edge : {0.4, 1.6}) {
    INFO(edge);
    const auto row = [](double x, double y) {  // a house whose party wall is x = 8
      const bool is_in = std::abs(y) < 7 && x > -8;
      return (is_in ? (x > 8 ? 12 : 6) : 0) + bump(x, y, 0.1);
    };
    const auto relief = find_relief(field(19.4, edge, row));
    REQUIRE(relief);
    for (const Relief::Part& p : relief->parts)
      if (!p.is_wall && !p.rings.empty()) CHECK(p.offset < 9);
  }
}

TEST_CASE("a low roof between higher neighbours is no ground") {
  const auto court = [](double x, double y) {
    const double roof = std::abs(x) < 7 ? 4 : 11;  // strips of next door on two sides
    return (std::abs(y) < 9 ? roof : 0) + bump(x, y, 0.06);
  };
  Mesh mesh = field(20, 0.4, court);
  for (Vec3& v : mesh.vertices) v.x() *= 16.0 / 20;  // the cut-out ends in these strips
  const auto relief = find_relief(mesh);
  REQUIRE(relief);
  CHECK(relief->foot == Approx(0).margin(0.3));
}

/// Walls below the rim of a square field, at two of its sides: one quad for each of its edges.
void hang_walls(Mesh& mesh, double side) {
  std::map<int, int> below;
  const auto under = [&](int v) {
    const auto [at, is_new] = below.try_emplace(v, static_cast<int>(mesh.vertices.size()));
    if (is_new) mesh.vertices.emplace_back(mesh.vertices[v].x(), mesh.vertices[v].y(), 0);
    return at->second;
  };
  const int n = static_cast<int>(std::lround(std::sqrt(mesh.vertices.size()))) - 1;
  REQUIRE(mesh.vertices.front().x() < 0.1 - side / 2);
  for (int i = 0; i < n; ++i)
    for (const auto& [a, b] : {std::pair{i + 1, i}, std::pair{i * (n + 1), (i + 1) * (n + 1)}}) {
      mesh.faces.push_back({a, b, under(b)});
      mesh.faces.push_back({a, under(b), under(a)});
    }
}

TEST_CASE("a low roof is no ground where the mesh ends at its rim and walls hang below") {
  const double size = GENERATE(18.0, 25.0);
  Mesh mesh = field(size, 0.15, [&](double x, double y) {
    const double next_door = std::clamp((x - 0.35 * size) / 1.2, 0.0, 1.0);  // at one side, melted
    return 4 + 8 * next_door + bump(x, y, 0.06);
  });
  hang_walls(mesh, size);
  const auto relief = find_relief(mesh);
  REQUIRE(relief);
  CHECK(relief->foot == Approx(0).margin(0.3));
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Vec3& v = mesh.vertices[mesh.faces[f][0]];
    const bool is_roof =
        v.x() > -0.45 * size && v.x() < 0.3 * size && std::abs(v.y()) < 0.45 * size;
    if (is_roof) CHECK(!relief->is_left_out[f]);
  }
}

/// A hall with a box of `rise` on its roof, `wide` across, or a pit where the rise is negative.
Heights hall_with_block(double size, double rise, double wide) {
  return [=](double x, double y) {
    if (std::max(std::abs(x), std::abs(y)) > size / 2) return bump(x, y, 0.06);
    const bool is_on = std::abs(x - size / 6) < wide / 2 && std::abs(y) < wide / 2;
    return 7 + (is_on ? rise : 0) + bump(x, y, 0.06);
  };
}

TEST_CASE("what stands off a roof, or is sunk into it, is an upright block") {
  struct Case {
    double size, edge, rise, wide;
  };
  for (const Case c : {Case{16, 0.3, 1.2, 2}, {16, 0.3, -1.5, 3}, {40, 0.5, 1.5, 2.5}}) {
    INFO(c.size << " m, edges of " << c.edge << ", rise " << c.rise);
    const auto relief =
        find_relief(field(c.size + 4, c.edge, hall_with_block(c.size, c.rise, c.wide)));
    REQUIRE(relief);
    CHECK(count(*relief, false) == 2);
    CHECK(count(*relief, true) == 8);
    double top = 7;
    for (const Relief::Part& p : relief->parts)
      if (!p.is_wall && !p.rings.empty() && std::abs(p.offset - 7) > std::abs(top - 7))
        top = p.offset;
    CHECK(top == Approx(7 + c.rise).margin(0.25));
  }
}

TEST_CASE("bumps as high as the noise of a roof are no blocks") {
  const auto relief = find_relief(field(20, 0.3, hall_with_block(16, 0.15, 2)));
  REQUIRE(relief);
  CHECK(count(*relief, false) == 1);
}

TEST_CASE("a hall that lies askew to all axes has four walls at right angles") {
  for (const double yaw : {0.2, 0.5, 0.8}) {
    INFO(yaw);
    const Vec2 u(std::cos(yaw), std::sin(yaw)), v(-u.y(), u.x());
    const auto relief = find_relief(field(30, 0.4, [&](double x, double y) {
      const bool is_in = std::abs(u.dot(Vec2(x, y))) < 9 && std::abs(v.dot(Vec2(x, y))) < 6;
      return (is_in ? 7 : 0) + bump(x, y, 0.08);
    }));
    REQUIRE(relief);
    CHECK(count(*relief, true) == 4);
    for (const Relief::Part& p : relief->parts)
      if (p.is_wall) {
        const Vec2 n = p.normal.head<2>();
        CHECK(std::max(std::abs(n.dot(u)), std::abs(n.dot(v))) > 0.999);
        CHECK(p.offset == Approx(std::abs(n.dot(u)) > 0.5 ? 9 : 6).margin(0.4));
      }
  }
}

TEST_CASE("a long roof that sags is one plane a slope") {
  for (const double length : {60.0, 100.0}) {
    INFO(length);
    const auto relief = find_relief(field(length + 4, 0.7, [&](double x, double y) {
      const bool is_in = std::abs(x) < length / 2 && std::abs(y) < 12;
      const double sag = 0.1 * std::cos(2 * M_PI * x / 50);
      return (is_in ? 8 + 0.25 * (12 - std::abs(y)) + sag : 0) + bump(x, y, 0.12);
    }));
    REQUIRE(relief);
    CHECK(count(*relief, false) == 2);
  }
}

TEST_CASE("spikes and slots of the rim leave no trace in the walls") {
  const auto ragged = [](double x, double y) {
    const bool is_hall = std::abs(x) < 9 && std::abs(y) < 6;
    const bool is_spike = x > 0 && x < 11.5 && std::abs(y - 2) < 0.3;
    const bool is_slot = x > -10 && x < -6.5 && std::abs(y + 1) < 0.3;
    return ((is_hall || is_spike) && !is_slot ? 6 : 0) + bump(x, y, 0.06);
  };
  const auto relief = find_relief(field(26, 0.3, ragged));
  REQUIRE(relief);
  CHECK(count(*relief, false) == 1);
  CHECK(count(*relief, true) == 4);
}

TEST_CASE("a block on the roof is on the finest layer, upright, and never half") {
  for (const double size : {16.0, 40.0}) {
    INFO(size);
    Options options;
    options.ns = 60;
    const Mesh mesh = field(size + 4, size / 50, hall_with_block(size, 2, size / 5));
    const Scene scene = build_scene({{named(mesh)}, {}}, options);
    REQUIRE(scene.buildings.size() == 1);
    const Building& b = scene.buildings[0];
    REQUIRE(b.failure.empty());
    const double hall = 7 * size * size, block = 2 * size * size / 25;
    for (const Layer& layer : b.layers) {
      CHECK(layer.validity.is_watertight);
      for (const PolygonMesh::Facet& f : layer.mesh.facets)
        CHECK((std::abs(f.normal.z()) < 0.01 || std::abs(f.normal.z()) > 0.99));
      const double volume = signed_volume(layer.mesh.mesh());
      const bool has_block = layer.mesh.facets.size() > 6;
      CHECK(volume == Approx(hall + (has_block ? block : 0)).epsilon(0.04));
    }
    CHECK(b.layers.back().mesh.facets.size() >= 11);  // six, and a block of five
    CHECK(b.layers.back().mesh.facets.size() <= 16);
  }
}

TEST_CASE("what is known more exactly than its relief is none") {
  CHECK(!find_relief(test::box_mesh({0, 0, 0}, {10, 8, 6})));
  CHECK(!find_relief(field(16, 0.4, [](double, double) { return 5.0; })));
  CHECK(!find_relief(test::noisy_corner(10, 6, 0.02)));  // leans both ways, as scans do
  CHECK(!find_relief(Mesh{}));
}
