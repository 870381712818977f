#include "measure/silhouettes.h"

#include <catch2/catch.hpp>

#include "core/error.h"
#include "meshes.h"

using namespace colod;
using test::box_mesh;

TEST_CASE("silhouettes of one mesh cover each other, in any place") {
  const Mesh house = test::gable_house(10, 7, 5, 3);
  const SilhouetteOverlap own = overlap_silhouettes(house, house);
  CHECK(own.mean == 1);
  CHECK(own.worst == 1);
}

TEST_CASE("what lies apart or sticks out is told") {
  const Mesh box = box_mesh({0, 0, 0}, {10, 8, 6});
  CHECK(overlap_silhouettes(box, box_mesh({100, 0, 0}, {110, 8, 6})).mean < 0.1);
  // Seen from above, a wing of half the box's plan is a third of both.
  const Mesh wing = test::join(box, box_mesh({10, 0, 0}, {15, 8, 6}));
  const SilhouetteOverlap overlap = overlap_silhouettes(box, wing);
  CHECK(overlap.worst == Approx(2.0 / 3).margin(0.02));
  CHECK(overlap.worst < overlap.mean);
  CHECK(overlap_silhouettes(wing, box).worst == Approx(overlap.worst));
  // A chimney hardly covers anything.
  const Mesh chimney = test::join(box, box_mesh({4, 4, 6}, {4.6, 4.6, 7.5}));
  CHECK(overlap_silhouettes(box, chimney).worst > 0.97);
}

TEST_CASE("a mesh without a face has no silhouette") {
  CHECK_THROWS_AS(overlap_silhouettes(box_mesh({0, 0, 0}, {1, 1, 1}), Mesh{}), Error);
}
