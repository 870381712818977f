#include "scene/hidden.h"

#include <catch2/catch.hpp>

#include "core/parallel.h"
#include "meshes.h"

using namespace colod;
using test::box_mesh;

namespace {

Source shell_of(const Mesh& mesh) { return remove_hidden(test::as_source(mesh)); }

void expect_unchanged(const Mesh& mesh) {
  const Source s = shell_of(mesh);
  CHECK(s.mesh.faces.size() == mesh.faces.size());
  CHECK(s.warnings.empty());
  CHECK(s.left_out.empty());
}

/// A wall along x from (0, y) as boxes about a row of openings `width` wide, from z = 1 to z = 2.4.
Mesh wall_with_openings(double y, double thick, double height, int count, double width) {
  const double step = 4, length = count * step, side = (step - width) / 2;
  Mesh m = test::join(box_mesh({0, y, 0}, {length, y + thick, 1}),
                      box_mesh({0, y, 2.4}, {length, y + thick, height}));
  for (int i = 0; i < count; ++i) {
    const double x = i * step;
    m = test::join(m, box_mesh({x, y, 1}, {x + side, y + thick, 2.4}));
    m = test::join(m, box_mesh({x + step - side, y, 1}, {x + step, y + thick, 2.4}));
  }
  return m;
}

/// A storey of `count` bays of 4 m by `depth`, windows on both long sides, with inner walls.
Mesh furnished_storey(int count, double depth, double width) {
  const double length = 4.0 * count, height = 3;
  Mesh m = test::join(wall_with_openings(0, 0.3, height, count, width),
                      wall_with_openings(depth - 0.3, 0.3, height, count, width));
  m = test::join(m, box_mesh({0, 0.3, 0}, {0.3, depth - 0.3, height}));
  m = test::join(m, box_mesh({length - 0.3, 0.3, 0}, {length, depth - 0.3, height}));
  m = test::join(m, box_mesh({0, 0, -0.3}, {length, depth, 0}));
  m = test::join(m, box_mesh({0, 0, height}, {length, depth, height + 0.3}));
  for (int i = 1; i < count; ++i)
    m = test::join(m, box_mesh({4.0 * i, 0.3, 0}, {4.0 * i + 0.1, depth - 0.3, height}));
  return m;
}

/// A block of 12 × 8 × 6 m with a hole of that width, depth and height in its front, at its foot;
/// one as deep as the block leads through it.
Mesh block_with_niche(const Vec3& size) {
  const double x0 = 5, x1 = 5 + size.x(), y = size.y(), z = size.z();
  const auto quad = [](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    return Mesh{{a, b, c, d}, {{0, 1, 2}, {0, 2, 3}}};
  };
  Mesh m = box_mesh({0, 0, 0}, {12, 8, 6});
  m.faces.erase(m.faces.begin() + 4, m.faces.begin() + (y < 8 ? 6 : 8));  // its front; its back
  for (const double at : {0.0, 8.0}) {
    if (at > y) break;
    m = test::join(m, quad({0, at, 0}, {x0, at, 0}, {x0, at, 6}, {0, at, 6}));
    m = test::join(m, quad({x1, at, 0}, {12, at, 0}, {12, at, 6}, {x1, at, 6}));
    m = test::join(m, quad({x0, at, z}, {x1, at, z}, {x1, at, 6}, {x0, at, 6}));
  }
  m = test::join(m, quad({x0, 0, 0}, {x0, y, 0}, {x0, y, z}, {x0, 0, z}));
  m = test::join(m, quad({x1, y, 0}, {x1, 0, 0}, {x1, 0, z}, {x1, y, z}));
  m = test::join(m, quad({x0, 0, z}, {x0, y, z}, {x1, y, z}, {x1, 0, z}));
  if (y < 8) m = test::join(m, quad({x0, y, 0}, {x1, y, 0}, {x1, y, z}, {x0, y, z}));
  return m;
}

/// Area of faces whose middle lies in the box.
double area_within(const Mesh& mesh, const Box& box) {
  double sum = 0;
  for (const Face& f : mesh.faces) {
    const Vec3 c = (mesh.vertices[f[0]] + mesh.vertices[f[1]] + mesh.vertices[f[2]]) / 3;
    if ((c - box.min).minCoeff() > 0 && (box.max - c).minCoeff() > 0) sum += face_area(mesh, f);
  }
  return sum;
}

}  // namespace

TEST_CASE("single shells stay as they are") {
  expect_unchanged(test::gable_house(10, 8, 5, 3));
  expect_unchanged(box_mesh({0, 0, 0}, {60, 20, 12}));
  expect_unchanged(test::sphere_mesh(3));
  Mesh open = test::gable_house(10, 8, 5, 3);  // no floor: its inside is no outside
  open.faces.erase(open.faces.begin(), open.faces.begin() + 2);
  expect_unchanged(open);
}

TEST_CASE("courts and shafts are outside") {
  for (const double width : {1.0, 2.0, 6.0}) {  // between two wings
    Mesh m = box_mesh({0, 0, 0}, {20, 5, 9});
    m = test::join(m, box_mesh({0, 5 + width, 0}, {20, 10 + width, 9}));
    expect_unchanged(m);
  }
}

TEST_CASE("niches, porches and passages are outside") {
  for (const Vec3& size : {Vec3(1.2, 1.0, 2.2), Vec3(2.1, 3.4, 2.1), Vec3(4, 3, 2.4)})
    expect_unchanged(block_with_niche(size));
  for (const double width : {1.8, 2.4, 4.0})  // through the house
    expect_unchanged(block_with_niche({width, 8, 2.4}));
}

TEST_CASE("boxes that stand on each other are one shell") {
  for (const double over : {0.0, 0.1, 0.3, 1.2}) {
    Mesh m = box_mesh({0, 0, 0}, {14, 9, 3.2});
    m = test::join(m, box_mesh({-over, -over, 3.2}, {14 + over, 9 + over, 3.5}));
    m = test::join(m, box_mesh({5, 2, 3.5}, {9, 6, 5.8}));
    const Source s = shell_of(m);
    const double hidden = 2 * 14 * 9 + 2 * 4 * 4;
    CHECK(surface_area(s.mesh) == Approx(surface_area(m) - hidden).epsilon(0.02));
    REQUIRE(s.left_out.size() == 1);
    CHECK(s.left_out[0].reason == LeftOut::Reason::kInside);
    CHECK(s.left_out[0].area == Approx(hidden).epsilon(0.05));
    REQUIRE(s.warnings.size() == 1);
    CHECK(s.warnings[0].find("nobody sees") != std::string::npos);
  }
}

TEST_CASE("bodies that run through each other are cut where they meet") {
  for (const double turn : {0.0, 0.4}) {
    Mesh wing = box_mesh({-4, -3, 0}, {4, 3, 6});
    for (Vec3& v : wing.vertices) v = Eigen::AngleAxisd(turn, Vec3::UnitZ()) * v + Vec3(9, 10, 0);
    const Source s = shell_of(test::join(box_mesh({0, 0, 0}, {20, 10, 9}), wing));
    const double inside = area_within(s.mesh, {{0.01, 0.01, 0.01}, {19.99, 9.99, 8.99}});
    CHECK(inside < 0.5);  // of the wing's sides within the house
    CHECK(area_within(s.mesh, {{0, 9.9, 0}, {20, 10.1, 9}}) ==
          Approx(180 - 6 * 8 / std::cos(turn)).epsilon(0.05));  // its mouth is open
  }
}

TEST_CASE("of what people draw a small part's sunken end is left out, too") {
  const double size = GENERATE(0.5, 0.8, 1.2);  // of a chimney on a hall: 0.3 to 0.9 % are sunk
  const Mesh hall = box_mesh({0, 0, 0}, {24, 16, 8});
  const Mesh chimney = box_mesh({11, 7, 5}, {11 + size, 7 + size, 10});
  const Source s = shell_of(test::join(hall, chimney));
  REQUIRE(s.left_out.size() == 1);
  CHECK(s.left_out[0].share < 0.02);
  CHECK(s.warnings.empty());  // it stands in the report
  CHECK(area_within(s.mesh, {{10, 6, 4}, {13, 9, 7.9}}) == 0);
  CHECK(area_within(s.mesh, {{10, 6, 8.05}, {13, 9, 11}}) == Approx(8 * size + size * size));
}

TEST_CASE("rooms behind open windows are left out, at every size") {
  for (const int count : {2, 4, 12})
    for (const double width : {0.9, 1.6, 2.2}) {
      const double depth = 9, length = 4.0 * count;
      const Source s = shell_of(furnished_storey(count, depth, width));
      CHECK(area_within(s.mesh, {{0.4, 0.4, 0.1}, {length - 0.4, depth - 0.4, 2.9}}) < 0.5);
      CHECK(area_within(s.mesh, {{-1, -1, -1}, {length + 1, 0.2, 4}}) > 0.6 * length * 3);
    }
}

TEST_CASE("objects follow their faces, and threads change nothing") {
  Source two = test::as_source(
      test::join(box_mesh({0, 0, 0}, {14, 9, 3.2}), box_mesh({3, 2, 3.2}, {9, 6, 6})));
  for (std::size_t i = 0; i < two.mesh.faces.size(); ++i) two.face_object.push_back(i / 12);
  limit_threads(1);
  const Source one = remove_hidden(two);
  limit_threads(0);
  const Source many = remove_hidden(two);
  CHECK(one.mesh.faces == many.mesh.faces);
  CHECK(one.mesh.vertices == many.mesh.vertices);
  REQUIRE(one.face_object.size() == one.mesh.faces.size());
  for (std::size_t i = 0; i < one.mesh.faces.size(); ++i)
    for (const int v : one.mesh.faces[i])
      CHECK((one.face_object[i] == 1) == (one.mesh.vertices[v].z() > 3.2 ||
                                          (one.mesh.vertices[v].z() == 3.2 && one.face_object[i])));
}
