#include "visibility/visibility.h"

#include <catch2/catch.hpp>
#include <map>
#include <numbers>

#include "core/error.h"
#include "core/parallel.h"
#include "visibility_helpers.h"

using namespace colod;
using namespace colod::test;

namespace {

VisibilityOptions small(int ns, int nr) { return {.ns = ns, .nr = nr}; }

bool is_same(const HitGrid& a, const HitGrid& b) {
  const auto equal = [](const Hit& h, const Hit& i) {
    return h.plane == i.plane && h.inside == i.inside && h.outside == i.outside;
  };
  return a.first == b.first && a.is_valid == b.is_valid && a.box.min == b.box.min &&
         a.box.max == b.box.max &&
         std::equal(a.hits.begin(), a.hits.end(), b.hits.begin(), b.hits.end(), equal);
}

struct Sums {
  int inside = 0, outside = 0;
};
Sums sums(const HitGrid& g, std::size_t v) {
  Sums s;
  for (const Hit& h : g.at(v)) s.inside += h.inside, s.outside += h.outside;
  return s;
}
int valid_count(const HitGrid& g) {
  return static_cast<int>(std::count(g.is_valid.begin(), g.is_valid.end(), 1));
}
std::size_t voxel_at(const HitGrid& g, const Vec3& p) {
  const Eigen::Vector3i c = (p - g.box.min).cwiseQuotient(g.voxel_size()).cast<int>();
  return static_cast<std::size_t>(c.x() + g.ns * (c.y() + g.ns * c.z()));
}

/// The first plane along the ray by brute force in double precision; −1 none, −2 too near to call.
int brute_first(const Planes& planes, const Vec3& o, const Vec3& d) {
  double best = 1e300, second = 1e300;
  int found = -1;
  for (std::size_t p = 0; p < planes.planes.size(); ++p)
    for (const Face& f : planes.planes[p].outline.triangles) {
      const auto& v = planes.planes[p].outline.vertices;
      const Vec3 n = (v[f[1]] - v[f[0]]).cross(v[f[2]] - v[f[0]]).normalized();
      if (std::abs(n.dot(d)) < 1e-9) continue;
      const double t = n.dot(v[f[0]] - o) / n.dot(d);
      double least = 1e300;
      for (int k = 0; k < 3; ++k)
        least = std::min(
            least, n.cross((v[f[(k + 1) % 3]] - v[f[k]]).normalized()).dot(o + t * d - v[f[k]]));
      if (t < 0 || least < -1e-4) continue;
      if (least < 1e-4 || std::abs(n.dot(d)) < 1e-4) return -2;
      if (t < best) {
        second = found == static_cast<int>(p) ? second : best;
        best = t, found = static_cast<int>(p);
      } else if (found != static_cast<int>(p)) {
        second = std::min(second, t);
      }
    }
  return found >= 0 && second - best < 1e-4 ? -2 : found;
}

struct Truth {
  std::map<std::uint32_t, Sums> hits;
  int inside = 0, outside = 0, unsure = 0;
};

Truth brute_voxel(const Planes& planes, const HitGrid& g, std::size_t v) {
  Truth t;
  for (int k = 0; k < g.nr; ++k) {
    const double a = 2 * std::numbers::pi * k / g.nr;
    const Vec3 d(std::cos(a), std::sin(a), 0);
    const int p = brute_first(planes, g.center(v), d);
    if (p == -2) ++t.unsure;
    if (p < 0) continue;
    const bool is_inside = planes.planes[p].normal.dot(d) > 0;
    ++(is_inside ? t.inside : t.outside);
    ++(is_inside ? t.hits[p].inside : t.hits[p].outside);
  }
  return t;
}

}  // namespace

TEST_CASE("in a closed box every voxel is valid and every ray meets an inner side") {
  const HitGrid g = cast_visibility(as_planes(box_planes({0, 0, 0}, {10, 8, 6})), small(9, 20));
  CHECK(valid_count(g) == 9 * 9 * 9);
  for (std::size_t v = 0; v < 729; ++v) {
    REQUIRE(sums(g, v).inside == 20);
    REQUIRE(g.at(v).size() == 4);
    for (int i = 0; i < 4; ++i) REQUIRE(g.at(v)[i].plane == static_cast<std::uint32_t>(i));
  }
  CHECK(g.rays == 9 * 9 * 9 * 20);
}

TEST_CASE("hits agree with brute force on random planes") {
  const Planes planes = as_planes(random_planes(90, 5));
  const HitGrid g = cast_visibility(planes, small(7, 24));
  int compared = 0, kept = 0;
  for (std::size_t v = 0; v < 343; ++v) {
    const Truth t = brute_voxel(planes, g, v);
    if (t.unsure > 0) continue;
    ++compared;
    const bool is_valid = 2 * t.inside >= 24 || (t.inside >= 0.35 * 24 && t.outside <= 0.02 * 24);
    REQUIRE(bool(g.is_valid[v]) == is_valid);
    if (!is_valid && 2 * t.outside < 24) {
      REQUIRE(g.at(v).empty());
      continue;
    }
    ++kept;
    REQUIRE(g.at(v).size() == t.hits.size());
    std::size_t i = 0;
    for (const auto& [plane, s] : t.hits) {  // a map: by rising plane
      const Hit& h = g.at(v)[i++];
      REQUIRE((h.plane == plane && h.inside == s.inside && h.outside == s.outside));
    }
  }
  CHECK(compared > 250);
  CHECK(kept > 30);
}

TEST_CASE("stopping early changes nothing but the number of rays") {
  for (bool is_party : {false, true})
    for (int nr : {1, 2, 25, 40}) {
      VisibilityOptions o{.ns = 10, .nr = nr, .is_party_wall_rule = is_party};
      const Planes planes = as_planes(random_planes(60, 9));
      const HitGrid early = cast_visibility(planes, o);
      o.early_stop = false;
      const HitGrid full = cast_visibility(planes, o);
      REQUIRE(is_same(early, full));
      REQUIRE(full.rays == 1000u * static_cast<unsigned>(nr));
      REQUIRE(early.rays <= full.rays);
      if (nr == 40) CHECK(early.rays < 0.95 * full.rays);
    }
}

TEST_CASE("one and two threads give the same bytes") {
  const Planes planes = as_planes(random_planes(200, 3));
  limit_threads(1);
  const HitGrid one = cast_visibility(planes, small(21, 32));
  limit_threads(2);
  const HitGrid two = cast_visibility(planes, small(21, 32));
  limit_threads(0);
  CHECK(is_same(one, two));
  CHECK(one.rays == two.rays);
}

TEST_CASE("missing party walls leave a terraced house valid only with the rule for them") {
  auto walls = box_planes({0, 0, 0}, {6, 8, 6});
  walls.erase(walls.begin(), walls.begin() + 2);  // −x and +x
  VisibilityOptions o = small(11, 100);
  const HitGrid robust = cast_visibility(as_planes(walls), o);
  o.is_party_wall_rule = false;
  const HitGrid paper = cast_visibility(as_planes(walls), o);
  const std::size_t middle = voxel_at(robust, {3, 4, 3});
  CHECK(sums(robust, middle).inside == Approx(100 * 4 * std::atan2(3, 4) / 6.2832).margin(2));
  CHECK(robust.is_valid[middle]);
  CHECK_FALSE(paper.is_valid[middle]);
  CHECK(paper.at(middle).empty());
  CHECK(valid_count(robust) > valid_count(paper) + 300);
}

TEST_CASE("one missing wall does no harm") {
  auto walls = box_planes({0, 0, 0}, {10, 10, 6});
  walls.erase(walls.begin());
  VisibilityOptions o{.ns = 11, .nr = 100, .is_party_wall_rule = false};
  CHECK(valid_count(cast_visibility(as_planes(walls), o)) == 11 * 11 * 11);
}

TEST_CASE(
    "wider outlines close the cracks at the corners of a room, to the letter they stay open") {
  auto walls = box_planes({0, 0, 0}, {8, 8, 6});
  for (Plane& p : walls)
    for (Vec3& v : p.outline.vertices) v = p.centroid + 0.99 * (v - p.centroid);
  Planes planes = as_planes(walls);
  planes.distance = 0.04;
  VisibilityOptions o = small(9, 200);
  const HitGrid closed = cast_visibility(planes, o);
  o.border_ratio = 0;
  const HitGrid open = cast_visibility(planes, o);
  const auto is_inner = [](const Vec3& c) {
    return (c.array() > 0.1).all() && (c.head<2>().array() < 7.9).all() && c.z() < 5.9;
  };
  int escaped = 0;
  for (std::size_t v = 0; v < 729; ++v) {
    if (!is_inner(open.center(v))) continue;
    REQUIRE(sums(closed, v).inside == 200);
    escaped += 200 - sums(open, v).inside;
  }
  CHECK(escaped > 100);
  CHECK(closed.box.min == open.box.min);
}

TEST_CASE("turned planes are seen from outside, and reversal turns them back") {
  const Planes turned = as_planes(turned_planes(box_planes({0, 0, 0}, {10, 8, 6})));
  const HitGrid alcove = cast_visibility(turned, small(8, 20));
  CHECK(valid_count(alcove) == 0);
  for (std::size_t v = 0; v < 512; ++v) REQUIRE(sums(alcove, v).outside == 20);  // kept
  const HitGrid back = cast_visibility(turned, small(8, 20), {}, {1, 1, 1, 1, 1, 1});
  CHECK(valid_count(back) == 512);
  const HitGrid one = cast_visibility(turned, small(8, 20), {}, {1, 0, 0, 0, 0, 0});
  for (std::size_t v = 0; v < 512; ++v)
    for (const Hit& h : one.at(v)) REQUIRE((h.plane == 0 ? h.outside : h.inside) == 0);
}

TEST_CASE("planes left out are not seen and do not stretch the box") {
  const Planes planes =
      as_planes(join(box_planes({0, 0, 0}, {4, 4, 4}), box_planes({1, 1, -50}, {2, 2, 50})));
  std::vector<char> is_active(12, 1);
  std::fill(is_active.begin() + 6, is_active.end(), 0);
  const HitGrid g = cast_visibility(planes, small(6, 16), is_active);
  CHECK(g.box.size().z() == Approx(4).epsilon(1e-3));
  CHECK(valid_count(g) == 216);
  for (const Hit& h : g.hits) REQUIRE(h.plane < 6);
}

TEST_CASE("levels and walls exactly at voxel centres change nothing") {
  // Without the grown box, the middle voxels of an odd grid lie exactly in these planes.
  auto list = box_planes({0, 0, 0}, {5, 5, 5});
  const HitGrid plain = cast_visibility(as_planes(list), small(5, 12));
  list.push_back(rectangle_plane({0, 0, 2.5}, {5, 0, 0}, {0, 5, 0}));
  const HitGrid level = cast_visibility(as_planes(list), small(5, 12));
  CHECK(is_same(plain, level));
  list.push_back(rectangle_plane({0, 2.5, 0}, {5, 0, 0}, {0, 0, 5}));  // normal −y
  const HitGrid wall = cast_visibility(as_planes(list), small(5, 12));
  const std::size_t middle = voxel_at(wall, {2.5, 2.4, 2.5});
  for (std::size_t v = 0; v < 125; ++v) REQUIRE(sums(wall, v).inside + sums(wall, v).outside <= 12);
  CHECK(sums(wall, middle).inside + sums(wall, middle).outside == 12);
}

TEST_CASE("no ray leaks where outlines share their edges") {
  // A prism of many thin walls, each split into many triangles by a fan.
  std::vector<Plane> list;
  const int sides = 64;
  const auto corner = [&](int i, double z) {
    const double a = 2 * std::numbers::pi * i / sides;
    return Vec3(7 * std::cos(a), 7 * std::sin(a), z);
  };
  for (int i = 0; i < sides; ++i)
    list.push_back(
        polygon_plane({corner(i, 0), corner(i + 1, 0), corner(i + 1, 1.1), corner(i + 1, 2),
                       corner(i + 1, 5), corner(i, 5), corner(i, 3.3)}));
  const HitGrid g = cast_visibility(as_planes(list), small(15, 100));
  const std::size_t middle = voxel_at(g, {0.01, 0.01, 2.5});
  CHECK(sums(g, middle).inside == 100);
  int inner = 0;
  for (std::size_t v = 0; v < g.is_valid.size(); ++v) {
    const Vec3 c = g.center(v);
    if (std::hypot(c.x(), c.y()) > 6.9) continue;
    ++inner;
    REQUIRE(sums(g, v).inside == 100);
  }
  CHECK(inner > 1500);
}

TEST_CASE("no plane, no outline, not a number: an empty grid and no crash") {
  CHECK(cast_visibility(Planes(), small(3, 4)).first == std::vector<std::uint64_t>(28, 0));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Planes planes = as_planes(box_planes({0, 0, 0}, {4, 4, 4}));
  CHECK(cast_visibility(planes, small(3, 4), std::vector<char>(6, 0)).hits.empty());
  planes.planes[1].outline.vertices[0] = {nan, nan, nan};
  planes.planes[2].outline = {};
  CHECK(cast_visibility(planes, small(3, 4)).first.size() == 28);
  const HitGrid flat =
      cast_visibility(as_planes({rectangle_plane({0, 0, 0}, {1, 0, 0}, {0, 0, 1})}), small(3, 4));
  CHECK(flat.voxel_volume() > 0);
  CHECK_THROWS_AS(cast_visibility(planes, small(0, 4)), Error);
  CHECK_THROWS_AS(cast_visibility(planes, small(3, 0)), Error);
}
