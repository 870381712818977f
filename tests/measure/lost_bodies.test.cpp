// What a source holds and a layer does not: bodies that vanished are found, ordinary differences
// are none.
#include "measure/lost_bodies.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "measure/solid.h"
#include "meshes.h"

using namespace colod;
using namespace colod::test;

namespace {

Mesh moved(Mesh m, const Vec3& by) {
  for (Vec3& v : m.vertices) v += by;
  return m;
}

Mesh scaled(Mesh m, double factor) {
  for (Vec3& v : m.vertices) v *= factor;
  return m;
}

/// Ground floor, roof slab and roof box, each closed, stacked: the slab stands out by `overhang`.
struct Bungalow {
  Mesh ground = box_mesh({0, 0, 0}, {14, 9, 3.2});
  Mesh slab, top = box_mesh({5, 2.5, 3.5}, {9, 6.5, 5.8});
  explicit Bungalow(double overhang)
      : slab(box_mesh({-overhang, -overhang, 3.2}, {14 + overhang, 9 + overhang, 3.5})) {}
};

/// Without the faces that look down at the lowest height.
Mesh without_floor(const Mesh& m) {
  Mesh open{m.vertices, {}};
  for (const Face& f : m.faces) {
    const Vec3 cross = face_cross(m, f);
    if (cross.z() > -0.9 * cross.norm()) open.faces.push_back(f);
  }
  return open;
}

}  // namespace

TEST_CASE("solid: what is enclosed, open below or not; a yard and a roof on posts are not") {
  for (const double size : {0.5, 1.0, 8.0}) {
    const Mesh house = scaled(gable_house(12, 9, 6, 4), size);
    CHECK(weigh_layer(house, house).solid == Approx(signed_volume(house)).epsilon(0.03));
    CHECK(weigh_layer(without_floor(house), house).solid ==
          Approx(signed_volume(house)).epsilon(0.03));
  }
  const Mesh ring = join(join(box_mesh({0, 0, 0}, {20, 5, 9}), box_mesh({0, 15, 0}, {20, 20, 9})),
                         join(box_mesh({0, 5, 0}, {5, 15, 9}), box_mesh({15, 5, 0}, {20, 15, 9})));
  CHECK(weigh_layer(ring, ring).solid == Approx(300 * 9).epsilon(0.05));
  const Mesh slab = box_mesh({0, 0, 4}, {12, 9, 4.3});
  CHECK(weigh_layer(join(slab, box_mesh({0, 0, 0}, {0.3, 0.3, 4})), slab).solid < 70);
}

TEST_CASE("a wing, a storey and one house of sixteen are missed when they are gone") {
  for (const double size : {0.7, 1.0, 5.0}) {
    const Mesh main = box_mesh({0, 0, 0}, {12, 9, 6}), wing = box_mesh({12, 2, 0}, {18, 8, 6});
    const Holdings h = weigh_layer(scaled(join(main, wing), size), scaled(main, size));
    REQUIRE(h.lost.size() == 1);
    CHECK(h.lost[0].reason == LeftOut::Reason::kLost);
    CHECK(h.lost[0].volume == Approx(216 * size * size * size).epsilon(0.15));
    CHECK(h.lost[0].farthest == Approx(6 * size).epsilon(0.1));
    CHECK(h.lost[0].share > 0.15);
  }
  Mesh row, but_one;
  for (int i = 0; i < 16; ++i) {
    const Mesh house = moved(gable_house(9, 7, 5, 3), {20.0 * (i % 4), 18.0 * (i / 4), 0});
    row = join(row, house);
    if (i != 6) but_one = join(but_one, house);
  }
  const Holdings h = weigh_layer(row, but_one);
  REQUIRE(h.lost.size() == 1);
  CHECK(h.lost[0].volume_share == Approx(1.0 / 16).epsilon(0.25));
  CHECK(weigh_layer(row, row).lost.empty());
}

TEST_CASE("of boxes that are stacked each is asked for, and none that is there") {
  for (const double overhang : {0.1, 0.3}) {
    const Bungalow b(overhang);
    const Mesh all = join(join(b.ground, b.slab), b.top);
    const Holdings h = weigh_layer(all, join(b.slab, b.top));
    REQUIRE(h.lost.size() == 1);
    CHECK(h.lost[0].volume_share > 0.7);
    CHECK(h.lost[0].farthest == Approx(3.2).epsilon(0.05));
    CHECK(weigh_layer(all, all).lost.empty());
    CHECK(weigh_layer(all, join(b.ground, b.slab)).lost.size() == 1);  // the roof box
  }
}

TEST_CASE("no body is lost where a wall moved, a passage runs, or rooms and furniture are inside") {
  const Mesh house = gable_house(12, 9, 6, 4);
  CHECK(weigh_layer(house, gable_house(11.6, 9, 6, 4)).lost.empty());
  Mesh furnished = house;
  for (int i = 0; i < 8; ++i)
    furnished = join(furnished, moved(box_mesh({0, 0, 0}, {1, 0.6, 0.8}), {1.2 * i + 0.5, 2, 0.1}));
  CHECK(weigh_layer(furnished, house).lost.empty());
  const Mesh passage =
      join(join(box_mesh({0, 0, 0}, {6, 10, 3.5}), box_mesh({9, 0, 0}, {15, 10, 3.5})),
           box_mesh({0, 0, 3.5}, {15, 10, 9}));
  CHECK(weigh_layer(passage, passage).lost.empty());
}

TEST_CASE("steps as deep as the source's grain are no bodies, deeper ones are") {
  for (const double grain : {0.5, 1.0, 4.0}) {
    const auto shed_with = [&](double deep) {
      return scaled(join(box_mesh({0, 0, 0}, {4, 3, 3}), box_mesh({4, 1, 0}, {4 + deep, 2, 3})),
                    grain);
    };
    const Mesh shed = scaled(box_mesh({0, 0, 0}, {4, 3, 3}), grain);
    const auto bodies = [](const Holdings& h) {  // surface that is missed has no volume
      return std::count_if(h.lost.begin(), h.lost.end(),
                           [](const LeftOut& l) { return l.volume >= 0; });
    };
    CHECK(bodies(weigh_layer(shed_with(0.9), shed)) == 1);
    CHECK(bodies(weigh_layer(shed_with(0.9), shed, grain)) == 0);
    CHECK(bodies(weigh_layer(shed_with(2), shed, grain)) == 1);
  }
}

TEST_CASE("of open surface what is far from the layer is missed, of the inside nothing is") {
  for (const double size : {0.8, 1.0, 6.0}) {
    Mesh roofs;  // two roofs without walls, side by side
    roofs.vertices = {{0, 0, 5},  {10, 0, 5}, {10, 8, 5}, {0, 8, 5},
                      {14, 0, 5}, {24, 0, 5}, {24, 8, 5}, {14, 8, 5}};
    roofs.faces = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
    const Holdings h =
        weigh_layer(scaled(roofs, size), scaled(box_mesh({0, 0, 0}, {10, 8, 5}), size));
    REQUIRE(h.lost.size() == 1);
    CHECK(h.lost[0].volume == -1);
    CHECK(h.lost[0].share == Approx(0.5));
    CHECK(h.lost[0].farthest == Approx(14 * size).epsilon(0.05));
    const Mesh house = box_mesh({0, 0, 0}, {12, 9, 6}), room = box_mesh({3, 3, 2}, {9, 6, 4});
    CHECK(weigh_layer(scaled(join(house, room), size), scaled(house, size)).lost.empty());
  }
}
