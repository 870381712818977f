// Based on: 3D Tiles 1.1 (OGC 22-025r4), EXT_mesh_features, EXT_structural_metadata.
// Differs: geometric errors are measured, times k = target_sse / pixel_error, instead of guessed
// from box sizes; one quantization step for all tiles, so that neighbours do not crack. The root
// and inner tiles merge the buildings' coarsest layers; below each leaf group hangs one chain of
// finer layers a building, so that REPLACE always replaces a building by itself.
// Notation: k as above; eps geometric error in metres.
#include "tiles3d.h"

#include <algorithm>
#include <numeric>

#include "../src/error.h"
#include "gltf.h"

namespace colod {

using Json = nlohmann::ordered_json;

namespace {

constexpr std::size_t kMostChildren = 16;  // REPLACE waits for all children of a tile
constexpr double kRise = 1.01;             // a parent's error is at least this times its children's
constexpr double kLeastError = 1e-3;       // metres; of a tile that is finer than its errors tell
constexpr int kMostInOneTable = 1 << 24;   // ids beyond are no exact floats

/// A building's layer within a tile.
struct Part {
  const ExportBuilding* building;
  const ExportLayer* layer;
};

struct Scene {
  const TilesOptions& options;
  std::vector<const ExportBuilding*> buildings;
  Vec3 origin = Vec3::Zero();  // world position of the tileset's
  Box box;                     // glTF axes, about origin
  double step = 0;             // one for all tiles, metres
  std::vector<Encoded> files;

  Vec3 offset(const ExportBuilding& b) const { return b.origin - origin; }
};

/// A written tile: its JSON and what its parent must cover.
struct Tile {
  Json json;
  Box box;  // z-up tile space, with all below
  double error = 0;
};

std::string percent_encoded(const std::string& path) {
  static constexpr char kHex[] = "0123456789ABCDEF";
  std::string out;
  for (const char c : path) {
    const auto u = static_cast<unsigned char>(c);
    if ((c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '-' ||
        c == '_' || c == '.' || c == '/' || c == '~')
      out += c;
    else
      out += {'%', kHex[u >> 4], kHex[u & 15]};
  }
  return out;
}

/// The grid of the scene's step about one tile's box.
QuantizationGrid tile_grid(const Scene& scene, const std::vector<Part>& parts) {
  Box box;
  for (const Part& part : parts)
    for (const Vec3& p : part.layer->mesh.vertices)
      box.extend(to_gltf(p + scene.offset(*part.building)));
  QuantizationGrid grid;
  grid.origin = (box.min / scene.step).array().floor().matrix() * scene.step;
  const double cells = std::ceil(box.size().maxCoeff() / scene.step) + 1;
  grid.bits = std::clamp(static_cast<int>(std::ceil(std::log2(cells + 1))), 8, 24);
  grid.range = scene.step * ((1 << grid.bits) - 1);
  return grid;
}

template <typename T>
void put(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// File names may be in any encoding, strings of a property table only in UTF-8.
std::string as_utf8(const std::string& text) {
  return Json::parse(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace))
      .get<std::string>();
}

Json string_column(GltfDocument& document, const std::vector<std::string>& values) {
  std::string bytes, offsets;
  for (const std::string& value : values) {
    put(offsets, static_cast<std::uint32_t>(bytes.size()));
    bytes += as_utf8(value);
  }
  put(offsets, static_cast<std::uint32_t>(bytes.size()));
  if (bytes.empty()) bytes = std::string(1, '\0');  // a buffer view must not be empty
  Json column;
  column["values"] = add_buffer_view(document, bytes);
  column["stringOffsets"] = add_buffer_view(document, offsets);
  return column;
}

Json schema() {
  Json properties;
  properties["name"] = {{"type", "STRING"}, {"description", "Building"}};
  properties["layer"] = {{"type", "SCALAR"},
                         {"componentType", "UINT16"},
                         {"description", "Level of detail, 0 the coarsest"}};
  properties["error"] = {{"type", "SCALAR"},
                         {"componentType", "FLOAT32"},
                         {"description", "Measured distance from the source, metres"}};
  properties["source"] = {{"type", "STRING"}, {"description", "File that the building came from"}};
  Json out;
  out["id"] = "colod";
  out["classes"]["building"] = {{"name", "Building"}, {"properties", properties}};
  return out;
}

void add_metadata(GltfDocument& document, const std::vector<Part>& parts, double rounding) {
  std::vector<std::string> names, sources;
  std::string layers, errors;
  for (const Part& part : parts) {
    names.push_back(part.building->name);
    sources.push_back(part.building->source);
    put(layers, static_cast<std::uint16_t>(part.layer->layer));
    put(errors, static_cast<float>(part.layer->geometric_error + rounding));
  }
  Json table = {{"name", "buildings"}, {"class", "building"}, {"count", parts.size()}};
  table["properties"]["name"] = string_column(document, names);
  table["properties"]["layer"]["values"] = add_buffer_view(document, layers);
  table["properties"]["error"]["values"] = add_buffer_view(document, errors);
  table["properties"]["source"] = string_column(document, sources);
  document.json["extensions"]["EXT_structural_metadata"] = {
      {"schema", schema()}, {"propertyTables", Json::array({table})}};
  for (const char* name : {"EXT_mesh_features", "EXT_structural_metadata"})
    document.json["extensionsUsed"].push_back(name);
}

/// Writes one GLB with the parts merged; returns its box in tile space.
Box write_content(Scene& scene, const std::vector<Part>& parts, const std::string& name) {
  const QuantizationGrid grid = tile_grid(scene, parts);
  FlatMesh merged;
  for (std::size_t i = 0; i < parts.size(); ++i)
    append(merged, flatten(parts[i].layer->mesh, scene.offset(*parts[i].building), grid,
                           static_cast<int>(i)));
  GltfDocument document = start_gltf();
  const Vec3& o = scene.origin;
  document.json["asset"]["extras"] = {{"origin", {o.x(), o.y(), o.z()}},
                                      {"originAxes", "z up, metres"}};
  Box seen;
  Json primitive = add_primitive(document, merged, grid, scene.options.has_draco, &seen);
  primitive["extensions"]["EXT_mesh_features"]["featureIds"] =
      Json::array({{{"featureCount", parts.size()}, {"attribute", 0}, {"propertyTable", 0}}});
  document.json["meshes"].push_back({{"name", name}, {"primitives", Json::array({primitive})}});
  document.json["nodes"].push_back({{"name", name}, {"mesh", 0}});
  add_metadata(document, parts, grid.error());
  scene.files.push_back({"tiles/" + name + ".glb", finish_glb(std::move(document))});
  Box box;
  box.extend(from_gltf(seen.min));
  box.extend(from_gltf(seen.max));
  return box;
}

Json box_json(const Box& box) {
  const Vec3 c = box.center(), h = 0.5 * box.size();
  return {{"box", {c.x(), c.y(), c.z(), h.x(), 0, 0, 0, h.y(), 0, 0, 0, h.z()}}};
}

/// A tile with its content and children. Its error is k times the content's eps, raised where
/// children would not lie strictly below; 0 for a leaf.
Tile make_tile(Scene& scene, const std::vector<Part>& parts, const std::string& name,
               std::vector<Tile> children) {
  Tile tile;
  tile.box = write_content(scene, parts, name);
  double eps = 0;
  for (const Part& part : parts) eps = std::max(eps, part.layer->geometric_error);
  eps += 0.5 * std::sqrt(3.0) * scene.step;
  const double k = scene.options.target_sse / scene.options.pixel_error;
  if (!children.empty()) tile.error = std::max(kLeastError, k * eps);
  for (const Tile& child : children) {
    tile.box.extend(child.box);
    tile.error = std::max(tile.error, kRise * child.error);
  }
  tile.json["boundingVolume"] = box_json(tile.box);
  tile.json["geometricError"] = tile.error;
  tile.json["content"]["uri"] = percent_encoded("tiles/" + name + ".glb");
  for (Tile& child : children) tile.json["children"].push_back(std::move(child.json));
  return tile;
}

/// The building's layers from `level` on, each the only child of the coarser one.
Tile make_chain(Scene& scene, const ExportBuilding& building, std::size_t level) {
  std::vector<Tile> children;
  if (level + 1 < building.layers.size())
    children.push_back(make_chain(scene, building, level + 1));
  const ExportLayer& layer = building.layers[level];
  Tile tile =
      make_tile(scene, {{&building, &layer}},
                building.name + ".layer" + std::to_string(layer.layer), std::move(children));
  tile.json["extras"] = {{"building", building.name}, {"layer", layer.layer}};
  return tile;
}

Vec3 middle(const ExportBuilding& b) {
  return b.origin + bounding_box(b.layers.front().mesh.vertices).center();
}

/// Four groups of equal size by halving along x, then y. Ties go by place in the list.
std::vector<std::vector<int>> quarter(const Scene& scene, std::vector<int> group) {
  const auto halve = [&](std::vector<int> all, int axis) {
    std::stable_sort(all.begin(), all.end(), [&](int a, int b) {
      return middle(*scene.buildings[a])[axis] < middle(*scene.buildings[b])[axis];
    });
    const auto half = all.begin() + static_cast<long>((all.size() + 1) / 2);
    return std::array{std::vector<int>(all.begin(), half), std::vector<int>(half, all.end())};
  };
  std::vector<std::vector<int>> out;
  for (const std::vector<int>& side : halve(std::move(group), 0))
    for (const std::vector<int>& part : halve(side, 1)) out.push_back(part);
  for (std::vector<int>& part : out) std::sort(part.begin(), part.end());
  return out;
}

/// The tile that shows a group's coarsest layers, and all below it.
Tile make_group(Scene& scene, const std::vector<int>& group, const std::string& name) {
  std::vector<Part> parts;
  for (const int b : group)
    parts.push_back({scene.buildings[b], &scene.buildings[b]->layers.front()});
  std::vector<Tile> children;
  if (group.size() > kMostChildren) {
    int number = 0;
    for (const std::vector<int>& part : quarter(scene, group))
      children.push_back(make_group(scene, part, name + "." + std::to_string(number++)));
  } else {
    const bool has_finer = std::any_of(parts.begin(), parts.end(),
                                       [](const Part& p) { return p.building->layers.size() > 1; });
    for (const Part& p : parts)  // a building without a finer layer is replaced by itself
      if (has_finer)
        children.push_back(make_chain(scene, *p.building, p.building->layers.size() > 1));
  }
  return make_tile(scene, parts, name, std::move(children));
}

/// Origin at the scene's centre on its foot, to the metre; one step that keeps every closed layer
/// closed.
void place_scene(Scene& scene) {
  Box world;
  for (const ExportBuilding* b : scene.buildings)
    for (const ExportLayer& layer : b->layers)
      for (const Vec3& p : layer.mesh.vertices) world.extend(Vec3(p + b->origin));
  scene.origin = {std::round(world.center().x()), std::round(world.center().y()),
                  std::floor(world.min.z())};
  scene.box.extend(to_gltf(world.min - scene.origin));
  scene.box.extend(to_gltf(world.max - scene.origin));
  scene.step = fit_grid(scene.box, scene.options.quantization).step();
  for (const ExportBuilding* b : scene.buildings)
    for (const ExportLayer& layer : b->layers)
      scene.step = std::min(scene.step, fit_closed_grid(layer.mesh, scene.offset(*b), scene.box,
                                                        scene.options.quantization)
                                            .step());
}

std::vector<const ExportBuilding*> usable(const std::vector<ExportBuilding>& buildings) {
  std::vector<const ExportBuilding*> out;
  for (const ExportBuilding& b : buildings) {
    const bool is_whole = !b.layers.empty() &&
                          std::none_of(b.layers.begin(), b.layers.end(), [](const ExportLayer& l) {
                            return l.mesh.triangles.empty();
                          });
    if (!is_whole) throw Error(Stage::kOutput, b.name, "no layer, or a layer without triangles");
    out.push_back(&b);
  }
  if (out.empty()) throw Error(Stage::kOutput, "tileset.json", "no building to write");
  if (out.size() > kMostInOneTable)
    throw Error(Stage::kOutput, "tileset.json", "more buildings than ids in one tile");
  return out;
}

}  // namespace

std::vector<Encoded> encode_tileset(const std::vector<ExportBuilding>& buildings,
                                    const TilesOptions& options) {
  Scene scene{options, usable(buildings), Vec3::Zero(), {}, 0, {}};
  place_scene(scene);
  std::vector<int> all(scene.buildings.size());
  std::iota(all.begin(), all.end(), 0);
  Tile root = make_group(scene, all, "root");
  root.json["refine"] = "REPLACE";
  Json tileset;
  const Vec3& o = scene.origin;
  tileset["asset"] = {{"version", "1.1"}, {"generator", "colod"}};
  tileset["asset"]["extras"] = {
      {"frame", "local: x, y, z (up) in metres as in the input, no place on Earth"},
      {"offset", {o.x(), o.y(), o.z()}},
      {"errorScale", options.target_sse / options.pixel_error}};
  tileset["geometricError"] = std::max(16 * root.error, root.box.diagonal());  // drawn from afar
  tileset["root"] = std::move(root.json);
  std::vector<Encoded> files = {
      {"tileset.json", tileset.dump(1, ' ', false, Json::error_handler_t::replace) + "\n"}};
  files.insert(files.end(), std::make_move_iterator(scene.files.begin()),
               std::make_move_iterator(scene.files.end()));
  return files;
}

}  // namespace colod
