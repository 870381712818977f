#include "core/flat.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace colod;

TEST_CASE("the hull has the corners alone, counter-clockwise, however often points come") {
  std::vector<Vec2> points;
  for (int repeat = 0; repeat < 2; ++repeat)
    for (int x = 0; x <= 4; ++x)
      for (int y = 0; y <= 3; ++y) points.emplace_back(x, y);
  const std::vector<Vec2> hull = convex_hull(points);
  CHECK(hull == std::vector<Vec2>{{0, 0}, {4, 0}, {4, 3}, {0, 3}});
  CHECK(convex_hull({}).empty());
  CHECK(convex_hull({{1, 1}, {1, 1}}).size() < 3);
  CHECK(convex_hull({{0, 0}, {1, 1}, {2, 2}}).size() < 3);
}

TEST_CASE("the area of a ring tells which way it runs") {
  const std::vector<Vec2> ell{{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 3}, {0, 3}};
  CHECK(signed_area(ell) == Approx(6));
  CHECK(signed_area({ell.rbegin(), ell.rend()}) == Approx(-6));
  CHECK(signed_area({{0, 0}, {2, 2}}) == 0);
  CHECK(signed_area({}) == 0);
}

TEST_CASE("an outline covers its inside and its border, not its hole and not beyond") {
  Outline frame;  // a square of 4 m with a hole of 2 m, the hole's ring last
  frame.vertices = {{0, 0, 1}, {4, 0, 1}, {4, 4, 1}, {0, 4, 1},
                    {1, 1, 1}, {3, 1, 1}, {3, 3, 1}, {1, 3, 1}};
  for (int k = 0; k < 4; ++k) {
    const int next = (k + 1) % 4;
    frame.triangles.push_back({k, next, next + 4});
    frame.triangles.push_back({k, next + 4, k + 4});
  }
  CHECK(covers(frame, Vec3::UnitZ(), {0.5, 2, 1}));
  CHECK(covers(frame, Vec3::UnitZ(), {0, 0, 1}));
  CHECK_FALSE(covers(frame, Vec3::UnitZ(), {2, 2, 1}));
  CHECK_FALSE(covers(frame, Vec3::UnitZ(), {4.1, 2, 1}));
}

TEST_CASE("the soup of outlines tells the plane of each triangle") {
  Plane a, b;
  a.outline = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {{0, 1, 2}}};
  b.outline = {
      {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}, {{0, 1, 2, 3}}, {{0, 1, 2}, {0, 2, 3}}};
  std::vector<int> plane;
  const Mesh soup = outline_soup({a, b}, &plane);
  CHECK(plane == std::vector<int>{0, 1, 1});
  CHECK(surface_area(soup) == Approx(1.5));
}

TEST_CASE("the median of an odd number, of an even one, of none") {
  CHECK(median({3, 1, 2}) == 2);
  CHECK(median({4, 1, 2, 3}) == 2.5);
  CHECK(median({}) == 0);
}

TEST_CASE("the upper median is a value that was measured") {
  CHECK(upper_median({3, 1, 2}) == 2);
  CHECK(upper_median({4, 1, 2, 3}) == 3);
  CHECK(upper_median({}) == 0);
}

TEST_CASE("a triangle covers its inside and its border, however it is wound") {
  const std::array<Vec3, 3> left = {Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(0, 2, 0)};
  const std::array<Vec3, 3> right = {left[0], left[2], left[1]};
  for (const auto& triangle : {left, right}) {
    CHECK(covers(triangle, Vec3::UnitZ(), {0.5, 0.5, 0}));
    CHECK(covers(triangle, Vec3::UnitZ(), {1, 0, 0}));
    CHECK_FALSE(covers(triangle, Vec3::UnitZ(), {1.5, 1.5, 0}));
  }
}

TEST_CASE("corners stay where a line leaves its chords by more than the tolerance") {
  const std::vector<Vec2> line = {{0, 0}, {1, 0.05}, {2, 1}, {3, 1.05}, {4, 1}, {5, 0}};
  const auto distance = [&](int i, int from, int to) {
    const Vec2 along = line[to] - line[from];
    return std::abs(cross(along, line[i] - line[from])) / along.norm();
  };
  CHECK(corners_between(0, 5, 0.6, distance) == std::vector<int>{3});
  CHECK(corners_between(0, 5, 0.35, distance) == std::vector<int>{3, 4});
  CHECK(corners_between(0, 5, 2, distance).empty());
  CHECK(corners_between(1, 3, 0.1, distance) == std::vector<int>{2});
  CHECK(corners_between(0, 5, 0, distance) == std::vector<int>{1, 2, 3, 4});
}
