#include "measure/metrics.h"

#include <catch2/catch.hpp>
#include <random>

#include "core/error.h"
#include "core/parallel.h"
#include "meshes.h"

using namespace colod;
using test::box_mesh;
using test::join;

namespace {

Mesh moved(Mesh m, const Vec3& by) {
  for (Vec3& v : m.vertices) v += by;
  return m;
}

Mesh unit_box(const Vec3& at = Vec3::Zero()) { return box_mesh(at, at + Vec3(1, 1, 1)); }

/// The same surface without shared vertices.
Mesh soup(const Mesh& m) {
  Mesh s;
  for (const Face& f : m.faces) {
    const int base = static_cast<int>(s.vertices.size());
    for (int v : f) s.vertices.push_back(m.vertices[v]);
    s.faces.push_back({base, base + 1, base + 2});
  }
  return s;
}

/// A square of side `size` at height z, n × n quads.
Mesh square(double size, double z, int n = 1) {
  Mesh m;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) m.vertices.emplace_back(size * i / n, size * j / n, z);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int v = j * (n + 1) + i;
      m.faces.push_back({v, v + 1, v + n + 2});
      m.faces.push_back({v, v + n + 2, v + n + 1});
    }
  return m;
}

/// 3 × 3 × 1, open to the sky in its middle.
Mesh courtyard_house() {
  Mesh m;
  for (const double z : {0, 1})
    for (const auto& [low, high] : {std::pair{0, 3}, {1, 2}})
      for (const auto& [x, y] : {std::pair{low, low}, {high, low}, {high, high}, {low, high}})
        m.vertices.emplace_back(x, y, z);
  const auto quad = [&](int a, int b, int c, int d) {
    m.faces.push_back({a, b, c});
    m.faces.push_back({a, c, d});
  };
  for (int i = 0; i < 4; ++i) {
    const int j = (i + 1) % 4;
    quad(i, j, j + 8, i + 8);            // outer wall
    quad(j + 4, i + 4, i + 12, j + 12);  // inner wall
    quad(i + 8, j + 8, j + 12, i + 12);  // roof
    quad(j, i, i + 4, j + 4);            // floor
  }
  return m;
}

Mesh moebius_strip(int n) {
  Mesh m;
  for (int i = 0; i < n; ++i) {
    const double t = 2 * M_PI * i / n;
    for (double s : {-0.3, 0.3})
      m.vertices.emplace_back((1 + s * std::cos(t / 2)) * std::cos(t),
                              (1 + s * std::cos(t / 2)) * std::sin(t), s * std::sin(t / 2));
  }
  for (int i = 0; i < n; ++i) {
    const int a = 2 * i, b = 2 * i + 1;
    const int c = i + 1 < n ? a + 2 : 1, d = i + 1 < n ? b + 2 : 0;  // the last quad is twisted
    m.faces.push_back({a, c, b});
    m.faces.push_back({b, c, d});
  }
  return m;
}

void expect_closed(const Mesh& m) {
  const Validity v = check_validity(m);
  CHECK(v.is_watertight);
  CHECK(v.is_manifold);
  CHECK(v.boundary_edges == 0);
  CHECK(v.misoriented_edges == 0);
  CHECK(v.self_intersections == 0);
  CHECK(v.degenerate_faces == 0);
}

}  // namespace

TEST_CASE("a box is closed, has six polygons and its volume, wherever it stands") {
  for (const Vec3& at : {Vec3(0, 0, 0), Vec3(1e6, -2e6, 300)}) {
    const Mesh m = box_mesh(at, at + Vec3(2, 3, 4));
    const Validity v = check_validity(m);
    expect_closed(m);
    CHECK(v.polygons == 6);
    CHECK(v.components == 1);
    CHECK(v.volume == Approx(24));
    CHECK(v.area == Approx(52));
  }
}

TEST_CASE("a soup is welded at equal coordinates, zero has one sign") {
  Mesh m = soup(box_mesh({0, 0, 0}, {1, 1, 1}));
  m.vertices[0].x() = -0.0;
  expect_closed(m);
  CHECK(check_validity(m).vertices == 36);
}

TEST_CASE("a house has seven polygons, a sphere one for each face") {
  CHECK(check_validity(test::gable_house(10, 8, 6, 3)).polygons == 7);
  const Mesh sphere = test::sphere_mesh(3);
  expect_closed(sphere);
  CHECK(check_validity(sphere).polygons == static_cast<int>(sphere.faces.size()));
  CHECK(check_validity(square(5, 1, 7)).polygons == 1);
}

TEST_CASE("the least width is a long strip's width, whatever its triangles") {
  CHECK(check_validity(unit_box()).least_width == Approx(0.5));  // 2 · 1 / 4
  Mesh strip = square(1, 0, 20);
  for (Vec3& v : strip.vertices) v = {100 * v.x(), 0.01 * v.y(), 0};
  CHECK(check_validity(strip).least_width == Approx(0.01).epsilon(1e-3));
  const Mesh slab = test::box_mesh({0, 0, 0}, {10, 10, 0.002});
  CHECK(check_validity(slab).least_width == Approx(0.002).epsilon(1e-3));
  CHECK(check_validity({}).least_width == 0);
}

TEST_CASE("a bent strip is not one polygon though neighbours nearly agree") {
  Mesh m = square(10, 0, 100);
  for (Vec3& v : m.vertices) v.z() = 0.004 * v.x() * v.x();  // 0.05° from one column to the next
  CHECK(check_validity(m, false).polygons > 10);
}

TEST_CASE("a hole leaves boundary edges and a bounded manifold") {
  Mesh m = unit_box();
  m.faces.pop_back();
  const Validity v = check_validity(m);
  CHECK_FALSE(v.is_watertight);
  CHECK(v.is_manifold);
  CHECK(v.boundary_edges == 3);
}

TEST_CASE("a flipped face is not watertight but manifold") {
  Mesh m = unit_box();
  std::swap(m.faces[4][0], m.faces[4][1]);
  const Validity v = check_validity(m);
  CHECK_FALSE(v.is_watertight);
  CHECK(v.is_manifold);
  CHECK(v.misoriented_edges == 3);
  CHECK(v.boundary_edges == 0);
}

TEST_CASE("a moebius strip is a manifold that cannot be oriented") {
  const Validity v = check_validity(moebius_strip(24));
  CHECK(v.is_manifold);
  CHECK_FALSE(v.is_watertight);
  CHECK(v.misoriented_edges > 0);
  CHECK(v.components == 1);
}

TEST_CASE("boxes that touch in an edge or a vertex are not manifold") {
  const Validity edge = check_validity(join(unit_box(), unit_box({1, 1, 0})));
  CHECK(edge.nonmanifold_edges == 1);
  CHECK(edge.nonmanifold_vertices == 2);
  CHECK_FALSE(edge.is_watertight);
  CHECK_FALSE(edge.is_manifold);
  const Validity vertex = check_validity(join(unit_box(), unit_box({1, 1, 1})));
  CHECK(vertex.nonmanifold_edges == 0);
  CHECK(vertex.nonmanifold_vertices == 1);
  CHECK(vertex.is_watertight);
  CHECK_FALSE(vertex.is_manifold);
  CHECK(vertex.components == 2);
  CHECK(vertex.self_intersections == 0);
}

TEST_CASE("boxes that cross intersect, boxes apart do not") {
  CHECK(check_validity(join(unit_box(), unit_box({0.5, 0.4, 0.3}))).self_intersections > 0);
  CHECK(check_validity(join(unit_box(), unit_box({1.5, 0, 0}))).self_intersections == 0);
  CHECK(check_validity(join(unit_box(), unit_box({0.5, 0.4, 0.3})), false).self_intersections == 0);
}

TEST_CASE("cavities and what stands in them are enclosed, annexes and courtyards' houses are not") {
  const auto box = [](double size, const Vec3& at) {
    return box_mesh(at, at + Vec3::Constant(size));
  };
  const auto turned = [](Mesh m) {
    for (Face& f : m.faces) std::swap(f[1], f[2]);
    return m;
  };
  const Mesh shell = box(10, Vec3::Zero());
  const Validity cavity = check_validity(join(shell, turned(box(4, {3, 3, 3}))));
  CHECK(cavity.is_watertight);
  CHECK(cavity.components == 2);
  CHECK(cavity.enclosed_components == 1);
  const Mesh furnished = join(join(shell, turned(box(4, {3, 3, 3}))), box(1, {4, 4, 4}));
  CHECK(check_validity(furnished).enclosed_components == 2);
  CHECK(check_validity(join(shell, box(4, {3, 3, 3}))).enclosed_components == 1);
  const Mesh at_a_corner{{{0, 0, 0}, {3, 1, 1}, {1, 3, 1}, {1, 1, 3}},
                         {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}};
  CHECK(check_validity(join(shell, at_a_corner)).enclosed_components == 1);
  CHECK(check_validity(join(shell, box(1, {12, 0, 0}))).enclosed_components == 0);
  CHECK(check_validity(join(box(1, {12, 0, 0}), shell)).enclosed_components == 0);

  const Validity courtyard = check_validity(join(courtyard_house(), box(0.5, {1.25, 1.25, 0.25})));
  CHECK(courtyard.is_watertight);
  CHECK(courtyard.components == 2);
  CHECK(courtyard.enclosed_components == 0);
  Mesh open = join(shell, box(1, {4, 4, 4}));
  open.faces.pop_back();
  CHECK(check_validity(open).enclosed_components == 0);  // nothing is inside an open surface
}

TEST_CASE("overlaps of neighbours count: folded, equal, and through a shared vertex") {
  Mesh m;
  m.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3, 0.5, 0}};
  m.faces = {{0, 1, 2}, {1, 0, 3}};
  CHECK(check_validity(m).self_intersections == 1);  // folded over the common edge
  m.vertices[3].y() = -0.5;
  CHECK(check_validity(m).self_intersections == 0);
  m.faces = {{0, 1, 2}, {1, 2, 0}};
  CHECK(check_validity(m).self_intersections == 1);  // the same face twice
  for (const std::int64_t n : {3, 50, 20'000}) {     // all pairs, without a look at each
    const Mesh box = unit_box();
    m = box;
    m.faces.insert(m.faces.end(), static_cast<std::size_t>(n - 1), box.faces[0]);
    CHECK(check_validity(m).self_intersections == n * (n - 1) / 2);
    m = join(m, unit_box({0.5, 0.4, 0.3}));
    const std::int64_t of_one =
        check_validity(join(box, unit_box({0.5, 0.4, 0.3}))).self_intersections;
    CHECK(check_validity(m).self_intersections >= n * (n - 1) / 2 + of_one);
  }
  m.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, 0.2, -1}, {0.5, 0.2, 1}};
  m.faces = {{0, 1, 2}, {0, 3, 4}};
  CHECK(check_validity(m).self_intersections == 1);  // pierced, with a common vertex
}

TEST_CASE("the number of crossing pairs is the brute force's, at any number of threads") {
  std::mt19937_64 random(7);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  Mesh m;
  for (int i = 0; i < 60; ++i)
    m = join(m, moved(square(0.4, 0), Vec3(unit(), unit(), std::floor(4 * unit()))));
  std::int64_t expected = 0;  // all in four planes: squares overlap where both ranges do
  for (int i = 0; i < 60; ++i)
    for (int j = 0; j < i; ++j)
      expected +=
          check_validity({m.vertices, {m.faces[2 * i], m.faces[2 * j]}}).self_intersections +
          check_validity({m.vertices, {m.faces[2 * i], m.faces[2 * j + 1]}}).self_intersections +
          check_validity({m.vertices, {m.faces[2 * i + 1], m.faces[2 * j]}}).self_intersections +
          check_validity({m.vertices, {m.faces[2 * i + 1], m.faces[2 * j + 1]}}).self_intersections;
  for (int threads : {1, 2}) {
    limit_threads(threads);
    CHECK(check_validity(m).self_intersections == expected);
  }
  limit_threads(0);
}

TEST_CASE("degenerate and broken faces are counted and harm nothing else") {
  Mesh m = unit_box();
  m.vertices.push_back({0.5, 0, 0});
  m.vertices.push_back(Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
  m.faces.push_back({0, 1, 8});  // collinear
  m.faces.push_back({0, 0, 1});
  m.faces.push_back({0, 1, 9});
  const Validity v = check_validity(m);
  CHECK(v.degenerate_faces == 3);
  CHECK_FALSE(v.is_watertight);
  CHECK(v.self_intersections == 0);
  CHECK(v.volume == Approx(1));
  CHECK(v.polygons == 6);
}

TEST_CASE("no faces: nothing is claimed") {
  const Validity v = check_validity({});
  CHECK_FALSE(v.is_watertight);
  CHECK_FALSE(v.is_manifold);
  CHECK(v.components == 0);
}

TEST_CASE("parallel planes are their offset apart, far from the origin too") {
  for (const Vec3& at : {Vec3(0, 0, 0), Vec3(1e6, -2e6, 300)}) {
    const Distances d = measure_distances(moved(square(4, 0), at), moved(square(4, 0.25), at));
    for (double value :
         {d.a_to_b, d.b_to_a, d.mean_a_to_b, d.mean_b_to_a, d.rms_a_to_b, d.rms_b_to_a})
      CHECK(value == Approx(0.25).epsilon(1e-6));
    CHECK(d.relative == Approx(0.25 / (4 * std::sqrt(2))).epsilon(1e-6));
  }
}

TEST_CASE("a mesh is no distance from itself, and its own from a moved copy") {
  const Mesh m = test::gable_house(10, 8, 6, 3);
  CHECK(measure_distances(m, m).a_to_b < 1e-9);
  CHECK(measure_distances(m, moved(m, {0, 0, 50})).a_to_b == Approx(50).epsilon(1e-6));
  CHECK(measure_distances(m, moved(m, {0, 0, 0.1})).b_to_a == Approx(0.1).epsilon(1e-6));
}

TEST_CASE("maxima are one-sided and see vertices that no sample hits") {
  const Mesh big = square(10, 0), small = square(5, 0);
  const Distances d = measure_distances(big, small, {.samples = 10});
  CHECK(d.a_to_b == Approx(5 * std::sqrt(2)).epsilon(1e-6));
  CHECK(d.b_to_a < 1e-6);
  CHECK(d.relative == Approx(0.5).epsilon(1e-6));
}

TEST_CASE("mean and rms are over the area") {
  // A ramp above a square: the distance to the square's plane is the height, mean h/2, rms h/√3.
  Mesh ramp = square(100, 0);
  for (Vec3& v : ramp.vertices) v.z() = 0.01 * v.x();
  const Distances d = measure_distances(ramp, square(100, 0));
  CHECK(d.mean_a_to_b == Approx(0.5).epsilon(1e-3));
  CHECK(d.rms_a_to_b == Approx(1 / std::sqrt(3)).epsilon(1e-3));
}

TEST_CASE("a finer sphere is a sagitta from a coarse one") {
  const Distances d = measure_distances(test::sphere_mesh(5), test::sphere_mesh(2));
  CHECK(d.b_to_a > 0.02);
  CHECK(d.b_to_a < 0.1);
  CHECK(d.a_to_b == Approx(d.b_to_a).epsilon(0.05));
}

TEST_CASE("a cloud is measured to the surface, the surface to its nearest point") {
  Source cloud;
  cloud.cloud.points = {{0, 0, 1}, {4, 4, 1}, {2, 2, 3}};
  cloud.cloud.points.push_back(Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
  const Distances d = measure_distances(cloud, square(4, 0));
  CHECK(d.a_to_b == Approx(3).epsilon(1e-6));
  CHECK(d.mean_a_to_b == Approx(5.0 / 3).epsilon(1e-6));
  CHECK(d.b_to_a == Approx(std::sqrt(4 + 4 + 9)).epsilon(1e-6));  // the corner (0, 4) to (2, 2, 3)
}

TEST_CASE("a mesh source is measured as its mesh") {
  const Mesh a = unit_box(), b = unit_box({0, 0, 0.5});
  CHECK(measure_distances(test::as_source(a), b).a_to_b == measure_distances(a, b).a_to_b);
}

TEST_CASE("broken faces and single points do not make a distance NaN") {
  Mesh m = square(4, 0);
  m.vertices.push_back(Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
  m.faces.push_back({0, 1, 4});
  m.faces.push_back({0, 0, 1});
  CHECK(measure_distances(m, square(4, 1)).b_to_a == Approx(1).epsilon(1e-6));
  Source point;
  point.cloud.points = {{1, 1, 2}};
  CHECK(measure_distances(point, square(4, 0)).relative == Approx(std::sqrt(4 + 9 + 9)));
  CHECK_THROWS_AS(measure_distances(Mesh{}, m), Error);
  CHECK_THROWS_AS(measure_distances(Source{}, m), Error);
}

TEST_CASE("what was left out counts in the raw maximum and not in the spread") {
  const Mesh floor = square(10, 0);
  Mesh both = test::join(floor, square(1, 4));  // a scrap, four metres up, of 1 % of the area
  const Source source = test::as_source(both);
  std::vector<char> is_scrap(both.faces.size(), 0);
  for (std::size_t f = floor.faces.size(); f < is_scrap.size(); ++f) is_scrap[f] = 1;
  const Mesh target = square(10, 0.5);
  const Distances all = DistanceGauge(source).measure_to(target);
  CHECK(all.taken.max == all.a_to_b);
  CHECK(all.taken.mean == Approx(all.mean_a_to_b));
  CHECK(all.taken.p95 == Approx(0.5).margin(1e-6));
  const Distances taken = DistanceGauge(source, {}, is_scrap).measure_to(target);
  CHECK(taken.a_to_b == Approx(3.5).margin(1e-6));
  CHECK(taken.taken.max == Approx(0.5).margin(1e-6));
  CHECK(taken.taken.p99 == Approx(0.5).margin(1e-6));
  CHECK(taken.taken.mean == Approx(0.5).margin(1e-6));
}

TEST_CASE("quantiles of a spread are those of the area") {
  Mesh steps;  // a tenth of the area 3 m up, the rest at 0
  steps = test::join(square(3, 0), square(1, 3));
  const Distances d = measure_distances(steps, square(3, 0));
  CHECK(d.taken.p95 == Approx(3).margin(1e-6));
  CHECK(d.taken.mean == Approx(0.3).margin(0.01));
  const Distances little = measure_distances(test::join(square(6, 0), square(1, 3)), square(6, 0));
  CHECK(little.taken.p95 == Approx(0).margin(1e-6));
  CHECK(little.taken.p99 == Approx(3).margin(1e-6));
}

TEST_CASE("distances are the same with one thread and two") {
  const Mesh a = test::sphere_mesh(4), b = test::gable_house(1, 1, 1, 1);
  limit_threads(1);
  const Distances one = measure_distances(a, b);
  limit_threads(2);
  const Distances two = measure_distances(a, b);
  limit_threads(0);
  CHECK(one.a_to_b == two.a_to_b);
  CHECK(one.rms_a_to_b == two.rms_a_to_b);
  CHECK(one.mean_b_to_a == two.mean_b_to_a);
  CHECK(measure_distances(a, b, {.seed = 2}).mean_a_to_b != one.mean_a_to_b);
}
