// Which triangle a texel belongs to, beside asking every triangle for every texel.
#include "bake/owners.h"

#include <catch2/catch.hpp>
#include <random>

#include "core/flat.h"

using namespace colod;
using namespace colod::bake;

namespace {

/// The first that holds the middle, else the nearest within the border.
Owner asked_of_all(const Vec2& middle, const std::vector<Corners>& triangles) {
  Owner own;
  for (std::size_t t = 0; t < triangles.size(); ++t)
    if (triangles[t].holds(middle)) return {static_cast<int>(t), 0};
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const double d = (triangles[t].nearest(middle) - middle).norm();
    if (d < own.distance) own = {static_cast<int>(t), d};
  }
  return own;
}

std::vector<Corners> random_triangles(unsigned seed, bool is_on_lattice) {
  std::mt19937 random(seed);
  const auto coordinate = [&] {
    const double v = std::uniform_real_distribution<double>(-10, 50)(random);
    return is_on_lattice ? std::round(v) + 0.5 : v;  // sides then go through middles of texels
  };
  std::vector<Corners> out;
  while (out.size() < 6) {
    Corners c;
    for (Vec2& at : c.at) at = Vec2(coordinate(), coordinate());
    if (cross(c.at[1] - c.at[0], c.at[2] - c.at[0]) > 0) out.push_back(c);
  }
  return out;
}

}  // namespace

TEST_CASE("a texel belongs to the first triangle that holds it, else to the nearest") {
  const unsigned seed = GENERATE(range(0u, 40u));
  const std::vector<Corners> triangles = random_triangles(seed, seed % 2 == 0);
  const Window w{3, 5, 40, 32};
  const std::vector<Owner> found = owners(w, triangles);
  for (int y = 0; y < w.height; ++y)
    for (int x = 0; x < w.width; ++x) {
      CAPTURE(seed, x, y);
      const Owner& own = found[static_cast<std::size_t>(y) * w.width + x];
      const Owner expected = asked_of_all({w.x + x + 0.5, w.y + y + 0.5}, triangles);
      REQUIRE(own.triangle == expected.triangle);
      REQUIRE(own.distance == expected.distance);
    }
}
