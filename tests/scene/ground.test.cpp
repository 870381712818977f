#include "scene/ground.h"

#include <catch2/catch.hpp>

#include "meshes.h"

using namespace colod;

namespace {

/// A rectangle over [x0, x1] × [y0, y1] at height slope · x, in pieces of about 1 m.
Mesh terrain(double x0, double y0, double x1, double y1, double slope = 0) {
  Mesh m;
  const int n = static_cast<int>(x1 - x0), k = static_cast<int>(y1 - y0);
  for (int j = 0; j <= k; ++j)
    for (int i = 0; i <= n; ++i) {
      const double x = x0 + (x1 - x0) * i / n;
      m.vertices.emplace_back(x, y0 + (y1 - y0) * j / k, slope * x);
    }
  for (int j = 0; j < k; ++j)
    for (int i = 0; i < n; ++i) {
      const int v = j * (n + 1) + i;
      m.faces.push_back({v, v + 1, v + n + 2});
      m.faces.push_back({v, v + n + 2, v + n + 1});
    }
  return m;
}

/// Without its floor.
Mesh house() {
  Mesh m = test::gable_house(10, 8, 5, 3);
  m.faces.erase(m.faces.begin(), m.faces.begin() + 2);
  return m;
}

Mesh moved(Mesh m, const Vec3& by) {
  for (Vec3& v : m.vertices) v += by;
  return m;
}

Source separated(const Mesh& mesh) { return separate_ground(test::as_source(mesh)); }

void expect_unchanged(const Mesh& mesh) {
  const Source s = separated(mesh);
  CHECK(s.mesh.faces.size() == mesh.faces.size());
  CHECK(s.warnings.empty());
}

/// Terrain in pieces of a metre that waves by so much, its rim closed by strips down to a plate.
Mesh reconstructed_plot(double size, double depth, double waves) {
  Mesh m = terrain(-size / 2, -size / 2, size / 2, size / 2);
  for (Vec3& p : m.vertices) p.z() = waves * std::sin(p.x() / 5) * std::cos(p.y() / 7);
  const auto n = static_cast<int>(size);
  std::vector<int> rim;
  for (int i = 0; i < n; ++i) rim.push_back(i);
  for (int i = 0; i < n; ++i) rim.push_back(i * (n + 1) + n);
  for (int i = n; i > 0; --i) rim.push_back(n * (n + 1) + i);
  for (int i = n; i > 0; --i) rim.push_back(i * (n + 1));
  const auto base = static_cast<int>(m.vertices.size()), count = static_cast<int>(rim.size());
  for (const int v : rim) m.vertices.push_back({m.vertices[v].x(), m.vertices[v].y(), -depth});
  for (int i = 0; i < count; ++i) {
    const int next = (i + 1) % count;
    m.faces.push_back({rim[i], base + i, base + next});
    m.faces.push_back({rim[i], base + next, rim[next]});
    if (i > 1) m.faces.push_back({base, base + i, base + i - 1});
  }
  return m;
}

}  // namespace

TEST_CASE("the house is kept, its ground is not") {
  const Source s = separated(test::join(house(), terrain(-6, -6, 16, 14)));
  CHECK(surface_area(s.mesh) == Approx(surface_area(house())));
  CHECK(s.mesh.vertices.size() == house().vertices.size());
  REQUIRE(s.warnings.size() == 1);
  CHECK(s.warnings[0].find("ground") != std::string::npos);
}

TEST_CASE("ground on a slope, with the house's place left open") {
  for (const double slope : {0.0, 0.1, -0.15}) {
    Mesh site = moved(house(), {0, 0, std::min(0.0, 10 * slope)});
    for (const Mesh& m : {terrain(-6, -6, 16, 0, slope), terrain(-6, 8, 16, 14, slope),
                          terrain(-6, 0, 0, 8, slope), terrain(10, 0, 16, 8, slope)})
      site = test::join(site, m);
    CHECK(surface_area(separated(site).mesh) == Approx(surface_area(house())));
  }
}

TEST_CASE("cars go with the ground, a second house stays") {
  const Mesh car = test::box_mesh({-5, 1, 0}, {-3, 5, 1.5});
  const Mesh second = moved(house(), {20, 3, 0});
  const Mesh site =
      test::join(test::join(test::join(house(), terrain(-8, -6, 36, 18)), car), second);
  CHECK(surface_area(separated(site).mesh) == Approx(2 * surface_area(house())));
}

TEST_CASE("faces keep their objects and order") {
  Source s = test::as_source(test::join(house(), terrain(-6, -6, 16, 14)));
  for (std::size_t i = 0; i < s.mesh.faces.size(); ++i)
    s.face_object.push_back(static_cast<int>(i));
  const Source part = separate_ground(s);
  REQUIRE(part.face_object.size() == part.mesh.faces.size());
  for (std::size_t i = 0; i < part.face_object.size(); ++i)
    CHECK(part.face_object[i] == static_cast<int>(i));
}

TEST_CASE("a building alone stays as it is, with and without floor, with a lean-to around it") {
  expect_unchanged(house());
  expect_unchanged(test::gable_house(10, 8, 5, 3));
  expect_unchanged(
      test::join(test::box_mesh({-5, -5, 0}, {15, 13, 2.5}), moved(house(), {0, 0, 2.5})));
  expect_unchanged(test::box_mesh({0, 0, 0}, {20, 10, 3}));
}

TEST_CASE("roofs without walls and ground without a house stay as they are") {
  expect_unchanged(test::join(terrain(0, 0, 20, 20), moved(terrain(5, 5, 15, 15), {0, 0, 4})));
  expect_unchanged(terrain(0, 0, 20, 20, 0.1));
  expect_unchanged(test::sphere_mesh(3));
}

TEST_CASE("points, nothing and numbers that are none do no harm") {
  Source cloud;
  cloud.cloud.points = {{0, 0, 0}, {1, 2, 3}};
  CHECK(separate_ground(cloud).cloud.points.size() == 2);
  Mesh m = test::join(house(), terrain(-6, -6, 16, 14));
  m.vertices.push_back(Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
  m.faces.push_back({0, 1, static_cast<int>(m.vertices.size()) - 1});
  CHECK(separated(m).mesh.faces.size() == house().faces.size());
  expect_unchanged({});
}

namespace {

/// A flat-roofed block of 12 × 10 m whose roof stands out on all sides, with a set-back storey on
/// it.
Mesh stepped_block(double overhang, double height) {
  const double o = overhang, h = height;
  Mesh m = test::box_mesh({0, 0, 0}, {12, 10, h});
  m = test::join(m, test::box_mesh({-o, -o, h}, {12 + o, 10 + o, h + 0.3}));
  return test::join(m, test::box_mesh({3, 3, h + 0.3}, {8, 7, h + 3.1}));
}

/// A plot with a skirt and a plate below it, as watertight reconstructions close their rim.
Mesh closed_plot(double size, double depth) {
  Mesh top = terrain(-size / 2, -size / 2, size / 2, size / 2);
  Mesh box = test::box_mesh({-size / 2, -size / 2, -depth}, {size / 2, size / 2, 0});
  const auto is_top = [&](const Face& f) {
    return box.vertices[f[0]].z() == 0 && box.vertices[f[1]].z() == 0 &&
           box.vertices[f[2]].z() == 0;
  };
  std::erase_if(box.faces, is_top);
  return test::join(top, box);
}

}  // namespace

TEST_CASE("a flat roof that stands out is no ground, however far") {
  for (const double overhang : {0.0, 0.3, 0.6, 1.0, 1.5, 1.9})
    for (const double height : {2.6, 3.2, 7.0}) {
      INFO(overhang << " m over walls of " << height);
      expect_unchanged(stepped_block(overhang, height));
    }
}

TEST_CASE("a podium with houses on it is no ground") {
  const Mesh podium = test::box_mesh({-10, -10, -4}, {30, 25, 0});
  expect_unchanged(test::join(podium, test::join(house(), moved(house(), {15, 5, 0}))));
}

TEST_CASE("a plot of any size is ground, also with a skirt and a plate below") {
  for (const double size : {30.0, 48.0, 90.0})
    for (const double depth : {0.0, 0.5, 1.5}) {
      INFO(size << " m, " << depth << " m deep");
      const Mesh plot =
          depth > 0 ? closed_plot(size, depth) : terrain(-size / 2, -size / 2, size / 2, size / 2);
      const Source s = separated(test::join(moved(house(), {-4, -3, 0}), plot));
      REQUIRE(s.left_out.size() == 1);
      CHECK(surface_area(s.mesh) == Approx(surface_area(house())).epsilon(0.1));
    }
}

TEST_CASE("a plot that is closed down to a plate is ground however deep, an even one is a podium") {
  for (const double size : {30.0, 48.0, 90.0})
    for (const double depth : {1.0, 3.0, 10.0}) {
      INFO(size << " m, " << depth << " m deep");
      const Mesh on_it = moved(house(), {-4, -3, 0});
      const Source s = separated(test::join(on_it, reconstructed_plot(size, depth, 0.15)));
      REQUIRE(s.left_out.size() == 1);
      CHECK(surface_area(s.mesh) == Approx(surface_area(house())).epsilon(0.1));
      if (depth > 2) expect_unchanged(test::join(on_it, reconstructed_plot(size, depth, 0)));
    }
}

TEST_CASE("walls that come down in high narrow faces come down") {
  for (const double height : {4.0, 7.0, 25.0})
    for (const double width : {0.2, 1.0}) {
      INFO(height << " m high, in strips of " << width << " m");
      const int strips = static_cast<int>(std::lround(12 / width));
      Mesh tower;
      const std::array<Vec2, 5> corners = {Vec2{0, 0}, {12, 0}, {12, 12}, {0, 12}, {0, 0}};
      for (std::size_t side = 0; side < 4; ++side)
        for (int i = 0; i < strips; ++i) {
          const Vec2 step = (corners[side + 1] - corners[side]) / strips;
          const Vec2 a = corners[side] + i * step, b = a + step;
          const int v = static_cast<int>(tower.vertices.size());
          for (const Vec3& p : {Vec3(a.x(), a.y(), 0), Vec3(b.x(), b.y(), 0),
                                Vec3(b.x(), b.y(), height), Vec3(a.x(), a.y(), height)})
            tower.vertices.push_back(p);
          tower.faces.push_back({v, v + 1, v + 2}), tower.faces.push_back({v, v + 2, v + 3});
        }
      tower = test::join(tower, moved(terrain(0, 0, 12, 12), {0, 0, height}));
      const Source s = separated(test::join(tower, terrain(-24, -24, 40, 40)));
      REQUIRE(s.left_out.size() == 1);
      CHECK(surface_area(s.mesh) == Approx(surface_area(tower)).epsilon(0.1));
    }
}
