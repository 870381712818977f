// Based on: 3D Tiles 1.1 (OGC 22-025r4), EXT_mesh_features, EXT_structural_metadata.
// Differs: all tiles share one quantization step or a power of two of it, so that neighbours do not
// crack.
#include "content.h"

#include <algorithm>
#include <limits>

#include "exporters/gltf/metadata.h"
#include "looks.h"

namespace colod {

using OrderedJson = nlohmann::ordered_json;

namespace {

constexpr double kStandInError = 0.02;  // of the least error of a tile's stand-ins
constexpr std::size_t kMostNames = 4;   // of buildings behind one stand-in, in its name

Feature feature_of(const TilesetInput& input, const TilePart& part, double rounding,
                   std::size_t faces) {
  if (part.level)
    return feature_of(input.depot.at(part.buildings[0]), *part.level, part.deviation + rounding,
                      faces);
  Feature f;
  f.gsd = part.gsd;
  f.deviation = part.deviation + rounding;
  f.faces = faces;
  for (std::size_t i = 0; i < std::min(kMostNames, part.buildings.size()); ++i) {
    const ExportBuilding b = input.depot.named(part.buildings[i]);
    if (i == 0) f.source = b.source;
    f.name += (i ? ", " : "") + b.name;
    f.given_name += (i ? ", " : "") + shown_name(b);
  }
  if (part.buildings.size() > kMostNames) {
    const std::string more = " and " + std::to_string(part.buildings.size() - kMostNames) + " more";
    f.name += more, f.given_name += more;
  }
  const std::uint64_t source = input.outlines[part.buildings[0]].source;
  for (const int b : part.buildings)
    if (input.outlines[b].source != source) f.source.clear();
  return f;
}

/// The parts in the frame's coordinates, z up.
std::vector<PolygonMesh> placed_parts(const PlannedTile& tile, const TileFrame& frame) {
  std::vector<PolygonMesh> out;
  for (const TilePart& part : tile.parts) {
    out.push_back(*part.mesh);
    for (Vec3& p : out.back().vertices) p = frame.local(p + part.origin);
  }
  return out;
}

/// A grid of the scene's steps that keeps closed what is closed.
QuantizationGrid content_grid(const std::vector<PolygonMesh>& parts, double bound) {
  Box box;
  for (const PolygonMesh& mesh : parts)
    for (const Vec3& p : mesh.vertices) box.extend(to_gltf(p));
  double step = fit_grid(box, bound).step();
  for (const PolygonMesh& mesh : parts)
    step = std::min(step, fit_closed_grid(mesh, Vec3::Zero(), box, bound).step());
  return grid_about(box, step);
}

/// Metres. Stand-ins are rounded to a share of what they deviate in any case.
double rounding_bound(const PlannedTile& tile, const TilesOptions& options) {
  if (tile.is_finest) return kFinestShare * options.quantization;
  double least = std::numeric_limits<double>::infinity();
  for (const TilePart& part : tile.parts) least = std::min(least, part.level ? 0 : part.deviation);
  return std::max(options.quantization, kStandInError * least);
}

TileLook look_of(const TilesetInput& input, const PlannedTile& tile) {
  if (tile.parts.front().level) return look_of_levels(tile, input.options.largest_texture);
  for (const TilePart& part : tile.parts)
    for (const int b : part.buildings)
      if (input.outlines[b].has_look) return look_of_stand_ins(tile, input.depot.coarsest);
  return {std::vector<LevelLook>(tile.parts.size()), {}};
}

/// As set_look() makes its material.
bool is_unlit(const LevelLook& look) {
  return look.has_texture() ? look.normals.empty() : !look.facet_colors.empty();
}

}  // namespace

OrderedJson vec_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

OrderedJson identity_json(const std::string& name, const std::string& given_name,
                          const TilePart& part) {
  const int finest = part.level ? part.level->layers.back() : -1;
  const int coarsest = part.level ? part.level->layers.front() : -1;
  OrderedJson json = {{"building", name}, {"layer", finest}, {"coarsestLayer", coarsest}};
  if (given_name != name) json["given_name"] = given_name;
  return json;
}

void encode_content(const TilesetInput& input, const TileFrame& frame, Content& content) {
  const PlannedTile& tile = *content.tile;
  const std::vector<PolygonMesh> parts = placed_parts(tile, frame);
  const QuantizationGrid grid = content_grid(parts, rounding_bound(tile, input.options));
  TileLook look = look_of(input, tile);
  look.whole.has_mip_levels = look.whole.format == ImageFormat::kKtx2;  // it brings them along
  FlatMesh merged;
  std::vector<Feature> features;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const FlatMesh flat = flatten(parts[i], Vec3::Zero(), grid, static_cast<int>(i), look.parts[i]);
    features.push_back(feature_of(input, tile.parts[i], grid.error(), flat.triangles.size()));
    content.gsd = std::max(content.gsd, features.back().gsd);
    append(merged, flat);
  }
  if (is_unlit(look.whole)) merged.normals.clear();  // nothing asks for them
  GltfDocument document = start_gltf();
  if (!frame.is_on_earth())  // z up, metres; on Earth a tile's transform says it
    document.json["asset"]["extras"]["origin"] = vec_json(frame.origin());
  Box seen;
  OrderedJson primitive = add_primitive(document, merged, grid, input.options.compression, &seen);
  set_look(document, look.whole, tile.name, primitive);
  primitive["extensions"]["EXT_mesh_features"] = feature_ids(features.size());
  OrderedJson node = {{"name", tile.name}, {"mesh", 0}};
  if (features.size() == 1)
    node["extras"] = identity_json(features[0].name, features[0].given_name, tile.parts[0]);
  document.json["meshes"].push_back({{"primitives", OrderedJson::array({primitive})}});
  document.json["nodes"].push_back(node);
  add_features(document, features);
  content.file.bytes = finish_glb(std::move(document));
  content.bytes = content.file.bytes.size();
  content.box.extend(from_gltf(seen.min));
  content.box.extend(from_gltf(seen.max));
}

}  // namespace colod
