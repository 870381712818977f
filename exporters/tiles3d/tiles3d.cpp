// Based on: 3D Tiles 1.1 (OGC 22-025r4), EXT_mesh_features, EXT_structural_metadata.
// Differs: geometric errors come from measured switches instead of guesses from box sizes; all
// tiles share one quantization step or a power of two of it, so that neighbours do not crack.
// Notation: gsd metres a pixel, from where on a tile's content may be shown.
#include "tiles3d.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <mutex>
#include <numeric>
#include <set>

#include "core/error.h"
#include "core/parallel.h"
#include "exporters/gltf/metadata.h"
#include "frame.h"
#include "kept.h"
#include "looks.h"
#include "tile_json.h"
#include "tree.h"

namespace colod {

using Json = nlohmann::ordered_json;

namespace {

constexpr double kStandInShare = 0.02;  // of the least error of a tile's stand-ins
constexpr double kFarShare = 0.05;      // of the finest tiles' bytes, at the root
constexpr std::size_t kMostNames = 4;   // of buildings behind one stand-in, in its name

/// A finished tile and what its parent must cover.
struct Tile {
  Json json;
  Box box;  // z-up tile space, with all below
  double error = 0;
};

/// A tile's GLB and what the tileset says of it.
struct Content {
  const PlannedTile* tile;
  std::size_t frame;   // index into Scene::frames
  std::string folder;  // of the tileset that the tile belongs to, "" or "tiles/<cell>/"
  Encoded file;
  Box box;  // z-up tile space
  double gsd = 0;
  std::size_t bytes = 0;  // of the file, which may be handed over, or was there before

  std::string below() const { return folder.empty() ? "tiles/" : folder; }
};

/// A cell whose tiles are all encoded.
struct Finished {
  Tile tile;
  std::size_t end = 0;  // behind its last content
};

struct Scene {
  const std::vector<ExportBuilding>& buildings;
  const std::vector<TileOutline>& outlines;
  const TilesOptions& options;
  const LevelDepot& depot;
  std::vector<TileFrame> frames = {};             // the tileset's, then the cells'
  std::vector<Content> contents = {};             // parents before children
  std::vector<Encoded> cells = {};                // tilesets of cells, without what was taken
  std::map<std::size_t, Finished> finished = {};  // cells by the place of their first content
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

Json vec_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

Feature feature_of(const Scene& scene, const TilePart& part, double rounding, std::size_t faces) {
  if (part.level)
    return feature_of(scene.buildings[part.buildings[0]], *part.level, part.deviation + rounding,
                      faces);
  Feature f;
  f.gsd = part.gsd;
  f.deviation = part.deviation + rounding;
  f.faces = faces;
  for (std::size_t i = 0; i < std::min(kMostNames, part.buildings.size()); ++i) {
    const ExportBuilding& b = scene.buildings[part.buildings[i]];
    f.name += (i ? ", " : "") + b.name;
    f.given_name += (i ? ", " : "") + shown_name(b);
  }
  if (part.buildings.size() > kMostNames) {
    const std::string more = " and " + std::to_string(part.buildings.size() - kMostNames) + " more";
    f.name += more, f.given_name += more;
  }
  f.source = scene.buildings[part.buildings[0]].source;
  for (const int b : part.buildings)
    if (scene.buildings[b].source != f.source) f.source.clear();
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
  return std::max(options.quantization, kStandInShare * least);
}

/// Whom and which layers a tile of one part shows.
Json identity_json(const std::string& name, const std::string& given_name, const TilePart& part) {
  const int finest = part.level ? part.level->layers.back() : -1;
  const int coarsest = part.level ? part.level->layers.front() : -1;
  Json json = {{"building", name}, {"layer", finest}, {"coarsestLayer", coarsest}};
  if (given_name != name) json["given_name"] = given_name;
  return json;
}

TileLook look_of(const Scene& scene, const PlannedTile& tile) {
  if (tile.parts.front().level) return look_of_levels(tile, scene.options.largest_texture);
  for (const TilePart& part : tile.parts)
    for (const int b : part.buildings)
      if (scene.outlines[b].has_look) return look_of_stand_ins(tile, scene.depot.coarsest);
  return {std::vector<LevelLook>(tile.parts.size()), {}};
}

/// One GLB with the tile's parts merged.
void encode_content(const Scene& scene, Content& content) {
  const PlannedTile& tile = *content.tile;
  const TileFrame& frame = scene.frames[content.frame];
  const std::vector<PolygonMesh> parts = placed_parts(tile, frame);
  const QuantizationGrid grid = content_grid(parts, rounding_bound(tile, scene.options));
  const TileLook look = look_of(scene, tile);
  FlatMesh merged;
  std::vector<Feature> features;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const FlatMesh flat = flatten(parts[i], Vec3::Zero(), grid, static_cast<int>(i), look.parts[i]);
    features.push_back(feature_of(scene, tile.parts[i], grid.error(), flat.triangles.size()));
    content.gsd = std::max(content.gsd, features.back().gsd);
    append(merged, flat);
  }
  GltfDocument document = start_gltf();
  if (!frame.is_on_earth())  // z up, metres; on Earth a tile's transform says it
    document.json["asset"]["extras"]["origin"] = vec_json(frame.origin());
  Box seen;
  Json primitive = add_primitive(document, merged, grid, scene.options.compression, &seen);
  set_look(document, look.whole, tile.name, primitive);
  primitive["extensions"]["EXT_mesh_features"] = feature_ids(features.size());
  Json node = {{"name", tile.name}, {"mesh", 0}};
  if (features.size() == 1)
    node["extras"] = identity_json(features[0].name, features[0].given_name, tile.parts[0]);
  document.json["meshes"].push_back({{"primitives", Json::array({primitive})}});
  document.json["nodes"].push_back(node);
  add_features(document, features);
  content.file.bytes = finish_glb(std::move(document));
  content.bytes = content.file.bytes.size();
  content.box.extend(from_gltf(seen.min));
  content.box.extend(from_gltf(seen.max));
}

/// Where the root is more than a share of the finest tiles, stand-ins merge until it is not. Scenes
/// too small for a single box's GLB, which is some 2 kB, keep what they have.
void lighten_root(Scene& scene, TilePlan& plan) {
  Content& root = scene.contents.front();
  double allowed = 0;
  for (const Content& content : scene.contents)
    if (content.tile->children.empty()) allowed += kFarShare * static_cast<double>(content.bytes);
  std::size_t most = plan.farthest.size();
  const auto is_light = [&] { return static_cast<double>(root.bytes) <= allowed; };
  const auto show_merged = [&](std::size_t count) {
    show_farthest(plan, merge_stand_ins(plan.farthest, count, scene.options.switching.pixel_error));
    root.box = {}, root.gsd = 0;
    encode_content(scene, root);
  };
  if (is_light()) return;
  show_merged(1);
  if (!is_light()) return show_merged(most);
  do show_merged(most -= (most + 7) / 8);
  while (!is_light());
}

/// At the middle of the parts' foot, to the metre.
TileFrame frame_of(const Scene& scene, const PlannedTile& tile) {
  Box box;
  for (const TilePart& part : tile.parts)
    for (const Vec3& p : part.mesh->vertices) box.extend(Vec3(p + part.origin));
  return {scene.options.placement, Vec3(std::round(box.center().x()), std::round(box.center().y()),
                                        std::floor(box.min.z()))};
}

void list_contents(Scene& scene, const PlannedTile& tile, std::size_t frame, std::string folder) {
  if (tile.is_cell && !scene.contents.empty()) {
    folder = "tiles/" + tile.name + "/";
    frame = scene.frames.size();
    scene.frames.push_back(frame_of(scene, tile));
  }
  scene.contents.push_back({&tile, frame, folder, {}, {}});
  scene.contents.back().file.path = scene.contents.back().below() + tile.name + ".glb";
  for (const PlannedTile& child : tile.children) list_contents(scene, child, frame, folder);
}

Json start_tileset(const Scene& scene, const TileFrame& frame, Tile root) {
  const Placement& place = scene.options.placement;
  Json tileset;
  tileset["asset"] = {{"version", "1.1"}, {"generator", "colod"}};
  tileset["asset"]["extras"] = {
      {"frame", place.to_ecef
                    ? "x, y, z (up) in metres as in the input; the transform leads to ECEF"
                    : "local: x, y, z (up) in metres as in the input, no place on Earth"},
      {"crs", place.to_ecef ? Json(place.name) : Json(nullptr)},
      {"offset", vec_json(frame.origin())},
      {"targetSse", scene.options.target_sse},
      {"switching", switching_json(scene.options.switching)}};
  // Drawn from afar: until all of it covers less than a pixel.
  tileset["geometricError"] =
      std::max(16 * root.error, scene.options.target_sse * root.box.diagonal());
  root.json["refine"] = "REPLACE";
  tileset["root"] = std::move(root.json);
  return tileset;
}

std::string dumped(const Json& json) {
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// The tile at `next` in the list of contents, with all below; `next` moves behind them. Its error
/// is target_sse times the content's gsd, raised where children would not lie strictly below; 0 for
/// a leaf.
Tile assemble(Scene& scene, std::size_t& next);

/// A tile whose content is the cell's own tileset.
Tile wrap_cell(Scene& scene, const Content& content, Tile inner) {
  const TileFrame &frame = scene.frames[content.frame], &outer = scene.frames.front();
  Tile tile;
  const auto transform = frame.to_parent(outer);
  tile.box = moved(inner.box, transform);
  tile.error = kRise * inner.error;
  tile.json["boundingVolume"] = box_json(inner.box);
  tile.json["geometricError"] = tile.error;
  tile.json["transform"] = transform;
  tile.json["content"]["uri"] = percent_encoded(content.folder + "tileset.json");
  scene.cells.push_back(
      {content.folder + "tileset.json", dumped(start_tileset(scene, frame, std::move(inner)))});
  return tile;
}

Tile assemble(Scene& scene, std::size_t& next) {
  if (const auto cell = scene.finished.find(next); cell != scene.finished.end()) {
    next = cell->second.end;
    return std::move(cell->second.tile);
  }
  const std::size_t self = next++;
  const PlannedTile& planned = *scene.contents[self].tile;
  const Content& content = scene.contents[self];
  Tile tile;
  tile.box = content.box;
  if (!planned.children.empty())
    tile.error = std::max(kLeastError, scene.options.target_sse * content.gsd);
  Json children = Json::array();
  for (std::size_t i = 0; i < planned.children.size(); ++i) {
    Tile child = assemble(scene, next);
    tile.box.extend(child.box);
    tile.error = std::max(tile.error, kRise * child.error);
    children.push_back(std::move(child.json));
  }
  tile.json["boundingVolume"] = box_json(tile.box);
  tile.json["geometricError"] = tile.error;
  tile.json["content"]["uri"] = percent_encoded(content.file.path.substr(content.folder.size()));
  if (planned.parts.size() == 1 && planned.parts[0].level) {
    const ExportBuilding& b = scene.buildings[planned.parts[0].buildings[0]];
    tile.json["extras"] = identity_json(b.name, shown_name(b), planned.parts[0]);
  }
  if (!children.empty()) tile.json["children"] = std::move(children);
  if (planned.is_cell && self > 0) return wrap_cell(scene, content, std::move(tile));
  return tile;
}

/// A root that shows nothing itself above the buildings' and the context's tiles.
Tile beside_context(const Scene& scene, Tile buildings, std::vector<Encoded>& files) {
  const TilesOptions& o = scene.options;
  std::mutex mutex;
  const auto keep = [&](const Encoded& file) {
    const std::lock_guard lock(mutex);
    files.push_back(file);
  };
  Tile root;
  Json children = Json::array();
  const auto add = [&](Json json, const Box& box, double error) {
    root.box.extend(box);
    root.error = std::max(root.error, kRise * error);
    children.push_back(std::move(json));
  };
  add(std::move(buildings.json), buildings.box, buildings.error);
  const std::function<void(const Encoded&)> take = o.take_context ? o.take_context : keep;
  for (ContextTile& tile :
       encode_context(*o.context, scene.frames.front(), o.compression, o.quantization, take))
    add(std::move(tile.json), tile.box, tile.error);
  std::sort(files.begin(), files.end(),
            [](const Encoded& a, const Encoded& b) { return a.path < b.path; });
  root.error = std::max(root.error, o.target_sse * root.box.diagonal());
  root.json["boundingVolume"] = box_json(root.box);
  root.json["geometricError"] = root.error;
  root.json["children"] = std::move(children);
  return root;
}

std::size_t end_of(const Scene& scene, std::size_t first) {
  std::size_t end = first + 1;
  while (end < scene.contents.size() && scene.contents[end].frame == scene.contents[first].frame)
    ++end;
  return end;
}

using Places = std::vector<std::size_t>;  // in the list of contents, rising

std::string key_of(const Scene& scene, const Content& content) {
  return tile_key(*content.tile, scene.frames[content.frame], scene.buildings, scene.options);
}

/// Those of one folder that have to be encoded; of the others is known what they are.
Places without_kept(Scene& scene, const Places& places) {
  const KeptTiles* kept = scene.options.kept;
  if (!kept || places.empty()) return places;
  const std::string folder = scene.contents[places.front()].below();
  const auto there = kept->get(folder);
  Places left;
  for (const std::size_t i : places) {
    Content& content = scene.contents[i];
    const auto found = there.find(content.file.path);
    if (found == there.end() || found->second.key != key_of(scene, content)) {
      left.push_back(i);
      continue;
    }
    content.box = found->second.box, content.gsd = found->second.gsd;
    content.bytes = found->second.bytes;
  }
  if (!left.empty()) kept->put(folder, {});
  return left;
}

/// All files of one folder have been handed over.
void keep(const Scene& scene, const Places& places) {
  const KeptTiles* kept = scene.options.kept;
  if (!kept || places.empty()) return;
  std::map<std::string, TileFacts> facts;
  for (const std::size_t i : places) {
    const Content& c = scene.contents[i];
    facts[c.file.path] = {key_of(scene, c), c.box, c.gsd, c.bytes};
  }
  kept->put(scene.contents[places.front()].below(), facts);
}

/// Hands a content's file over, unless it is there already.
void hand_over(Content& content, const std::function<void(const Encoded&)>& take) {
  if (content.file.bytes.empty()) return;
  const Encoded file = std::move(content.file);  // an emptied string keeps its room
  take(file);
  content.file = {file.path, {}};
}

/// Encodes contents, whose buildings have their levels meanwhile.
void encode_contents(Scene& scene, const Places& places) {
  std::set<int> shown;
  for (const std::size_t i : places)
    for (const TilePart& part : scene.contents[i].tile->parts)
      if (part.level) shown.insert(part.buildings.begin(), part.buildings.end());
  const std::vector<int> buildings(shown.begin(), shown.end());
  parallel_for(buildings.size(), [&](std::size_t i) { scene.depot.get(buildings[i]); });
  parallel_for(places.size(),
               [&](std::size_t i) { encode_content(scene, scene.contents[places[i]]); });
  parallel_for(buildings.size(), [&](std::size_t i) { scene.depot.drop(buildings[i]); });
}

/// Cell by cell, so that one cell's levels are there at a time; `take` gets its files, its tileset
/// last, unless it is empty.
void encode_cells(Scene& scene, const std::function<void(const Encoded&)>& take) {
  for (std::size_t first = 1; first < scene.contents.size(); ++first) {
    if (!scene.contents[first].tile->is_cell) continue;
    Places places(end_of(scene, first) - first);
    std::iota(places.begin(), places.end(), first);
    const Places left = without_kept(scene, places);
    encode_contents(scene, left);
    std::size_t next = first;
    Tile tile = assemble(scene, next);
    scene.finished[first] = {std::move(tile), places.back() + 1};
    if (take) {
      for (const std::size_t i : left) hand_over(scene.contents[i], take);
      take(scene.cells.back());
      scene.cells.back().bytes = {};
      if (!left.empty()) keep(scene, places);
    }
    first = places.back();
  }
}

/// What belongs to no cell.
Places top_of(const Scene& scene) {
  Places top;
  for (std::size_t i = 0; i < scene.contents.size(); ++i)
    if (scene.contents[i].frame == 0) top.push_back(i);
  return top;
}

/// The same encoded, the root made light.
void encode_top(Scene& scene, TilePlan& plan, const std::function<void(const Encoded&)>& take) {
  const Places top = top_of(scene);
  encode_contents(scene, without_kept(scene, top));
  lighten_root(scene, plan);
  if (!take) return;
  for (const std::size_t i : top) hand_over(scene.contents[i], take);
  keep(scene, top);
}

void check(const std::vector<ExportBuilding>& buildings) {
  if (buildings.empty()) throw Error(Stage::kOutput, "tileset.json", "no building to write");
}

}  // namespace

std::vector<Encoded> encode_tileset(const std::vector<ExportBuilding>& buildings,
                                    const std::vector<TileOutline>& outlines,
                                    const LevelDepot& depot, const TilesOptions& options,
                                    const std::function<void(const Encoded&)>& take) {
  check(buildings);
  TilePlan plan = plan_tiles(buildings, outlines, options.switching);
  Scene scene{buildings, outlines, options, depot};
  scene.frames.push_back(frame_of(scene, plan.root));
  list_contents(scene, plan.root, 0, "");
  encode_cells(scene, take);
  encode_top(scene, plan, take);
  std::size_t next = 0;
  Tile root = assemble(scene, next);
  const TileFrame& frame = scene.frames.front();
  std::vector<Encoded> around;
  if (options.context) root = beside_context(scene, std::move(root), around);
  if (frame.is_on_earth()) root.json["transform"] = frame.to_ecef();
  std::vector<Encoded> files = {
      {"tileset.json", dumped(start_tileset(scene, frame, std::move(root)))}};
  files.insert(files.end(), std::make_move_iterator(scene.cells.begin()),
               std::make_move_iterator(scene.cells.end()));
  for (Content& content : scene.contents) files.push_back(std::move(content.file));
  for (Encoded& file : around) files.push_back(std::move(file));
  return files;
}

std::vector<Encoded> encode_tileset(const std::vector<ExportBuilding>& buildings,
                                    const TilesOptions& options) {
  check(buildings);
  std::vector<TileOutline> outlines(buildings.size());
  parallel_for(buildings.size(),
               [&](std::size_t i) { outlines[i] = outline_of(buildings[i], options.switching); });
  const auto stay = [](int) {};
  const auto coarsest = [&](int b) { return coarsest_look(buildings[b].levels.front()); };
  return encode_tileset(buildings, outlines, {stay, stay, coarsest}, options, {});
}

}  // namespace colod
