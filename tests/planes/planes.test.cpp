#include "planes/planes.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <set>

#include "core/error.h"
#include "core/parallel.h"
#include "meshes.h"
#include "planes/items.h"
#include "planes/regularize.h"
#include "planes_helpers.h"
#include "read/frame.h"

using namespace colod;
using namespace colod::test;

TEST_CASE("a box has six outward planes with exact outlines") {
  const Planes p = detect_planes(as_source(box_mesh({0, 0, 0}, {10, 6, 4})));
  REQUIRE(p.planes.size() == 6);
  CHECK(p.total_area == Approx(2 * (60 + 40 + 24)));
  for (const Plane& plane : p.planes) {
    CHECK(plane.signed_distance({5, 3, 2}) < -1.9);
    CHECK(plane.normal.cwiseAbs().maxCoeff() == 1.0);
    CHECK(outline_is_sound(plane));
    CHECK(outline_area(plane) == Approx(plane.area));
    CHECK(plane.outline.triangles.size() == 2);
  }
  CHECK(p.planes[0].area == Approx(60));
  CHECK(p.planes[5].area == Approx(24));
}

TEST_CASE("the box without its floor or one wall keeps outward normals") {
  Mesh m = box_mesh({0, 0, 0}, {10, 6, 4});
  m.faces.erase(m.faces.begin() + 4, m.faces.begin() + 6);
  m.faces.erase(m.faces.begin(), m.faces.begin() + 2);
  for (const Plane& plane : detect_planes(as_source(m)).planes)
    CHECK(plane.signed_distance({5, 3, 2}) < 0);
}

TEST_CASE("a gable house has seven planes, the roof's two sides at one tilt") {
  const Planes p = detect_planes(as_source(gable_house(12, 8, 5, 3)));
  REQUIRE(p.planes.size() == 7);
  std::vector<Vec3> slopes;
  for (const Plane& plane : p.planes)
    if (plane.normal.z() > 0.1 && plane.normal.z() < 0.99) slopes.push_back(plane.normal);
  REQUIRE(slopes.size() == 2);
  CHECK(slopes[0].z() == slopes[1].z());
  CHECK(slopes[0].y() == -slopes[1].y());
}

TEST_CASE("a hole stays a clockwise ring, a small one is filled") {
  for (const double hole : {2.0, 0.4}) {
    const Planes p = detect_planes(as_source(sheet_with_hole(8, hole)));
    REQUIRE(p.planes.size() == 1);
    CHECK(p.planes[0].outline.rings.size() == (hole > 1 ? 2 : 1));
    CHECK(outline_area(p.planes[0]) == Approx(hole > 1 ? 60.0 : 64.0));
    CHECK(outline_is_sound(p.planes[0]));
  }
}

TEST_CASE("a noisy corner of two walls gives two upright, orthogonal planes that meet") {
  const Planes p = detect_planes(as_source(noisy_corner(6, 4, 0.02)));
  REQUIRE(p.planes.size() == 2);
  CHECK(p.distance > 0.03);
  CHECK(p.planes[0].normal.z() == 0);
  CHECK(p.planes[0].normal.dot(p.planes[1].normal) == 0);
  for (const Plane& plane : p.planes) {
    CHECK(outline_area(plane) == Approx(24).epsilon(0.03));
    double least = 1;
    for (const Vec3& v : plane.outline.vertices) least = std::min(least, std::hypot(v.x(), v.y()));
    CHECK(least < 0.05);
  }
}

TEST_CASE("walls wound inward are turned by rays") {
  Mesh inverted = gable_house(12, 8, 5, 3);
  for (Face& f : inverted.faces) std::swap(f[1], f[2]);
  Mesh one_wall = gable_house(12, 8, 5, 3);
  std::swap(one_wall.faces[2][1], one_wall.faces[2][2]);
  std::swap(one_wall.faces[3][1], one_wall.faces[3][2]);
  for (const Mesh& m : {inverted, one_wall})
    for (const Plane& plane : detect_planes(as_source(m)).planes) {
      CHECK(plane.signed_distance({6, 4, 2.5}) < 0);
      CHECK(outline_is_sound(plane));
    }
}

TEST_CASE("a floater is dropped, an unconnected piece on the wall is kept") {
  Mesh m = join(box_mesh({0, 0, 0}, {10, 6, 4}), box_mesh({12, 2, 2}, {12.2, 2.2, 2.2}));
  const Planes without = detect_planes(as_source(m));
  CHECK(without.planes.size() == 6);
  CHECK(without.box.max.x() == 10);
  CHECK(without.total_area == Approx(2 * (60 + 40 + 24)));
  REQUIRE(without.warnings.size() == 1);
  CHECK(std::count(without.plane_of_item.begin(), without.plane_of_item.end(), kFloater) == 12);
  m = join(box_mesh({0, 0, 0}, {10, 6, 4}), box_mesh({10, 2, 2}, {10.2, 2.2, 2.2}));
  CHECK(detect_planes(as_source(m)).box.max.x() == 10.2);
}

TEST_CASE("what hangs in the air is dropped, what stands, is near or is large is kept") {
  const double size = GENERATE(0.5, 0.8, 1.1);  // metres a side: 1.5 to 7.3 m²
  const bool is_small = size < 0.6;             // under 0.2 % of all
  const Mesh hall = box_mesh({0, 0, 0}, {20, 12, 6});
  const auto box_with = [&](const Vec3& low, const Vec3& extent) {
    return detect_planes(as_source(join(hall, box_mesh(low, low + extent)))).box.max;
  };
  const Vec3 cube(size, size, size), canopy(2.8, 2 * size, 0.1);
  CAPTURE(size);
  CHECK(box_with({21.2, 2, 3}, cube).x() == 20);
  CHECK(box_with({21.2, 2, 0}, cube).x() == (is_small ? 20 : 21.2 + size));  // on the ground
  CHECK(box_with({8, 2, 6}, cube).z() == 6 + size);                          // a chimney
  CHECK(box_with({20.5, 2, 3}, cube).x() == (is_small ? 20 : 20.5 + size));  // a bay, torn off
  CHECK(box_with({21.2, 2, 3}, canopy).x() == (is_small ? 20 : 24));         // over 1 % of all
}

TEST_CASE("a sheet with both sides modelled is one plane") {
  Mesh m = sheet_with_hole(8, 2);
  const std::size_t n = m.faces.size();
  for (std::size_t f = 0; f < n; ++f)
    m.faces.push_back({m.faces[f][0], m.faces[f][2], m.faces[f][1]});
  CHECK(detect_planes(as_source(m)).planes.size() == 1);
}

TEST_CASE("walls that look opposite ways on one plane are two planes") {
  const Mesh m = join(box_mesh({0, 0, 0}, {10, 6, 4}), box_mesh({10, 1, 4}, {16, 5, 8}));
  std::vector<double> signs;
  for (const Plane& plane : detect_planes(as_source(m)).planes)
    if (std::abs(plane.normal.x()) == 1 && std::abs(plane.offset) == Approx(10))
      signs.push_back(plane.normal.x());
  std::sort(signs.begin(), signs.end());
  CHECK(signs == std::vector<double>{-1, 1});
}

TEST_CASE("parallel planes within the distance share normal and offset bit for bit") {
  Mesh m;
  for (int k = 0; k < 4; ++k)
    m = join(m, box_mesh({5.0 * k, 0.004 * k, 0}, {5.0 * k + 3, 6, 3 + 0.003 * k}));
  const Planes p = detect_planes(as_source(m));
  std::vector<double> front, top;
  for (const Plane& plane : p.planes) {
    if (plane.normal.y() == -1) front.push_back(plane.offset);
    if (plane.normal.z() == 1) top.push_back(plane.offset);
  }
  REQUIRE(front.size() == 4);
  REQUIRE(top.size() == 4);
  CHECK(std::count(front.begin(), front.end(), front[0]) == 4);
  CHECK(std::count(top.begin(), top.end(), top[0]) == 4);
}

TEST_CASE("hard input: one triangle, tiny or huge units, NaN") {
  Mesh triangle{{{0, 0, 0}, {3, 0, 0}, {0, 3, 1}}, {{0, 1, 2}}};
  CHECK(detect_planes(as_source(triangle)).planes.size() == 1);
  CHECK(detect_planes(as_source(box_mesh({0, 0, 0}, {.01, .006, .004}))).planes.size() == 6);
  CHECK(detect_planes(as_source(box_mesh({0, 0, 0}, {1e4, 6e3, 4e3}))).planes.size() == 6);
  Mesh bad = box_mesh({0, 0, 0}, {10, 6, 4});
  bad.vertices.push_back(Vec3::Constant(std::nan("")));
  bad.faces.push_back({0, 1, 8});
  bad.faces.push_back({0, 1, 1});
  const Planes p = detect_planes(as_source(bad));
  CHECK(p.planes.size() == 6);
  CHECK(p.plane_of_item[12] == -1);
  for (const Plane& plane : p.planes) CHECK(plane.centroid.allFinite());
  CHECK_THROWS_AS(detect_planes(as_source(Mesh{{{0, 0, 0}}, {{0, 0, 0}}})), Error);
}

TEST_CASE("the order of faces and vertices changes nothing") {
  const Source a = as_source(noisy_corner(6, 4, 0.02));
  const Source b = as_source(shuffled(a.mesh));
  const Planes p = detect_planes(localize(a, main_frame(a)));
  const Planes q = detect_planes(localize(b, main_frame(b)));
  CHECK(same_planes(p, q));
}

TEST_CASE("one and two threads give the same bits") {
  const Source source = as_source(noisy_corner(6, 4, 0.02));
  limit_threads(1);
  const Planes one = detect_planes(source);
  limit_threads(2);
  const Planes two = detect_planes(source);
  limit_threads(0);
  CHECK(same_planes(one, two));
}

TEST_CASE("how exact a surface is, is decided with the planes") {
  const auto surface_with = [](double noise) {
    return detect_planes(as_source(noisy_corner(6, 4, noise))).surface;
  };
  CHECK(surface_with(0) == Planes::Surface::kExact);
  CHECK(surface_with(0.003) == Planes::Surface::kClean);
  CHECK(surface_with(0.02) == Planes::Surface::kNoisy);
  CHECK(surface_at(kLeastDistance) == Planes::Surface::kClean);
  CHECK(surface_at(2 * kLeastDistance) == Planes::Surface::kNoisy);
}

TEST_CASE("a cloud of a box gives six planes of about its areas") {
  const Source source = box_cloud({8, 6, 4}, 0.15);
  const Planes p = detect_planes(source);
  REQUIRE(p.planes.size() == 6);
  for (const Plane& plane : p.planes) {
    CHECK(plane.signed_distance({4, 3, 2}) < 0);
    CHECK(outline_is_sound(plane));
  }
  CHECK(p.planes[0].area == Approx(48).epsilon(0.05));
  CHECK(p.planes[5].area == Approx(24).epsilon(0.05));
}

TEST_CASE("to the letter: CGAL's growing finds the planes of a finely meshed corner") {
  const Planes p = detect_planes(as_source(noisy_corner(6, 4, 0.02)), {.rules = RuleSet::none()});
  CHECK(p.distance == 0.2);
  CHECK(p.planes.size() >= 2);
  CHECK(p.planes[1].area > 20);
}

TEST_CASE("without the rule for faces a mesh is points, whatever its triangles") {
  const Mesh plain = box_mesh({0, 0, 0}, {4, 3, 2});
  for (const Mesh& mesh : {plain, join(plain, sheet({20, 0, 0}, {23, 0, 0}, 2))}) {
    const Planes p = detect_planes(as_source(mesh), {.rules = RuleSet::none()});
    CHECK(p.planes.size() == (mesh.faces.size() == 12 ? 6 : 7));
    CHECK(p.plane_of_item.size() == mesh.faces.size());  // of the mesh, not of the points
    CHECK(std::count(p.plane_of_item.begin(), p.plane_of_item.end(), -1) == 0);
    double area = 0;
    for (const Face& f : mesh.faces) area += face_area(mesh, f);
    CHECK(p.total_area == Approx(area));
    CHECK(p.planes[0].area == Approx(12).epsilon(0.1));  // an α-shape ends at its points
  }
  const Source small = as_source(box_mesh({0, 0, 0}, {1, 1, 1}));
  CHECK(detect_planes(small, {.rules = RuleSet::none()}).planes.size() == 6);
}

TEST_CASE("walls three centimetres apart are one plane, twenty are two; of few planes all stay") {
  for (const double step : {0.03, 0.2})
    for (const bool has_few : {false, true}) {
      Mesh m = join(box_mesh({0, 0, 0}, {5, 6, 4}), box_mesh({5, step, 0}, {10, 6, 4}));
      if (!has_few)
        m = join(m, join(box_mesh({2, 2, 4}, {8, 5, 6}), box_mesh({3, 3, 6}, {4, 4, 9})));
      std::set<double> offsets;
      const Planes planes = detect_planes(as_source(m));
      CHECK((planes.planes.size() <= kFewPlanes) == has_few);
      for (const Plane& plane : planes.planes)
        if (plane.normal.y() < -0.9 && plane.centroid.z() < 4) offsets.insert(plane.offset);
      CHECK(offsets.size() == (step < 0.1 && !has_few ? 1 : 2));
    }
}

TEST_CASE("a window's reveal is a plane on a large building, too, where there is no noise") {
  const Mesh m = join(box_mesh({0, 0, 0}, {30, 30, 10}), box_mesh({9, -0.4, 4}, {9.4, 0, 4.4}));
  CHECK(detect_planes(as_source(m)).planes.size() == 11);  // five of 0.16 of 3000 m²
}

TEST_CASE("walls of an exact model stay where they are, those of a noisy one are squared") {
  const double lean = 2e-3;  // off the right angle: 3 mm of its 5 m wall
  for (const double noise : {0.0, 0.02}) {
    Mesh m = noisy_corner(5, 6, noise);
    for (Vec3& v : m.vertices) v.x() += lean * v.y();
    const Planes found = detect_planes(as_source(m));
    REQUIRE(found.planes.size() == 2);
    const double cosine = std::abs(found.planes[0].normal.dot(found.planes[1].normal));
    CHECK(cosine == Approx(noise > 0 ? 0 : lean).margin(1e-5));
  }
}
