#include <algorithm>
#include <catch2/catch.hpp>
#include <numbers>

#include "measure/metrics.h"
#include "pipeline/pipeline.h"
#include "rounds/rounds_helpers.h"

using namespace colod;
using namespace colod::test;

namespace {

Building built(Mesh mesh) {
  Options options;
  options.ns = 40;
  Scene scene = build_scene({{as_source(std::move(mesh))}, {}}, options);
  REQUIRE(scene.buildings.size() == 1);
  REQUIRE(scene.buildings[0].failure.empty());
  return std::move(scene.buildings[0]);
}

/// The finest layer is the source, coarser ones have fewer facets, about the same volume, and the
/// sides of a dome look a few ways only.
void check_round(const Mesh& mesh) {
  const double volume = signed_volume(mesh);
  const Building b = built(mesh);
  const Layer& finest = b.layers.back();
  CHECK(finest.validity.is_watertight);
  CHECK(finest.validity.volume == Approx(volume).epsilon(0.01));
  CHECK(std::max(finest.distances.a_to_b, finest.distances.b_to_a) < 0.05);
  for (std::size_t k = 0; k + 1 < b.layers.size(); ++k) {
    INFO("layer " << k);
    CHECK(b.layers[k].validity.is_watertight);
    CHECK(b.layers[k].validity.polygons < b.layers[k + 1].validity.polygons);
    CHECK(b.layers[k].validity.volume == Approx(volume).epsilon(0.12));
  }
}

}  // namespace

TEST_CASE("domes are exact on the finest layer and regular on coarser ones") {
  check_round(dome_mesh(4, 24, 6, 3));
  check_round(dome_mesh(8, 32, 9, 5));
  check_round(dome_mesh(12, 48, 10, 6, 0.1));
}

TEST_CASE("onion spires and round towers likewise") {
  check_round(onion_mesh(3, 20, 14));
  check_round(turned_mesh({{3, 0}, {3, 9}, {3.6, 9}, {0, 15}}, 32));
}
