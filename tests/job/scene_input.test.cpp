// A place whose buildings are built, or are not.
#include "job/scene_input.h"

#include <catch2/catch.hpp>

#include "scenes.h"
#include "temporary_folder.h"

using namespace colod;
using namespace colod::test;

namespace {

constexpr double kSide = 40;

/// Two houses, 8 by 10 m, on level ground.
const std::vector<Box> kHouses = {Box{{4, 14, 0}, {12, 24, 6}}, Box{{26, 14, 0}, {34, 24, 9}}};

std::string ring(const Box& b) {
  std::string out = "[";
  for (const auto& [x, y] : {std::pair{b.min.x(), b.min.y()}, std::pair{b.max.x(), b.min.y()},
                             std::pair{b.max.x(), b.max.y()}, std::pair{b.min.x(), b.max.y()},
                             std::pair{b.min.x(), b.min.y()}})
    out += (out.size() > 1 ? ",[" : "[") + std::to_string(x) + "," + std::to_string(y) + "]";
  return out + "]";
}

Inputs open_houses(const TempFolder& folder, const std::string& footprints) {
  folder.write("tile.b3dm", b3dm_of(glb_of(y_up(terrain_with_boxes(kSide, 1, kHouses)))));
  folder.write("tileset.json", tileset_of(tile_of("tile.b3dm")));
  SceneChoice choice;
  choice.footprints = footprints;
  return open_inputs({folder.path.string()}, {}, choice, {}, {});
}

std::string both_plans(const TempFolder& folder) {
  std::string text = R"({"type":"FeatureCollection","features":[)";
  for (std::size_t i = 0; i < kHouses.size(); ++i)
    text += std::string(i ? "," : "") + R"({"type":"Feature","properties":{"id":"house)" +
            std::to_string(i) + R"("},"geometry":{"type":"Polygon","coordinates":[)" +
            ring(kHouses[i]) + "]}}";
  return folder.write("plan.geojson", text + "]}");
}

/// One that has a mesh, failed, or was dismissed.
Building outcome(const std::string& name, bool has_mesh, bool is_dismissed) {
  Building b;
  b.source.name = name;
  if (has_mesh) b.layers.resize(1);
  if (!has_mesh) b.failure = name + ": why";
  b.is_dismissed = is_dismissed;
  return b;
}

/// m² of the context's finest tiles that lie higher than 5 m over a house.
double roof_in_context(const Scene& scene, const Box& house) {
  double area = 0;
  for (std::size_t n = 0; n < scene.context->nodes.size(); ++n) {
    bool is_finest = true;
    for (const Context::Node& other : scene.context->nodes)
      is_finest = is_finest && other.parent != static_cast<int>(n);
    if (!is_finest) continue;
    const Source tile = scene.context->read(n);
    for (const Face& f : tile.mesh.faces) {
      const Vec3 cross = face_cross(tile.mesh, f);
      const Vec3 at = tile.mesh.vertices[static_cast<std::size_t>(f[0])];
      if (at.z() > 5 && at.x() >= house.min.x() && at.x() <= house.max.x())
        area += 0.5 * std::max(0.0, cross.z());
    }
  }
  return area;
}

}  // namespace

TEST_CASE("a building without a mesh stays in the context as the source shows it") {
  const TempFolder folder;
  const Inputs inputs = open_houses(folder, both_plans(folder));
  for (const bool is_built : {true, false}) {
    CAPTURE(is_built);
    Scene scene;
    scene.buildings = {outcome("house0", is_built, false), outcome("house1", true, false)};
    add_place(inputs, scene);
    CHECK(scene.buildings.size() == 2);
    CHECK(scene.found_footprints.empty());
    CHECK(roof_in_context(scene, kHouses[0]) == Approx(is_built ? 0 : 80).margin(1));
    CHECK(roof_in_context(scene, kHouses[1]) == Approx(0).margin(1));
  }
}

TEST_CASE("what was dismissed goes from the buildings and the footprints, with a warning") {
  const TempFolder folder;
  const Inputs inputs = open_houses(folder, "");
  REQUIRE(inputs.inventory.building_count() == 2);
  Scene scene;
  for (const InputFile& file : inputs.inventory.files)
    scene.buildings.push_back(outcome(file.names[0], scene.buildings.empty(), false));
  scene.buildings.back().is_dismissed = true;
  const std::string gone = scene.buildings.back().source.name;
  add_place(inputs, scene);
  REQUIRE(scene.buildings.size() == 1);
  CHECK(scene.warnings == std::vector<std::string>{gone + ": why"});
  CHECK(scene.found_footprints.find("\"" + scene.buildings[0].source.name + "\"") !=
        std::string::npos);
  CHECK(scene.found_footprints.find("\"" + gone + "\"") == std::string::npos);
  CHECK(roof_in_context(scene, kHouses[0]) + roof_in_context(scene, kHouses[1]) ==
        Approx(80).margin(10));
  scene.buildings[0].is_dismissed = true;
  CHECK_THROWS_WITH(add_place(inputs, scene), Catch::Contains("no building was found on it"));
}
