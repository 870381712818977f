// Based on: what Unity, Unreal and Godot importers read: names ending in _LOD<n>, a pivot on the
// ground, one material.
// Differs: distances and screen sizes come from measured switches.
// Notation: H viewport_height, D bounding sphere's diameter, g a level's gsd.
#include "engine.h"

#include <algorithm>
#include <numbers>

#include "core/error.h"
#include "gltf.h"
#include "metadata.h"

namespace colod {

using OrderedJson = nlohmann::ordered_json;

namespace {

constexpr double kFall = 0.999;  // from one level's screen size to the next

/// Finest first.
std::vector<const ExportLevel*> levels_of(const ExportBuilding& building) {
  std::vector<const ExportLevel*> out;
  for (auto it = building.levels.rbegin(); it != building.levels.rend(); ++it) {
    if (it->mesh.triangles.empty())
      throw Error(Stage::kOutput, building.name,
                  "layer " + std::to_string(it->layers.back()) + " has no triangles");
    out.push_back(&*it);
  }
  if (out.empty()) throw Error(Stage::kOutput, building.name, "no layer to write");
  return out;
}

/// Middle of the footprint on the ground, building-local; the same for all levels.
Vec3 pivot_of(const ExportBuilding& building) {
  Box box;
  for (const ExportLevel& level : building.levels)
    for (const Vec3& p : level.mesh.vertices) box.extend(p);
  return {box.center().x(), box.center().y(), box.min.z()};
}

std::string level_name(const ExportBuilding& building, std::size_t lod) {
  return building.name + "_LOD" + std::to_string(lod);
}

QuantizationGrid level_grid(const ExportLevel& level, const Vec3& pivot, bool is_finest,
                            const EngineOptions& options) {
  Box box;
  for (const Vec3& p : level.mesh.vertices) box.extend(to_gltf(p - pivot));
  return fit_closed_grid(level.mesh, -pivot, box,
                         options.quantization * (is_finest ? kFinestShare : 1.0));
}

OrderedJson level_json(const ExportBuilding& building, std::size_t lod, const ExportLevel& level,
                       double rounding, double diameter, const SwitchFacts& switching) {
  const double view = 2 * std::tan(switching.fov_y_deg * std::numbers::pi / 360);
  OrderedJson json;
  json["lod"] = lod;
  json["layer"] = level.layers.back();
  json["layers"] = level.layers;
  json["file"] = level_name(building, lod) + ".glb";
  json["triangles"] = level.mesh.triangles.size();
  json["gsd"] = level.gsd;
  json["deviation"] = level.deviation + rounding;
  json["switch_distance"] = level.gsd * switching.viewport_height / view;
  json["screen_size"] =
      lod == 0 ? 1 : std::min(1.0, diameter / (level.gsd * switching.viewport_height));
  return json;
}

int power_of_two(int n) { return n <= 4 ? 4 : 2 * power_of_two((n + 1) / 2); }

/// Its pixels in the upper left corner, its last ones beyond.
Raster extended(const Raster& image, int width, int height) {
  Raster out(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      std::copy_n(image.at(std::min(x, image.width - 1), std::min(y, image.height - 1)), 3,
                  out.at(x, y));
  return out;
}

/// The level's look with an image whose sides are powers of two, as engines want them for their mip
/// chains and texture compression.
LevelLook squared(const LevelLook& look) {
  if (!look.has_texture()) return look;
  const int width = power_of_two(look.width), height = power_of_two(look.height);
  LevelLook out = look;
  out.width = width, out.height = height;
  const Vec2f scale(static_cast<float>(look.width) / static_cast<float>(width),
                    static_cast<float>(look.height) / static_cast<float>(height));
  for (auto& corners : out.uvs)
    for (Vec2f& uv : corners) uv = uv.cwiseProduct(scale);
  out.encode(extended(look.raster, width, height));
  if (!look.normals.empty())
    out.normals = encode_image(extended(look.normal_raster, width, height), ImageFormat::kPng, 0);
  return out;
}

}  // namespace

std::vector<Encoded> encode_engine_levels(const ExportBuilding& building,
                                          const EngineOptions& options) {
  const auto levels = levels_of(building);
  const Vec3 pivot = pivot_of(building), world = building.origin + pivot;
  std::vector<Encoded> files;
  for (std::size_t lod = 0; lod < levels.size(); ++lod) {
    const QuantizationGrid grid = level_grid(*levels[lod], pivot, lod == 0, options);
    const LevelLook look = squared(levels[lod]->look);
    FlatMesh flat = flatten(levels[lod]->mesh, -pivot, grid, 0, look);
    flat.feature_ids.clear();  // one building a file
    GltfDocument document = start_gltf();
    document.json["asset"]["extras"] = {{"pivot", {world.x(), world.y(), world.z()}},
                                        {"pivotAxes", "z up, metres"}};
    const std::string name = level_name(building, lod);
    OrderedJson primitive = add_primitive(document, flat, grid, Compression::kNone);
    set_look(document, look, building.name, primitive);
    document.json["materials"][0]["name"] = building.name;
    document.json["meshes"].push_back(
        {{"name", name}, {"primitives", OrderedJson::array({primitive})}});
    document.json["nodes"].push_back({{"name", name},
                                      {"mesh", 0},
                                      {"extras",
                                       {{"building", building.name},
                                        {"given_name", shown_name(building)},
                                        {"layer", levels[lod]->layers.back()}}}});
    files.push_back({"engine/" + name + ".glb", finish_glb(std::move(document))});
  }
  return files;
}

std::string lods_entry(const ExportBuilding& building, const EngineOptions& options) {
  const auto levels = levels_of(building);
  const Vec3 pivot = pivot_of(building), world = building.origin + pivot;
  const double diameter = bounding_box(levels[0]->mesh.vertices).diagonal();
  OrderedJson entry = {{"name", building.name},
                       {"given_name", shown_name(building)},
                       {"source", building.source},
                       {"pivot", {world.x(), world.y(), world.z()}},
                       {"bounding_sphere_diameter", diameter},
                       {"levels", OrderedJson::array()}};
  for (std::size_t lod = 0; lod < levels.size(); ++lod) {
    const double rounding = level_grid(*levels[lod], pivot, lod == 0, options).error();
    OrderedJson level =
        level_json(building, lod, *levels[lod], rounding, diameter, options.switching);
    if (lod > 0)  // strictly apart, so that importers keep every level
      level["screen_size"] = std::min(level["screen_size"].get<double>(),
                                      kFall * entry["levels"].back()["screen_size"].get<double>());
    entry["levels"].push_back(level);
  }
  return entry.dump(-1, ' ', false, OrderedJson::error_handler_t::replace);
}

Encoded encode_lods_json(const std::vector<ExportBuilding>& buildings,
                         const EngineOptions& options) {
  std::vector<std::string> entries;
  for (const ExportBuilding& b : buildings) entries.push_back(lods_entry(b, options));
  return encode_lods_json(entries, options);
}

Encoded encode_lods_json(const std::vector<std::string>& entries, const EngineOptions& options) {
  OrderedJson list = OrderedJson::array();
  for (const std::string& entry : entries) list.push_back(OrderedJson::parse(entry));
  OrderedJson json;
  json["about"] =
      "LOD0 is the finest. A level is shown from switch_distance (metres) on, where a pixel covers "
      "gsd metres, or where the bounding sphere's diameter is at most screen_size of the "
      "viewport's "
      "height. Files are y up with the pivot on the ground; pivot is its place in the input's "
      "coordinates, z up, metres.";
  json["switching"] = switching_json(options.switching);
  json["viewport_height"] = options.switching.viewport_height;
  json["fov_y_deg"] = options.switching.fov_y_deg;
  json["buildings"] = list;
  return {"engine/lods.json",
          json.dump(1, ' ', false, OrderedJson::error_handler_t::replace) + "\n"};
}

}  // namespace colod
