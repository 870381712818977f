// What was parted from a building's source is measured.
#include "scene/left_out.h"

#include <catch2/catch.hpp>

#include "meshes.h"
#include "scene/ground.h"

using namespace colod;
using namespace colod::test;

namespace {

/// A box and, `gap` metres east of it, a cube of `side`: its faces are flagged.
std::pair<Source, std::vector<char>> box_and_cube(double side, double gap) {
  const Mesh box = box_mesh({0, 0, 0}, {10, 8, 6});
  const Mesh cube = box_mesh({10 + gap, 3, 1}, {10 + gap + side, 3 + side, 1 + side});
  Source source = as_source(join(box, cube), "box");
  std::vector<char> flags(source.mesh.faces.size(), 0);
  for (std::size_t f = box.faces.size(); f < flags.size(); ++f) flags[f] = 1;
  return {source, flags};
}

}  // namespace

TEST_CASE("area, share and the farthest vertex of what was left out") {
  for (const double side : {0.5, 2.0})
    for (const double gap : {0.1, 7.0}) {
      const auto [source, flags] = box_and_cube(side, gap);
      const LeftOut out = measure_left_out(source, flags, LeftOut::Reason::kFloater, {});
      const double area = 6 * side * side, box = 2 * (10 * 8 + 10 * 6 + 8 * 6);
      CHECK(out.area == Approx(area));
      CHECK(out.share == Approx(area / (area + box)));
      CHECK(out.farthest == Approx(gap + side));
      CHECK(std::string(to_string(out.reason)) == "floater");
    }
}

TEST_CASE("shares are of the whole input, also after something else was parted") {
  const auto [source, flags] = box_and_cube(2, 1);
  const LeftOut alone = measure_left_out(source, flags, LeftOut::Reason::kFloater, {});
  const LeftOut later = measure_left_out(source, flags, LeftOut::Reason::kFloater,
                                         {{LeftOut::Reason::kGround, 900, 0.75, 20}});
  CHECK(later.share == Approx(0.25 * alone.share));
  CHECK(later.area == alone.area);
}

TEST_CASE("of a cloud the share is of its points") {
  Source source;
  source.cloud.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 1}, {5, 1, 1}};
  const LeftOut out = measure_left_out(source, {0, 0, 0, 1}, LeftOut::Reason::kFloater, {});
  CHECK(out.share == Approx(0.25));
  CHECK(out.area == 0);
  CHECK(out.farthest == Approx(4));
}

TEST_CASE("the ground that a mesh stands on is left out by name") {
  const Mesh house = gable_house(12, 9, 6, 4);
  Mesh plot;
  for (int y = 0; y <= 40; ++y)
    for (int x = 0; x <= 40; ++x) plot.vertices.emplace_back(x - 14, y - 16, 0);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) {
      const int a = 41 * y + x;
      plot.faces.push_back({a, a + 1, a + 42});
      plot.faces.push_back({a, a + 42, a + 41});
    }
  const Source parted = separate_ground(as_source(join(house, plot), "house"));
  REQUIRE(parted.left_out.size() == 1);
  CHECK(std::string(to_string(parted.left_out[0].reason)) == "ground");
  CHECK(parted.left_out[0].area == Approx(1600).epsilon(0.1));
  CHECK(parted.left_out[0].farthest > 15);
}
