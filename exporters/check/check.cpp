// Based on: 3D Tiles 1.1; what clients do with errors, boxes and transforms (CesiumJS,
// 3DTilesRendererJS).
// Differs: contents are decoded and compared with boxes and with each other, which the official
// validator does not do.
#include "check.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <set>

#include "core/error.h"
#include "exporters/tiles3d/frame.h"
#include "files.h"
#include "switching.h"

namespace colod {

using Json = nlohmann::json;
namespace fs = std::filesystem;

namespace {

using Transform = std::array<double, 16>;
constexpr Transform kIdentity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
constexpr double kSlack = 1e-4;    // metres: boxes are written from doubles, contents are floats
constexpr double kLoosest = 1.05;  // a leaf's box against its content's diagonal
constexpr int kDeepest = 200;      // tiles, external tilesets included

Transform product(const Transform& a, const Transform& b) {
  Transform out{};
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r)
      for (int k = 0; k < 4; ++k) out[4 * c + r] += a[4 * k + r] * b[4 * c + k];
  return out;
}

/// Where one building is shown.
struct Shown {
  Box box;           // in the tileset's frame
  double deviation;  // metres
  std::string where;
};

struct Walk {
  std::vector<Finding>& findings;
  CheckedFolder folder;
  std::set<std::string> files;  // contents met
  double target_sse = 0;        // of asset.extras; 0: not said
  ScopeCheck scope;
  std::map<std::string, std::vector<Shown>> buildings;

  void report(const std::string& code, const std::string& where, const std::string& message) {
    findings.push_back({code, where, message});
  }
};

/// A tile on the way down.
struct Place {
  fs::path folder;  // that its URIs are relative to
  std::string where;
  Transform transform;  // to the tileset's frame
  double above;         // the parent's error
  bool is_refine_known;
  int depth = 0;
};

Box tile_box(const Json& tile) {
  const auto b = tile.at("boundingVolume").at("box").get<std::vector<double>>();
  if (b.size() != 12) throw Error(Stage::kInput, "box", "not 12 numbers");
  Box box;
  for (int c = 0; c < 8; ++c)
    box.extend(Vec3(b[0], b[1], b[2]) + (c & 1 ? 1 : -1) * Vec3(b[3], b[4], b[5]) +
               (c & 2 ? 1 : -1) * Vec3(b[6], b[7], b[8]) +
               (c & 4 ? 1 : -1) * Vec3(b[9], b[10], b[11]));
  return box;
}

bool is_inside(const Box& inner, const Box& outer, double slack) {
  return (inner.min - outer.min).minCoeff() >= -slack &&
         (outer.max - inner.max).minCoeff() >= -slack;
}

void check_content(Walk& walk, const Json& tile, const Place& place, const fs::path& path,
                   const Box& box) {
  const GlbContent content = check_glb(read_regular(path), path.string(), walk.findings);
  if (content.has_transforms) return;
  Box seen;
  std::vector<Box> of_feature(content.rows.size());
  for (const auto& mesh : content.meshes)
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      seen.extend(mesh.positions[v]);
      if (v < mesh.features.size() && mesh.features[v] < of_feature.size())
        of_feature[mesh.features[v]].extend(mesh.positions[v]);
    }
  if (seen.is_empty()) return;
  if (!is_inside(seen, box, kSlack))
    walk.report("content-box", place.where, "the content lies outside the tile's box (z up)");
  else if (!tile.contains("children") && box.diagonal() > kLoosest * seen.diagonal() + kSlack)
    walk.report("loose-box", place.where, "the box is wider than the content");
  double farthest = 0;
  for (std::size_t f = 0; f < content.rows.size(); ++f) {
    const GlbContent::Row& row = content.rows[f];
    farthest = std::max(farthest, row.gsd);
    if (!of_feature[f].is_empty())
      walk.buildings[row.name].push_back(
          {moved(of_feature[f], place.transform), row.deviation, place.where});
  }
  walk.scope.add(content.rows, place.where);
  if (tile.contains("children") && walk.target_sse > 0 &&
      tile.at("geometricError").get<double>() < 0.99 * walk.target_sse * farthest)
    walk.report("error-gsd", place.where,
                "the geometric error is less than targetSse times the content's gsd");
  const std::string building = tile.value("extras", Json::object()).value("building", "");
  if (!building.empty() && (content.rows.size() != 1 || content.rows[0].name != building))
    walk.report("identity", place.where, "extras.building is not the property table's name");
}

void check_tile(Walk& walk, const Json& tile, Place place);

void check_external(Walk& walk, const fs::path& path, const Place& place) {
  const Json tileset = parse_json(read_regular(path));
  if (!tileset.is_object() || !tileset.contains("root")) {
    walk.report("json", path.string(), "not a tileset");
    return;
  }
  check_tile(walk, tileset["root"],
             {path.parent_path(), path.string() + " root", place.transform, place.above, false,
              place.depth + 1});
}

/// The tile's content, once: no tile of colod's shares its file, and a tileset that names itself
/// has no end.
void follow(Walk& walk, const Json& tile, const Place& place, const std::string& uri,
            const Box& box) {
  if (uri.empty()) return walk.report("content", place.where, "a tile without content");
  const fs::path path = walk.folder.resolve(place.folder, uri, place.where, walk.findings);
  if (path.empty()) return;
  if (!walk.files.insert(fs::weakly_canonical(path).string()).second)
    return walk.report("repeated", place.where,
                       "another tile shows " + path.string() + ", too; it is read once");
  if (uri.ends_with(".json"))
    check_external(walk, path, place);
  else
    check_content(walk, tile, place, path, box);
}

/// What the tile says of itself.
void check_numbers(Walk& walk, const Json& tile, const Place& place, const Box& box, bool is_leaf) {
  const double error = tile.at("geometricError");
  if (!(error >= 0)) walk.report("error-negative", place.where, "a negative geometric error");
  if (!(error < place.above))
    walk.report("error-not-falling", place.where, "not less than its parent's geometric error");
  if (is_leaf && error != 0)
    walk.report("error-leaf", place.where, "a leaf's geometric error is not 0");
  const std::string refine = tile.value("refine", "");
  const bool is_added = place.depth > 0 && refine == "ADD";  // a scene's own tile, apart
  if (!place.is_refine_known && refine != "REPLACE" && !is_added)
    walk.report("refine", place.where, "the root does not say refine REPLACE");
  if (box.is_empty() || !(box.diagonal() > 0)) walk.report("box", place.where, "an empty box");
}

void check_tile(Walk& walk, const Json& tile, Place place) {
  if (place.depth > kDeepest)
    return walk.report("too-deep", place.where,
                       "more than " + std::to_string(kDeepest) + " tiles one below the other");
  const Box box = tile_box(tile);
  if (tile.contains("transform"))
    place.transform = product(place.transform, tile["transform"].get<Transform>());
  const auto children = tile.find("children");
  const bool has_children = children != tile.end() && !children->empty();
  const std::string uri = tile.value("content", Json::object()).value("uri", "");
  check_numbers(walk, tile, place, box, !has_children && !uri.ends_with(".json"));
  place.above = tile.at("geometricError");
  // A tile that shows nothing itself stands above tiles that do: a whole, and what is around it.
  if (!uri.empty() || !has_children) follow(walk, tile, place, uri, box);
  if (!has_children) return;
  int number = 0;
  for (const Json& child : *children) {
    const std::string where = place.where + "." + std::to_string(number++);
    const Box inner = moved(tile_box(child), child.value("transform", kIdentity));
    if (!is_inside(inner, box, kSlack))
      walk.report("child-outside", where, "its box reaches out of its parent's");
    check_tile(walk, child,
               {place.folder, where, place.transform, place.above, true, place.depth + 1});
  }
}

/// The same building stands at the same place in every tile, to within the deviations.
void check_identity(Walk& walk) {
  for (const auto& [name, places] : walk.buildings)
    for (const Shown& shown : places) {
      const Shown& first = places.front();
      const double slack = first.deviation + shown.deviation + 0.05;
      const double off = std::max((shown.box.min - first.box.min).cwiseAbs().maxCoeff(),
                                  (shown.box.max - first.box.max).cwiseAbs().maxCoeff());
      if (off > slack) {
        walk.report("identity", shown.where,
                    "building " + name + " stands elsewhere than in " + first.where);
        break;
      }
    }
}

void walk_root(Walk& walk, const Json& tileset, const std::string& path) {
  const Json& asset = tileset.at("asset");
  if (asset.at("version") != "1.1") walk.report("version", path, "asset.version is not 1.1");
  const Json extras = asset.value("extras", Json::object());
  walk.target_sse = extras.value("targetSse", 0.0);
  walk.scope.expect(extras.value("switching", Json::object()));
  const double error = tileset.at("geometricError"), root = tileset.at("root").at("geometricError");
  if (error <= 0 || (tileset["root"].contains("children") && root <= 0))
    walk.report("error-zero", path, "geometric errors of 0: nothing would ever be refined");
  if (error < 2 * root)
    walk.report("error-vanishes", path, "the tileset's error is too small: it vanishes from afar");
  Json unmoved = tileset["root"];  // boxes are compared about its frame, not the Earth's centre
  unmoved.erase("transform");
  check_tile(walk, unmoved,
             {fs::path(path).parent_path(), path + " root", kIdentity,
              std::numeric_limits<double>::infinity(), false});
  check_identity(walk);
}

/// Runs `look`; what it stumbles on is a finding about `path`.
template <typename Look>
void guard(Walk& walk, const std::string& path, const Look& look) {
  try {
    look();
  } catch (const Json::exception& problem) {
    walk.report("json", path, problem.what());
  } catch (const Error& problem) {
    walk.report("json", path, problem.what());
  }
}

void walk_tileset(Walk& walk, const std::string& path) {
  guard(walk, path, [&] {
    walk.files.insert(fs::weakly_canonical(path).string());
    const Json tileset = parse_json(read_regular(path));
    if (!tileset.is_object() || !tileset.contains("root"))
      walk.report("json", path, "not a tileset");
    else
      walk_root(walk, tileset, path);
  });
}

/// GLBs below the folder that no tile names.
std::vector<std::string> other_files(const Walk& walk, const std::string& folder) {
  std::vector<std::string> others;
  const auto skip = fs::directory_options::skip_permission_denied;
  for (const auto& entry : fs::recursive_directory_iterator(folder, skip)) {
    std::error_code error;
    const fs::path& path = entry.path();
    if (path.extension() == ".glb" && entry.is_regular_file(error) && walk.folder.holds(path) &&
        !walk.files.contains(fs::weakly_canonical(path).string()))
      others.push_back(path.string());
  }
  std::sort(others.begin(), others.end());
  return others;
}

/// A link that leads to itself is there, too, though nothing is behind it.
bool is_there(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error) || error;
}

/// Whether a file that is there lies in the folder, too; else that is a finding.
bool is_held(Walk& walk, const fs::path& path) {
  if (walk.folder.holds(path)) return true;
  walk.report("outside", path.string(), "leads out of the folder or nowhere: it is not read");
  return false;
}

void check_folder(Walk& walk, const std::string& path) {
  const fs::path tileset = fs::path(path) / "tileset.json";
  const bool has_tileset = is_there(tileset);
  if (has_tileset && is_held(walk, tileset)) walk_tileset(walk, tileset.string());
  const std::vector<std::string> others = other_files(walk, path);
  if (!has_tileset && others.empty())
    throw Error(Stage::kInput, path, "holds neither tileset.json nor a GLB");
  for (const std::string& file : others)
    guard(walk, file, [&] {
      const GlbContent content = check_glb(read_regular(file), file, walk.findings);
      if (!content.json.is_object()) return;
      walk.scope.expect(
          content.json.value("/asset/extras/switching"_json_pointer, Json(Json::object())));
      walk.scope.add(content.rows, file);
    });
  if (const fs::path lods = fs::path(path) / "engine" / "lods.json";
      is_there(lods) && is_held(walk, lods))
    guard(walk, lods.string(),
          [&] { check_lods(read_regular(lods), lods.string(), walk.scope, walk.findings); });
}

}  // namespace

void check_tileset(const std::string& path, std::vector<Finding>& findings) {
  Walk walk{findings, CheckedFolder(fs::path(path).parent_path()), {}, 0, {}, {}};
  walk_tileset(walk, path);
  walk.scope.report(findings);
}

std::vector<Finding> check_output(const std::string& path) {
  std::vector<Finding> findings;
  std::error_code error;
  if (!fs::exists(path, error))
    throw Error(Stage::kInput, path, error ? error.message() : "no such file");
  if (fs::is_directory(path, error)) {
    Walk walk{findings, CheckedFolder(path), {}, 0, {}, {}};
    check_folder(walk, path);
    walk.scope.report(findings);
  } else if (fs::path(path).extension() == ".json") {
    check_tileset(path, findings);
  } else {
    check_glb(read_regular(path), path, findings);
  }
  return findings;
}

}  // namespace colod
