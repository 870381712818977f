// Based on: MSFT_lod (with MSFT_screencoverage), EXT_structural_metadata; the layout that
// Babylon.js loads progressively and UnityGLTF turns into a LODGroup.
// Differs: coverage comes from measured switches, as Simplygon's deviation against screen size.
// Notation: c coverage, g gsd, D bounding sphere's diameter, H viewport_height.
#include "glb.h"

#include <algorithm>

#include "core/error.h"
#include "metadata.h"

namespace colod {

using OrderedJson = nlohmann::ordered_json;

namespace {

struct Level {
  const ExportLevel* level;
  QuantizationGrid grid;
  int mesh = 0;
  double deviation = 0;  // with the rounding's
  std::size_t faces = 0;
};

/// One value a level, finest first: the share of the screen's height below which the next coarser
/// level may stand. Strictly falling, the last 0, so that nothing is ever culled.
std::vector<double> screen_coverage(const std::vector<Level>& levels, double diameter,
                                    double viewport_height) {
  std::vector<double> coverage;
  for (std::size_t lod = 1; lod < levels.size(); ++lod) {
    double c = std::min(1.0, diameter / (levels[lod].level->gsd * viewport_height));
    if (lod > 1) c = std::min(c, 0.999 * coverage.back());
    coverage.push_back(c);
  }
  coverage.push_back(0);
  return coverage;
}

/// The levels, finest first, with grids that nest in one another.
std::vector<Level> plan_levels(const ExportBuilding& building, const GlbOptions& options) {
  Box box;
  for (const ExportLevel& level : building.levels)
    for (const Vec3& p : level.mesh.vertices) box.extend(to_gltf(p));
  std::vector<Level> levels;
  for (auto it = building.levels.rbegin(); it != building.levels.rend(); ++it) {
    if (it->mesh.triangles.empty())
      throw Error(Stage::kOutput, building.name,
                  "layer " + std::to_string(it->layers.back()) + " has no triangles");
    const double bound = options.quantization * (levels.empty() ? kFinestShare : 1.0);
    Level level{&*it, fit_closed_grid(it->mesh, Vec3::Zero(), box, bound)};
    level.deviation = it->deviation + level.grid.error();
    levels.push_back(level);
  }
  return levels;
}

OrderedJson node_of(const ExportBuilding& building, const Level& level, std::size_t lod) {
  OrderedJson node;
  node["name"] = shown_name(building) + "_LOD" + std::to_string(lod);
  node["mesh"] = level.mesh;
  node["extras"] = {{"building", building.name},
                    {"given_name", shown_name(building)},
                    {"layer", level.level->layers.back()},
                    {"layers", level.level->layers},
                    {"gsd", level.level->gsd},
                    {"deviation", level.deviation},
                    {"faces", level.faces}};
  return node;
}

}  // namespace

BuildingGlb encode_building_glb(const ExportBuilding& building, const GlbOptions& options) {
  if (building.levels.empty()) throw Error(Stage::kOutput, building.name, "no layer to write");
  std::vector<Level> levels = plan_levels(building, options);
  GltfDocument document = start_gltf();
  const Vec3& o = building.origin;
  document.json["asset"]["extras"] = {{"origin", {o.x(), o.y(), o.z()}},
                                      {"originAxes", "z up, metres"},
                                      {"source", building.source},
                                      {"switching", switching_json(options.switching)}};
  std::vector<std::size_t> bytes;
  for (std::size_t lod = levels.size(); lod-- > 0;) {  // coarsest first in the binary chunk
    Level& level = levels[lod];
    const LevelLook& look = level.level->look;
    const FlatMesh flat =
        flatten(level.level->mesh, Vec3::Zero(), level.grid, static_cast<int>(lod), look);
    level.faces = flat.triangles.size();
    OrderedJson mesh;
    mesh["name"] = shown_name(building) + "_LOD" + std::to_string(lod);
    const std::size_t before = document.binary.size();
    OrderedJson primitive = add_primitive(document, flat, level.grid, options.compression);
    bytes.push_back(document.binary.size() - before);
    primitive["extensions"]["EXT_mesh_features"] = feature_ids(levels.size());
    set_look(document, look, mesh["name"], primitive);
    mesh["primitives"] = OrderedJson::array({primitive});
    level.mesh = static_cast<int>(document.json["meshes"].size());
    document.json["meshes"].push_back(mesh);
  }
  std::vector<Feature> features;  // a row a level, by its LOD number
  for (std::size_t lod = 0; lod < levels.size(); ++lod) {
    document.json["nodes"].push_back(node_of(building, levels[lod], lod));
    features.push_back(
        feature_of(building, *levels[lod].level, levels[lod].deviation, levels[lod].faces));
  }
  add_features(document, features);
  OrderedJson& root = document.json["nodes"][0];
  const double diameter = bounding_box(levels[0].level->mesh.vertices).diagonal();
  root["extras"]["MSFT_screencoverage"] =
      screen_coverage(levels, diameter, options.switching.viewport_height);
  if (levels.size() > 1) {
    OrderedJson ids = OrderedJson::array();
    for (std::size_t lod = 1; lod < levels.size(); ++lod) ids.push_back(lod);
    root["extensions"]["MSFT_lod"]["ids"] = ids;
    document.json["extensionsUsed"].push_back("MSFT_lod");
  }
  return {{"buildings/" + building.name + ".glb", finish_glb(std::move(document))}, bytes};
}

}  // namespace colod
