#include "core/rays.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "core/meshopt.h"
#include "meshes.h"

using namespace colod;

namespace {

struct Rng {
  std::mt19937_64 engine;
  explicit Rng(std::uint64_t seed) : engine(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine() >> 11) * 0x1p-53;
  }
  Vec3 point(double r) { return {uniform(-r, r), uniform(-r, r), uniform(-r, r)}; }
  Vec3 direction() { return point(1).normalized(); }
};

Mesh random_soup(Rng& rng, int n, double size) {
  Mesh m;
  for (int i = 0; i < n; ++i) {
    const Vec3 c = rng.point(10);
    for (int k = 0; k < 3; ++k) m.vertices.push_back(c + rng.point(size));
    m.faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return m;
}

/// Distance to triangle f, or −1. `doubt` is set where the ray passes within 1e-5 of an edge.
double brute_hit(const Mesh& m, const Face& f, const Vec3& o, const Vec3& d, bool& doubt) {
  const Vec3 a = m.vertices[f[0]], n = face_cross(m, f);
  const double slope = n.dot(d);
  if (slope == 0) return -1;
  const double t = n.dot(a - o) / slope;
  double least = 1e300;
  for (int k = 0; k < 3; ++k) {
    const Vec3 p = m.vertices[f[k]], e = m.vertices[f[(k + 1) % 3]] - p;
    least = std::min(least, n.normalized().cross(e).normalized().dot(o + t * d - p));
  }
  const double tolerance = 1e-4;
  if (std::abs(least) < tolerance || std::abs(slope) < 1e-3 * n.norm() || std::abs(t) < 1e-4)
    doubt = true;
  return least > 0 && t > 0 ? t : -1;
}

struct BruteHits {
  std::vector<std::pair<double, int>> hits;
  bool doubt = false;
};

BruteHits brute_hits(const Mesh& m, const Vec3& o, const Vec3& d) {
  BruteHits b;
  for (std::size_t i = 0; i < m.faces.size(); ++i) {
    const double t = brute_hit(m, m.faces[i], o, d, b.doubt);
    if (t > 0) b.hits.emplace_back(t, static_cast<int>(i));
  }
  std::sort(b.hits.begin(), b.hits.end());
  return b;
}

/// Nearest point of a segment, a triangle's inside by projection: another way than the room's.
double brute_distance(const Mesh& m, const Face& f, const Vec3& p) {
  const Vec3 n = face_cross(m, f).normalized();
  const double height = n.dot(p - m.vertices[f[0]]);
  const Vec3 foot = p - height * n;
  bool inside = true;
  double best = 1e300;
  for (int k = 0; k < 3; ++k) {
    const Vec3 a = m.vertices[f[k]], e = m.vertices[f[(k + 1) % 3]] - a;
    inside = inside && n.cross(e).dot(foot - a) >= 0;
    const double s = std::clamp(e.dot(p - a) / e.squaredNorm(), 0.0, 1.0);
    best = std::min(best, (a + s * e - p).norm());
  }
  return inside ? std::abs(height) : best;
}

Mesh moved(Mesh m, const Vec3& by) {
  for (Vec3& v : m.vertices) v += by;
  return m;
}

}  // namespace

TEST_CASE("first and all hits agree with brute force on random soups") {
  for (const Vec3& offset : {Vec3(0, 0, 0), Vec3(1e6, -5e6, 400)}) {
    Rng rng(7);
    const Mesh soup = random_soup(rng, 300, 4);
    const RayScene scene(moved(soup, offset));
    int compared = 0;
    for (int i = 0; i < 4000; ++i) {
      const Vec3 o = rng.point(15), d = rng.direction();
      const BruteHits truth = brute_hits(soup, o, d);
      if (truth.doubt) continue;
      ++compared;
      const RayHit first = scene.first_hit(o + offset, d);
      const auto all = scene.all_hits(o + offset, d);
      REQUIRE(bool(first) == !truth.hits.empty());
      if (!first) continue;
      REQUIRE(first.distance == Approx(truth.hits[0].first).margin(1e-4));
      const bool is_behind = face_cross(soup, soup.faces[first.triangle]).dot(d) > 0;
      REQUIRE(first.is_inside == is_behind);
      REQUIRE(all.size() <= truth.hits.size());
      REQUIRE(all.size() + 1 >= truth.hits.size());  // two random sheets closer than the tolerance
      REQUIRE(all[0].triangle == first.triangle);
    }
    CHECK(compared > 1500);
  }
}

TEST_CASE("occlusion is a first hit within the range") {
  Rng rng(11);
  const RayScene scene(random_soup(rng, 200, 5));
  for (int i = 0; i < 3000; ++i) {
    const Vec3 o = rng.point(12), d = rng.direction();
    const double t0 = rng.uniform(0, 5), t1 = t0 + rng.uniform(0, 10);
    REQUIRE(scene.is_occluded(o, d, t0, t1) == bool(scene.first_hit(o, d, t0, t1)));
  }
}

TEST_CASE("a part that lies about the whole soup's box answers with the whole's bits") {
  Rng rng(13);
  const Mesh near = random_soup(rng, 200, 3), far = moved(random_soup(rng, 100, 3), {900, 0, 0});
  Mesh whole = near;
  for (const Face& f : far.faces)
    for (const int v : f) whole.vertices.push_back(far.vertices[v]);
  for (int v = static_cast<int>(near.vertices.size()); v < static_cast<int>(whole.vertices.size());
       v += 3)
    whole.faces.push_back({v, v + 1, v + 2});
  const RayScene all(whole), part(near, bounding_box(whole.vertices)), alone(near);
  int hits = 0, others = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 o = rng.point(10), d = rng.direction();
    const RayHit hit = part.first_hit(o, d, 0, 50);
    REQUIRE(hit.triangle == all.first_hit(o, d, 0, 50).triangle);
    REQUIRE(hit.distance == all.first_hit(o, d, 0, 50).distance);
    REQUIRE(part.is_occluded(o, d, 0, 50) == all.is_occluded(o, d, 0, 50));
    hits += bool(hit), others += hit.distance != alone.first_hit(o, d, 0, 50).distance;
  }
  CHECK(hits > 200);
  CHECK(others > 100);  // a box of its own does round otherwise
}

TEST_CASE("nearest agrees with brute force to double precision") {
  Rng rng(13);
  const Mesh soup = random_soup(rng, 300, 2);
  const RayScene scene(soup);
  for (int i = 0; i < 1500; ++i) {
    const Vec3 p = rng.point(i % 3 ? 15 : 300);
    double best = 1e300;
    for (const Face& f : soup.faces) best = std::min(best, brute_distance(soup, f, p));
    const NearestPoint near = scene.nearest(p);
    REQUIRE(near.distance == Approx(best).epsilon(1e-10));
    REQUIRE((near.point - p).norm() == Approx(best).epsilon(1e-10));
    REQUIRE(scene.nearest(p, near.distance).triangle == near.triangle);
    REQUIRE(brute_distance(soup, soup.faces[near.triangle], p) == Approx(best).epsilon(1e-10));
  }
}

TEST_CASE("nearest in turn answers as nearest, whatever was asked before") {
  Rng rng(17);
  Mesh soup = random_soup(rng, 300, 2);
  const std::vector<Face> once = soup.faces;
  soup.faces.insert(soup.faces.end(), once.begin(), once.end());  // as near as the first ones
  const RayScene scene(soup);
  NearestInTurn in_turn(scene);
  Vec3 p = rng.point(15);
  for (int i = 0; i < 3000; ++i) {
    p = i % 10 ? Vec3(p + 0.02 * rng.direction()) : rng.point(i % 3 ? 15 : 300);
    if (i % 500 == 0) CHECK(in_turn({std::nan(""), 0, 0}).triangle == -1);
    const NearestPoint near = in_turn(p), alone = scene.nearest(p);
    REQUIRE(near.triangle == alone.triangle);
    REQUIRE(near.distance == alone.distance);
    REQUIRE(near.point == alone.point);
    CHECK(in_turn(p, 1.001 * alone.distance).point == alone.point);
    CHECK(in_turn(p, 0.999 * alone.distance).triangle ==
          (alone.distance > 0 ? -1 : alone.triangle));
  }
  const RayScene empty{Mesh()};
  CHECK(NearestInTurn(empty)({0, 0, 0}).triangle == -1);
}

TEST_CASE("an order in space names all points once, and walks far less than the given one") {
  Rng rng(19);
  std::vector<Vec3> points;
  for (int i = 0; i < 2000; ++i) points.push_back(Vec3(4e6, 5e6, 0) + rng.point(100));
  const std::vector<std::uint32_t> order = order_in_space(points);
  std::vector<char> is_named(points.size(), 0);
  for (const std::uint32_t i : order) is_named.at(i) = 1;
  REQUIRE(order.size() == points.size());
  CHECK(std::count(is_named.begin(), is_named.end(), 1) == 2000);
  double given = 0, walked = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    given += (points[i] - points[i - 1]).norm();
    walked += (points[order[i]] - points[order[i - 1]]).norm();
  }
  CHECK(walked < 0.25 * given);
  CHECK(order_in_space({}).empty());
}

TEST_CASE("nearest keeps its digits a thousand kilometres from the origin") {
  const Vec3 offset(1e6, 2e6, 100);
  const RayScene scene(test::box_mesh(offset, offset + Vec3(10, 10, 10)));
  const NearestPoint near = scene.nearest(offset + Vec3(3, 4, 10.001));
  CHECK(near.distance == Approx(0.001).epsilon(1e-5));
  CHECK((near.point - offset - Vec3(3, 4, 10)).norm() < 1e-8);
}

TEST_CASE("a ray from inside a closed box meets a back side, one from outside a front") {
  const RayScene scene(test::box_mesh({0, 0, 0}, {2, 2, 2}));
  for (const Vec3& d : sphere_directions(200)) {
    const RayHit out = scene.first_hit({1, 1, 1}, d),
                 in = scene.first_hit(Vec3(1, 1, 1) - 9 * d, d);
    REQUIRE(out.is_inside);
    REQUIRE_FALSE(in.is_inside);
    REQUIRE(out.distance + in.distance + 1e-4 >= 2);
  }
}

TEST_CASE("hits on shared edges and corners count once, and no ray slips through them") {
  const RayScene scene(test::box_mesh({-1, -1, -1}, {1, 1, 1}));
  for (const Vec3& target : {Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(1, 1, 1), Vec3(0, 0, -1)}) {
    const auto hits = scene.all_hits({0, 0, 0}, target);
    REQUIRE(hits.size() == 1);  // the diagonal of a side, an edge and a corner of the cube
    CHECK(hits[0].distance == Approx(target.norm()).epsilon(1e-5));
  }
  const auto through = scene.all_hits({-5, 0, 0}, {1, 0, 0});
  REQUIRE(through.size() == 2);
  CHECK_FALSE(through[0].is_inside);
  CHECK(through[1].is_inside);
  CHECK(scene.all_hits({-5, 0, 0}, {1, 0, 0}, 1).size() == 1);
}

TEST_CASE("a far origin costs no digits") {
  const RayScene scene(test::box_mesh({0, 0, 0}, {1, 1, 1}));
  const RayHit hit = scene.first_hit({0.999999, 0.5, 1e7}, {0, 0, -1});
  REQUIRE(hit);
  CHECK(hit.distance == Approx(1e7 - 1).epsilon(1e-12));
  CHECK_FALSE(scene.first_hit({1.00001, 0.5, 1e7}, {0, 0, -1}));
  CHECK_FALSE(scene.first_hit({0.5, 0.5, 1e7}, {0, 0, -1}, 0, 1e6));
  CHECK_FALSE(scene.first_hit({0.5, 0.5, 1e7}, {0, 0, 1}));
}

TEST_CASE("empty, degenerate and non-finite triangles give no hits and no crash") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(RayScene(Mesh()).first_hit({0, 0, 0}, {1, 0, 0}));
  CHECK(RayScene(Mesh()).nearest({0, 0, 0}).triangle == -1);
  const RayScene lines({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {nan, 0, 0}},
                       {{0, 0, 0}, {0, 1, 2}, {0, 1, 3}});
  CHECK(lines.all_hits({0.5, 0, 1}, {0, 0, -1}).empty());
  CHECK(lines.nearest({0, 0, 1}).triangle == -1);

  Mesh mixed = test::box_mesh({0, 0, 0}, {1, 1, 1});
  mixed.faces.insert(mixed.faces.begin(), {0, 0, 1});
  const RayScene scene(mixed);
  CHECK(scene.first_hit({0.3, 0.4, 5}, {0, 0, -1}).triangle == 3);  // the caller's number
  CHECK_FALSE(scene.first_hit({0.3, 0.4, 5}, {0, 0, 0}));
  CHECK_FALSE(scene.first_hit({nan, 0.4, 5}, {0, 0, -1}));
  CHECK(scene.nearest({nan, 0, 0}).triangle == -1);
}

TEST_CASE("of two equal triangles the first answers") {
  Mesh twice = test::box_mesh({0, 0, 0}, {1, 1, 1});
  twice.faces.insert(twice.faces.end(), twice.faces.begin(), twice.faces.end());
  const RayScene scene(twice);
  for (const Vec3& d : sphere_directions(100)) {
    REQUIRE(scene.first_hit({0.4, 0.45, 0.6}, d).triangle < 12);
    REQUIRE(scene.all_hits({0.4, 0.45, 0.6}, d).size() == 1);
  }
  REQUIRE(scene.nearest({0.4, 0.45, 2}).triangle < 12);
}

TEST_CASE("sphere directions are unit, balanced and not bunched") {
  const auto directions = sphere_directions(500);
  Vec3 sum = Vec3::Zero();
  double closest = -1;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    CHECK(directions[i].norm() == Approx(1));
    sum += directions[i];
    for (std::size_t j = 0; j < i; ++j)
      closest = std::max(closest, directions[i].dot(directions[j]));
  }
  CHECK(sum.norm() < 1);
  CHECK(std::acos(closest) > 0.5 * std::sqrt(4 * M_PI / 500));
}

TEST_CASE("ring directions share n out over the elevations") {
  const double elevations[] = {0, 20, 40};
  const auto directions = ring_directions(50, elevations);
  REQUIRE(directions.size() == 50);
  for (int i = 0; i < 50; ++i) {
    const double expected = i < 17 ? 0 : i < 34 ? 20 : 40;
    CHECK(directions[i].norm() == Approx(1));
    CHECK(std::asin(directions[i].z()) * 180 / M_PI == Approx(expected).margin(1e-9));
  }
  CHECK(ring_directions(5, {}).empty());
}
