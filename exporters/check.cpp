// Based on: 3D Tiles 1.1; what clients do with errors, boxes and transforms (CesiumJS,
// 3DTilesRendererJS).
// Differs: contents are decoded and compared with boxes and with each other, which the official
// validator does not do.
#include "check.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <set>

#include "../src/error.h"
#include "check_switching.h"
#include "tiles3d_frame.h"

namespace colod {

using Json = nlohmann::json;
namespace fs = std::filesystem;

namespace {

using Transform = std::array<double, 16>;
constexpr Transform kIdentity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
constexpr double kSlack = 1e-4;    // metres: boxes are written from doubles, contents are floats
constexpr double kLoosest = 1.05;  // a leaf's box against its content's diagonal

std::string slurp(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string decoded_uri(const std::string& uri) {
  std::string out;
  for (std::size_t i = 0; i < uri.size(); ++i)
    if (uri[i] == '%' && i + 2 < uri.size()) {
      out += static_cast<char>(std::stoi(uri.substr(i + 1, 2), nullptr, 16));
      i += 2;
    } else {
      out += uri[i];
    }
  return out;
}

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
  std::set<std::string> files;  // GLBs met
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
  walk.files.insert(path.lexically_normal().string());
  const GlbContent content = check_glb(slurp(path), path.string(), walk.findings);
  if (content.meshes.empty() || content.has_transforms) return;
  Box seen;
  std::vector<Box> of_feature(content.rows.size());
  const auto& mesh = content.meshes[0];
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
  const Json tileset = Json::parse(slurp(path), nullptr, false);
  if (!tileset.is_object() || !tileset.contains("root")) {
    walk.report("json", path.string(), "not a tileset");
    return;
  }
  check_tile(walk, tileset["root"],
             {path.parent_path(), path.string() + " root", place.transform, place.above, false});
}

void check_tile(Walk& walk, const Json& tile, Place place) {
  const Box box = tile_box(tile);
  if (tile.contains("transform"))
    place.transform = product(place.transform, tile["transform"].get<Transform>());
  const double error = tile.at("geometricError");
  const Json children = tile.value("children", Json::array());
  const std::string uri = tile.value("content", Json::object()).value("uri", "");
  const bool is_external = uri.ends_with(".json");
  if (!(error >= 0)) walk.report("error-negative", place.where, "a negative geometric error");
  if (!(error < place.above))
    walk.report("error-not-falling", place.where, "not less than its parent's geometric error");
  if (children.empty() && !is_external && error != 0)
    walk.report("error-leaf", place.where, "a leaf's geometric error is not 0");
  if (!place.is_refine_known && tile.value("refine", "") != "REPLACE")
    walk.report("refine", place.where, "the root does not say refine REPLACE");
  if (box.is_empty() || !(box.diagonal() > 0)) walk.report("box", place.where, "an empty box");
  const fs::path path = place.folder / decoded_uri(uri);
  place.above = error;
  if (uri.empty()) {
    walk.report("content", place.where, "a tile without content");
  } else if (!fs::exists(path)) {
    walk.report("content", place.where, "no file " + path.string());
  } else if (is_external) {
    check_external(walk, path, place);
  } else {
    check_content(walk, tile, place, path, box);
  }
  int number = 0;
  for (const Json& child : children) {
    const std::string where = place.where + "." + std::to_string(number++);
    const Box inner = moved(tile_box(child), child.value("transform", kIdentity));
    if (!is_inside(inner, box, kSlack))
      walk.report("child-outside", where, "its box reaches out of its parent's");
    check_tile(walk, child, {place.folder, where, place.transform, error, true});
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

void walk_tileset(Walk& walk, const std::string& path) {
  const Json tileset = Json::parse(slurp(path), nullptr, false);
  if (!tileset.is_object() || !tileset.contains("root")) {
    walk.report("json", path, "not a tileset");
    return;
  }
  try {
    const Json asset = tileset.at("asset");
    if (asset.at("version") != "1.1") walk.report("version", path, "asset.version is not 1.1");
    const Json extras = asset.value("extras", Json::object());
    walk.target_sse = extras.value("targetSse", 0.0);
    walk.scope.expect(extras.value("switching", Json::object()));
    const double error = tileset.at("geometricError"), root = tileset["root"].at("geometricError");
    if (error <= 0 || (tileset["root"].contains("children") && root <= 0))
      walk.report("error-zero", path, "geometric errors of 0: nothing would ever be refined");
    if (error < 2 * root)
      walk.report("error-vanishes", path,
                  "the tileset's error is too small: it vanishes from afar");
    Json unmoved = tileset["root"];
    unmoved.erase(
        "transform");  // boxes are compared about the root's frame, not the Earth's centre
    check_tile(walk, unmoved,
               {fs::path(path).parent_path(), path + " root", kIdentity,
                std::numeric_limits<double>::infinity(), false});
    check_identity(walk);
  } catch (const Json::exception& problem) {
    walk.report("json", path, problem.what());
  } catch (const Error& problem) {
    walk.report("json", path, problem.what());
  } catch (const std::logic_error& problem) {  // a broken % escape
    walk.report("json", path, problem.what());
  }
}

}  // namespace

void check_tileset(const std::string& path, std::vector<Finding>& findings) {
  Walk walk{findings, {}, 0, {}, {}};
  walk_tileset(walk, path);
  walk.scope.report(findings);
}

std::vector<Finding> check_output(const std::string& path) {
  std::vector<Finding> findings;
  if (!fs::is_directory(path)) {
    if (!fs::exists(path)) throw Error(Stage::kInput, path, "no such file");
    if (fs::path(path).extension() == ".json")
      check_tileset(path, findings);
    else
      check_glb(slurp(path), path, findings);
    return findings;
  }
  Walk walk{findings, {}, 0, {}, {}};
  const fs::path tileset = fs::path(path) / "tileset.json";
  const bool has_tileset = fs::exists(tileset);
  if (has_tileset) walk_tileset(walk, tileset.string());
  std::vector<std::string> others;
  for (const auto& entry : fs::recursive_directory_iterator(path))
    if (entry.path().extension() == ".glb" &&
        !walk.files.contains(entry.path().lexically_normal().string()))
      others.push_back(entry.path().string());
  std::sort(others.begin(), others.end());
  if (!has_tileset && others.empty())
    throw Error(Stage::kInput, path, "holds neither tileset.json nor a GLB");
  for (const std::string& file : others) {
    const GlbContent content = check_glb(slurp(file), file, findings);
    if (!content.json.is_object()) continue;
    walk.scope.expect(
        content.json.value("/asset/extras/switching"_json_pointer, Json(Json::object())));
    walk.scope.add(content.rows, file);
  }
  if (const fs::path lods = fs::path(path) / "engine" / "lods.json"; fs::exists(lods))
    check_lods(slurp(lods), lods.string(), walk.scope, findings);
  walk.scope.report(findings);
  return findings;
}

}  // namespace colod
