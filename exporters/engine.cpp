// Based on: what Unity, Unreal and Godot importers read: names ending in _LOD<n>, a pivot on the
// ground, one material.
// Differs: distances and screen sizes come from measured errors.
// Notation: p pixel_error, H viewport_height, D bounding sphere's diameter, eps a level's error.
#include "engine.h"

#include <algorithm>
#include <numbers>

#include "../src/error.h"
#include "gltf.h"

namespace colod {

using Json = nlohmann::ordered_json;

namespace {

constexpr double kFinestShare = 0.3;  // of the bound
constexpr double kFall = 0.999;       // from one level's screen size to the next

/// Layers, finest first.
std::vector<const ExportLayer*> levels_of(const ExportBuilding& building) {
  std::vector<const ExportLayer*> out;
  for (auto it = building.layers.rbegin(); it != building.layers.rend(); ++it) {
    if (it->mesh.triangles.empty())
      throw Error(Stage::kOutput, building.name,
                  "layer " + std::to_string(it->layer) + " has no triangles");
    out.push_back(&*it);
  }
  if (out.empty()) throw Error(Stage::kOutput, building.name, "no layer to write");
  return out;
}

/// Middle of the footprint on the ground, building-local; the same for all levels.
Vec3 pivot_of(const ExportBuilding& building) {
  Box box;
  for (const ExportLayer& layer : building.layers)
    for (const Vec3& p : layer.mesh.vertices) box.extend(p);
  return {box.center().x(), box.center().y(), box.min.z()};
}

std::string level_name(const ExportBuilding& building, std::size_t lod) {
  return building.name + "_LOD" + std::to_string(lod);
}

QuantizationGrid level_grid(const ExportLayer& layer, const Vec3& pivot, bool is_finest,
                            const EngineOptions& options) {
  Box box;
  for (const Vec3& p : layer.mesh.vertices) box.extend(to_gltf(p - pivot));
  return fit_closed_grid(layer.mesh, -pivot, box,
                         options.quantization * (is_finest ? kFinestShare : 1.0));
}

Json level_json(const ExportBuilding& building, std::size_t lod, const ExportLayer& layer,
                double error, double diameter, const EngineOptions& options) {
  const double height = 2 * std::tan(options.fov_y_deg * std::numbers::pi / 360);
  Json level;
  level["lod"] = lod;
  level["layer"] = layer.layer;
  level["file"] = level_name(building, lod) + ".glb";
  level["triangles"] = layer.mesh.triangles.size();
  level["error"] = error;
  level["switch_distance"] =
      lod == 0 ? 0 : error * options.viewport_height / (options.pixel_error * height);
  level["screen_size"] =
      lod == 0 ? 1
               : std::min(1.0, options.pixel_error * diameter / (error * options.viewport_height));
  return level;
}

}  // namespace

std::vector<Encoded> encode_engine_levels(const ExportBuilding& building,
                                          const EngineOptions& options) {
  const std::vector<const ExportLayer*> levels = levels_of(building);
  const Vec3 pivot = pivot_of(building), world = building.origin + pivot;
  std::vector<Encoded> files;
  for (std::size_t lod = 0; lod < levels.size(); ++lod) {
    const QuantizationGrid grid = level_grid(*levels[lod], pivot, lod == 0, options);
    FlatMesh flat = flatten(levels[lod]->mesh, -pivot, grid);
    flat.feature_ids.clear();  // one building a file
    GltfDocument document = start_gltf();
    document.json["asset"]["extras"] = {{"pivot", {world.x(), world.y(), world.z()}},
                                        {"pivotAxes", "z up, metres"}};
    document.json["materials"][0]["name"] = building.name;
    const std::string name = level_name(building, lod);
    const Json primitive = add_primitive(document, flat, grid, Compression::kNone);
    document.json["meshes"].push_back({{"name", name}, {"primitives", Json::array({primitive})}});
    document.json["nodes"].push_back(
        {{"name", name},
         {"mesh", 0},
         {"extras", {{"building", building.name}, {"layer", levels[lod]->layer}}}});
    files.push_back({"engine/" + name + ".glb", finish_glb(std::move(document))});
  }
  return files;
}

Encoded encode_lods_json(const std::vector<ExportBuilding>& buildings,
                         const EngineOptions& options) {
  Json list = Json::array();
  for (const ExportBuilding& building : buildings) {
    const std::vector<const ExportLayer*> levels = levels_of(building);
    const Vec3 pivot = pivot_of(building), world = building.origin + pivot;
    const double diameter = bounding_box(levels[0]->mesh.vertices).diagonal();
    Json entry = {{"name", building.name},
                  {"source", building.source},
                  {"pivot", {world.x(), world.y(), world.z()}},
                  {"bounding_sphere_diameter", diameter},
                  {"levels", Json::array()}};
    for (std::size_t lod = 0; lod < levels.size(); ++lod) {
      const double error =
          levels[lod]->geometric_error + level_grid(*levels[lod], pivot, lod == 0, options).error();
      Json level = level_json(building, lod, *levels[lod], error, diameter, options);
      if (lod > 0) {  // strictly apart, so that importers keep every level
        const Json& finer = entry["levels"].back();
        level["screen_size"] = std::min(level["screen_size"].get<double>(),
                                        kFall * finer["screen_size"].get<double>());
        level["switch_distance"] = std::max(level["switch_distance"].get<double>(),
                                            finer["switch_distance"].get<double>() / kFall + 1e-3);
      }
      entry["levels"].push_back(level);
    }
    list.push_back(entry);
  }
  Json json;
  json["about"] =
      "LOD0 is the finest. A level is shown from switch_distance (metres) on, or where the "
      "bounding "
      "sphere's diameter is at most screen_size of the viewport's height: its error is then at "
      "most "
      "pixel_error pixels. Files are y up with the pivot on the ground; pivot is its place in the "
      "input's coordinates, z up, metres.";
  json["pixel_error"] = options.pixel_error;
  json["viewport_height"] = options.viewport_height;
  json["fov_y_deg"] = options.fov_y_deg;
  json["buildings"] = list;
  return {"engine/lods.json", json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n"};
}

}  // namespace colod
