// Based on: 3D Tiles 1.1 (OGC 22-025r4).
// Differs: geometric errors come from measured switches instead of guesses from box sizes.
// Notation: gsd metres a pixel, from where on a tile's content may be shown.
#include "tiles3d.h"

#include <algorithm>
#include <deque>
#include <mutex>
#include <numeric>
#include <set>

#include "content.h"
#include "core/error.h"
#include "core/hash.h"
#include "core/parallel.h"
#include "exporters/gltf/metadata.h"
#include "kept.h"
#include "tile_json.h"

namespace colod {

using OrderedJson = nlohmann::ordered_json;

namespace {

constexpr double kFarShare = 0.05;  // of the finest tiles' bytes, at the root

/// A finished tile and what its parent must cover.
struct Tile {
  OrderedJson json;
  Box box;  // z-up tile space, with all below
  double error = 0;
};

/// A tileset of its own, until the one that names it is finished.
struct Finished {
  TileFrame frame;
  Box box;
  double error = 0;
  std::vector<Encoded> contents = {};  // as they are listed
};

/// A tileset that is being made.
struct TilesetFile {
  std::string folder;  // "" or "tiles/<tile>/"
  TileFrame frame;
  std::deque<PolygonMesh> meshes = {};
  std::vector<Content> contents = {};  // parents before children
  std::vector<Encoded> apart = {};     // tilesets that refine its tiles

  std::string below() const { return folder.empty() ? "tiles/" : folder; }
  std::string path() const { return folder + "tileset.json"; }
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

OrderedJson start_tileset(const TilesOptions& options, const TileFrame& frame, Tile root) {
  const Placement& place = options.placement;
  OrderedJson tileset;
  tileset["asset"] = {{"version", "1.1"}, {"generator", "colod"}};
  tileset["asset"]["extras"] = {
      {"frame", place.to_ecef
                    ? "x, y, z (up) in metres as in the input; the transform leads to ECEF"
                    : "local: x, y, z (up) in metres as in the input, no place on Earth"},
      {"crs", place.to_ecef ? OrderedJson(place.name) : OrderedJson(nullptr)},
      {"offset", vec_json(frame.origin())},
      {"targetSse", options.target_sse},
      {"switching", switching_json(options.switching)}};
  // Drawn from afar: until all of it covers less than a pixel.
  tileset["geometricError"] = std::max(16 * root.error, options.target_sse * root.box.diagonal());
  root.json["refine"] = "REPLACE";
  tileset["root"] = std::move(root.json);
  return tileset;
}

/// At the middle of the parts' foot, to the metre.
TileFrame frame_of(const Placement& placement, const PlannedTile& tile) {
  Box box;
  for (const TilePart& part : tile.parts)
    for (const Vec3& p : part.mesh->vertices) box.extend(Vec3(p + part.origin));
  return {placement, Vec3(std::round(box.center().x()), std::round(box.center().y()),
                          std::floor(box.min.z()))};
}

/// A root that shows nothing itself above the buildings' and the context's tiles.
Tile beside_context(const TilesOptions& o, const TileFrame& frame, Tile buildings,
                    std::vector<Encoded>& files) {
  std::mutex mutex;
  const auto keep = [&](const Encoded& file) {
    const std::lock_guard lock(mutex);
    files.push_back(file);
  };
  Tile root;
  OrderedJson children = OrderedJson::array();
  const auto add = [&](OrderedJson json, const Box& box, double error) {
    root.box.extend(box);
    root.error = std::max(root.error, kRise * error);
    children.push_back(std::move(json));
  };
  add(std::move(buildings.json), buildings.box, buildings.error);
  const std::function<void(const Encoded&)> take = o.take_context ? o.take_context : keep;
  for (ContextTile& tile : encode_context(*o.context, frame, o.compression, o.quantization, take))
    add(std::move(tile.json), tile.box, tile.error);
  std::sort(files.begin(), files.end(),
            [](const Encoded& a, const Encoded& b) { return a.path < b.path; });
  root.error = std::max(root.error, o.target_sse * root.box.diagonal());
  root.json["boundingVolume"] = box_json(root.box);
  root.json["geometricError"] = root.error;
  root.json["children"] = std::move(children);
  return root;
}

using Places = std::vector<std::size_t>;  // in the list of contents, rising
using Files = std::vector<Encoded>;

class TilesetWriter {
 public:
  TilesetWriter(const TilesetInput& input, const std::function<void(const Encoded&)>& take)
      : input_(input), options_(input.options), take_(take) {}

  Files write() {
    const PlanAccess access{.open = input_.depot.open,
                            .at = input_.depot.at,
                            .finish = [&](PlannedTile& tile) { finish(tile); }};
    PlannedTile root =
        plan_tiles(input_.outlines, access, options_.switching, options_.most_entries);
    TilesetFile file = start(root, "");
    const Places all = all_of(file);
    encode(file, without_kept(file, all));
    add_finest(file);
    lighten(file, root);
    hand_over(file, all);
    keep(file, all);
    std::size_t next = 0;
    Files contents;
    Tile tile = assemble(file, root, file.folder, next, contents);
    input_.depot.close();
    Files around;
    if (options_.context) tile = beside_context(options_, file.frame, std::move(tile), around);
    if (file.frame.is_on_earth()) tile.json["transform"] = file.frame.to_ecef();
    Files files = {{file.path(), compact(start_tileset(options_, file.frame, std::move(tile)))}};
    for (Encoded& part : file.apart) give(std::move(part));
    for (Files* more : {&tilesets_, &contents, &around})
      files.insert(files.end(), std::make_move_iterator(more->begin()),
                   std::make_move_iterator(more->end()));
    return files;
  }

 private:
  /// All below a tile that is a tileset; the tile itself becomes a name.
  void finish(PlannedTile& planned) {
    TilesetFile file = start(planned, "tiles/" + planned.name + "/");
    const Places all = all_of(file), left = without_kept(file, all);
    encode(file, left);
    add_finest(file);
    Finished done{file.frame, {}, 0, {}};
    std::size_t next = 0;
    Tile tile = assemble(file, planned, file.folder, next, done.contents);
    done.box = tile.box, done.error = tile.error;
    if (take_) hand_over(file, left);
    for (Encoded& part : file.apart) give(std::move(part));
    give({file.path(), compact(start_tileset(options_, file.frame, std::move(tile)))});
    if (take_ && !left.empty()) keep(file, all);
    finished_.emplace(planned.name, std::move(done));
    planned = {.name = planned.name, .boxes = {}, .parts = {}, .children = {}, .is_tileset = true};
    input_.depot.close();
  }

  bool is_listed() const { return !take_ || options_.lists_files; }

  /// A tileset's file: its bytes go along where nobody takes them.
  void give(Encoded tileset) {
    if (take_) take_(tileset), tileset.bytes = {};
    if (is_listed()) tilesets_.push_back(std::move(tileset));
  }

  TilesetFile start(PlannedTile& planned, const std::string& folder) const {
    std::deque<PolygonMesh> meshes;
    show_boxes(planned, meshes);
    TilesetFile file{folder, frame_of(options_.placement, planned), std::move(meshes)};
    list_contents(planned, file);
    return file;
  }

  void list_contents(const PlannedTile& tile, TilesetFile& file) const {
    file.contents.push_back({&tile, {file.below() + tile.name + ".glb", {}}, {}, 0, 0, {}});
    for (const PlannedTile& child : tile.children)
      if (!child.is_tileset) list_contents(child, file);
  }

  static Places all_of(const TilesetFile& file) {
    Places all(file.contents.size());
    std::iota(all.begin(), all.end(), 0);
    return all;
  }

  std::string key_of(const TilesetFile& file, const Content& content) const {
    return tile_key(*content.tile, file.frame, options_);
  }

  /// Those that have to be encoded; of the others is known what they are.
  Places without_kept(TilesetFile& file, const Places& places) const {
    const KeptTiles* kept = options_.kept;
    if (!kept) return places;
    Places left;
    for (const std::size_t i : places) {
      Content& content = file.contents[i];
      const auto found = kept->find(file.below(), content.file.path, key_of(file, content));
      if (!found) {
        left.push_back(i);
        continue;
      }
      content.box = found->box, content.gsd = found->gsd;
      content.bytes = found->bytes, content.hash = found->hash;
    }
    if (!left.empty()) kept->put(file.below(), {});
    return left;
  }

  /// All files of one folder have been handed over.
  void keep(const TilesetFile& file, const Places& places) const {
    if (!options_.kept || !take_) return;
    std::map<std::string, TileFacts> facts;
    for (const std::size_t i : places) {
      const Content& c = file.contents[i];
      facts[c.file.path] = {key_of(file, c), c.box, c.gsd, c.bytes, c.hash};
    }
    options_.kept->put(file.below(), facts);
  }

  /// Encodes contents, whose buildings have their levels meanwhile.
  void encode(TilesetFile& file, const Places& places) const {
    std::set<int> shown;
    for (const std::size_t i : places)
      for (const TilePart& part : file.contents[i].tile->parts)
        if (part.level) shown.insert(part.buildings.begin(), part.buildings.end());
    const std::vector<int> buildings(shown.begin(), shown.end());
    const LevelDepot& depot = input_.depot;
    parallel_for(buildings.size(), [&](std::size_t i) { depot.get(buildings[i]); });
    parallel_for(places.size(), [&](std::size_t i) {
      encode_content(input_, file.frame, file.contents[places[i]]);
    });
    parallel_for(buildings.size(), [&](std::size_t i) { depot.drop(buildings[i]); });
  }

  /// Hands files over that are not there already.
  void hand_over(TilesetFile& file, const Places& places) const {
    if (!take_) return;
    for (const std::size_t i : places) {
      Content& content = file.contents[i];
      if (content.file.bytes.empty()) continue;
      const Encoded whole = std::move(content.file);  // an emptied string keeps its room
      if (options_.kept) content.hash = hash_of(whole.bytes);
      take_(whole);
      content.file = {whole.path, {}};
    }
  }

  void add_finest(const TilesetFile& file) {
    for (const Content& content : file.contents)
      if (content.tile->children.empty())
        allowed_ += kFarShare * static_cast<double>(content.bytes);
  }

  /// Where the root is more than a share of the finest tiles, stand-ins merge until it is not.
  /// Scenes too small for a single box's GLB, which is some 2 kB, keep what they have.
  void lighten(TilesetFile& file, PlannedTile& root) const {
    Content& content = file.contents.front();
    const std::vector<StandInBox> farthest = root.boxes;
    std::size_t most = farthest.size();
    const auto is_light = [&] { return static_cast<double>(content.bytes) <= allowed_; };
    const auto show_merged = [&](std::size_t count) {
      root.boxes = merge_stand_ins(farthest, count, options_.switching.pixel_error);
      PlannedTile shown{.name = root.name, .boxes = root.boxes, .parts = {}, .children = {}};
      show_boxes(shown, file.meshes);
      root.parts = std::move(shown.parts);
      content.box = {}, content.gsd = 0;
      encode_content(input_, file.frame, content);
    };
    if (is_light()) return;
    show_merged(1);
    if (!is_light()) return show_merged(most);
    do show_merged(most -= (most + 7) / 8);
    while (!is_light());
  }

  /// The tile at `next` in the list of contents, with all below; `next` moves behind them. Its
  /// error is target_sse times the content's gsd, raised where children would not lie strictly
  /// below; 0 for a leaf. Contents go to `listed`; `base`: the folder that URIs start from.
  Tile assemble(TilesetFile& file, const PlannedTile& planned, const std::string& base,
                std::size_t& next, Files& listed) {
    if (planned.is_tileset && next > 0) return wrap(file, planned, listed);
    const std::string own_base = planned.is_apart ? file.below() : base;
    Content& content = file.contents[next++];
    Tile tile;
    tile.box = content.box;
    if (!planned.children.empty())
      tile.error = std::max(kLeastError, options_.target_sse * content.gsd);
    const std::string uri = percent_encoded(content.file.path.substr(own_base.size()));
    const std::size_t place = listed.size();
    if (is_listed()) listed.emplace_back();
    OrderedJson children = OrderedJson::array();
    for (const PlannedTile& below : planned.children) {
      Tile child = assemble(file, below, own_base, next, listed);
      tile.box.extend(child.box);
      tile.error = std::max(tile.error, kRise * child.error);
      children.push_back(std::move(child.json));
    }
    tile.json["boundingVolume"] = box_json(tile.box);
    tile.json["geometricError"] = tile.error;
    tile.json["content"]["uri"] = uri;
    if (planned.parts.size() == 1 && planned.parts[0].level) {
      const ExportBuilding& b = input_.depot.at(planned.parts[0].buildings[0]);
      tile.json["extras"] = identity_json(b.name, shown_name(b), planned.parts[0]);
    }
    if (!children.empty()) tile.json["children"] = std::move(children);
    if (is_listed()) listed[place] = listed_file(content);
    if (planned.is_apart) {
      const std::string path = file.below() + planned.name + ".json";
      tile.json["refine"] = "REPLACE";
      file.apart.push_back(
          {path, put_apart(tile.json, tile.error, percent_encoded(path.substr(base.size())))});
    }
    return tile;
  }

  /// Its bytes go along where nobody takes them.
  Encoded listed_file(Content& content) const {
    return take_ ? Encoded{content.file.path, {}} : std::move(content.file);
  }

  /// A tile whose content is a tileset of its own.
  Tile wrap(const TilesetFile& outer, const PlannedTile& planned, Files& listed) {
    const auto found = finished_.find(planned.name);
    Finished& inner = found->second;
    Tile tile;
    const auto transform = inner.frame.to_parent(outer.frame);
    tile.box = moved(inner.box, transform);
    tile.error = kRise * inner.error;
    tile.json["boundingVolume"] = box_json(inner.box);
    tile.json["geometricError"] = tile.error;
    tile.json["transform"] = transform;
    tile.json["content"]["uri"] =
        (outer.folder.empty() ? "tiles/" : "../") + percent_encoded(planned.name) + "/tileset.json";
    listed.insert(listed.end(), std::make_move_iterator(inner.contents.begin()),
                  std::make_move_iterator(inner.contents.end()));
    finished_.erase(found);
    return tile;
  }

  const TilesetInput& input_;
  const TilesOptions& options_;
  const std::function<void(const Encoded&)>& take_;
  std::map<std::string, Finished> finished_;  // by the name of their tile
  Files tilesets_;                            // of the finished ones
  double allowed_ = 0;                        // bytes of the root
};

void check_count(std::size_t buildings) {
  if (buildings == 0) throw Error(Stage::kOutput, "tileset.json", "no building to write");
}

}  // namespace

std::vector<Encoded> encode_tileset(const std::vector<TileOutline>& outlines,
                                    const LevelDepot& depot, const TilesOptions& options,
                                    const std::function<void(const Encoded&)>& take) {
  check_count(outlines.size());
  const TilesetInput input{outlines, options, depot};
  return TilesetWriter(input, take).write();
}

std::vector<Encoded> encode_tileset(const std::vector<ExportBuilding>& buildings,
                                    const TilesOptions& options) {
  check_count(buildings.size());
  std::vector<TileOutline> outlines(buildings.size());
  parallel_for(buildings.size(),
               [&](std::size_t i) { outlines[i] = outline_of(buildings[i], options.switching); });
  const auto stay = [](int) {};
  const LevelDepot depot{
      .open = [](const std::vector<int>&) {},
      .close = [] {},
      .at = [&](int b) -> const ExportBuilding& { return buildings[b]; },
      .get = stay,
      .drop = stay,
      .named =
          [&](int b) {
            return ExportBuilding{.name = buildings[b].name,
                                  .source = buildings[b].source,
                                  .levels = {},
                                  .given_name = buildings[b].given_name};
          },
      .coarsest = [&](int b) { return coarsest_look(buildings[b].levels.front()); }};
  return encode_tileset(outlines, depot, options, {});
}

}  // namespace colod
