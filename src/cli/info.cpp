#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "cli.h"
#include "core/error.h"
#include "core/parallel.h"
#include "exporters/check/check.h"
#include "exporters/check/files.h"
#include "input_options.h"
#include "log.h"
#include "measure/metrics.h"
#include "place/place.h"

namespace colod::cli {
namespace {

using Json = nlohmann::ordered_json;

struct InfoArguments {
  std::string file;
  bool is_check = false;
  ReadOptions read;
};

Json box_json(const Box& box) {
  return {{"min", {box.min.x(), box.min.y(), box.min.z()}},
          {"max", {box.max.x(), box.max.y(), box.max.z()}}};
}

Json mesh_json(const Source& s) {
  const Validity v = check_validity(s.mesh);
  return {{"type", "mesh"},
          {"vertices", s.mesh.vertices.size()},
          {"faces", s.mesh.faces.size()},
          {"box", box_json(bounding_box(s.mesh.vertices))},
          {"area", v.area},
          {"volume", v.volume},
          {"components", v.components},
          {"enclosed_components", v.enclosed_components},
          {"watertight", v.is_watertight},
          {"manifold", v.is_manifold},
          {"boundary_edges", v.boundary_edges},
          {"nonmanifold_edges", v.nonmanifold_edges},
          {"self_intersections", v.self_intersections},
          {"degenerate_faces", v.degenerate_faces}};
}

/// Where on Earth the file, or one beside it, says that it is; null: nothing does. What is wrong
/// with it joins the warnings.
Json place_json(const std::string& file, const Box& box, Json& warnings) {
  try {
    const std::optional<Georeference> place = georeference_beside(file);
    if (!place) return nullptr;
    const EarthMap earth = place_on_earth(*place, box.center());
    for (const auto& list : {place->warnings, earth.warnings})
      for (const std::string& warning : list) warnings.push_back(warning);
    return {{"crs", place->crs},
            {"name", earth.name},
            {"offset", {place->offset.x(), place->offset.y(), place->offset.z()}},
            {"said_by", place->source}};
  } catch (const Error& e) {
    warnings.push_back(e.what());
    return nullptr;
  }
}

/// Tiles below and with `root`; a tileset of any shape or depth.
Json count_tiles(const nlohmann::json& root) {
  int tiles = 0, contents = 0, deepest = 0;
  std::vector<std::pair<const nlohmann::json*, int>> open = {{&root, 1}};
  while (!open.empty()) {
    const auto [tile, depth] = open.back();
    open.pop_back();
    ++tiles;
    contents += tile->contains("content");
    deepest = std::max(deepest, depth);
    if (const auto children = tile->find("children"); children != tile->end())
      for (const nlohmann::json& child : *children) open.emplace_back(&child, depth + 1);
  }
  return {
      {"type", "3D Tiles tileset"}, {"tiles", tiles}, {"contents", contents}, {"depth", deepest}};
}

Json tileset_json(const std::string& path) {
  const nlohmann::json tileset = parse_json(read_regular(path));
  const auto root = tileset.is_object() ? tileset.find("root") : tileset.end();
  if (root == tileset.end() || !root->is_object())
    throw Error(Stage::kInput, path,
                "not a tileset: no root tile in at most " + std::to_string(kDeepestJson) +
                    " nested levels of JSON");
  Json json = count_tiles(*root);
  json["asset"] = tileset.value("asset", nlohmann::json());
  json["geometricError"] = tileset.value("geometricError", nlohmann::json());
  return json;
}

/// The faults as JSON; exit code 1 when there is one.
int check(const std::string& path) {
  const std::vector<Finding> findings = check_output(path);
  Json list = Json::array();
  for (const Finding& f : findings)
    list.push_back({{"code", f.code}, {"where", f.where}, {"message", f.message}});
  const Json json = {{"file", path}, {"faults", list.size()}, {"findings", list}};
  print_answer(json.dump(2, ' ', false, Json::error_handler_t::replace));
  return findings.empty() ? 0 : 1;
}

int info(const InfoArguments& a) {
  if (a.is_check) return check(a.file);
  std::string file = a.file;
  if (std::filesystem::is_directory(file))
    file = (std::filesystem::path(file) / "tileset.json").string();
  if (!std::filesystem::exists(file)) throw Error(Stage::kInput, a.file, "no such file");
  Json json;
  if (std::filesystem::path(file).extension() == ".json") {
    json = tileset_json(file);
  } else {
    const Source source = read_single(file, a.read);
    json = source.is_mesh() ? mesh_json(source)
                            : Json{{"type", "points"},
                                   {"points", source.cloud.points.size()},
                                   {"normals", !source.cloud.normals.empty()},
                                   {"box", box_json(bounding_box(source.cloud.points))}};
    json["warnings"] = source.warnings;
    json["place"] = place_json(
        file, bounding_box(source.is_mesh() ? source.mesh.vertices : source.cloud.points),
        json["warnings"]);
  }
  json["file"] = file;
  print_answer(json.dump(2, ' ', false, Json::error_handler_t::replace));
  return 0;
}

}  // namespace

Run add_info(CLI::App& app) {
  auto a = std::make_shared<InfoArguments>();
  app.add_option("FILE", a->file,
                 "mesh, points, GLB, tileset.json or a folder that colod build wrote")
      ->required();
  app.add_flag("--check", a->is_check,
               "check a GLB, a tileset or a folder that colod build wrote; exit code 1 on a fault");
  add_input_options(app, a->read);
  return [a] { return info(*a); };
}

}  // namespace colod::cli
