#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "../error.h"
#include "../metrics.h"
#include "../parallel.h"
#include "cli.h"
#include "input_options.h"

namespace colod::cli {
namespace {

using Json = nlohmann::ordered_json;

struct InfoArguments {
  std::string file;
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
          {"watertight", v.is_watertight},
          {"manifold", v.is_manifold},
          {"boundary_edges", v.boundary_edges},
          {"nonmanifold_edges", v.nonmanifold_edges},
          {"self_intersections", v.self_intersections},
          {"degenerate_faces", v.degenerate_faces}};
}

Json tile_json(const nlohmann::json& tile, int depth, Json& totals) {
  totals["tiles"] = totals["tiles"].get<int>() + 1;
  totals["depth"] = std::max(totals["depth"].get<int>(), depth);
  if (tile.contains("content")) totals["contents"] = totals["contents"].get<int>() + 1;
  for (const auto& child : tile.value("children", nlohmann::json::array()))
    tile_json(child, depth + 1, totals);
  return totals;
}

Json tileset_json(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  nlohmann::json tileset = nlohmann::json::parse(in, nullptr, false);
  if (tileset.is_discarded() || !tileset.contains("root"))
    throw Error(Stage::kInput, path, "not a tileset: no root tile");
  Json totals{{"type", "3D Tiles tileset"}, {"tiles", 0}, {"contents", 0}, {"depth", 0}};
  totals["asset"] = tileset["asset"];
  totals["geometricError"] = tileset.value("geometricError", 0.0);
  return tile_json(tileset["root"], 1, totals);
}

int info(const InfoArguments& a) {
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
  }
  json["file"] = file;
  std::printf("%s\n", json.dump(2).c_str());
  return 0;
}

}  // namespace

Run add_info(CLI::App& app) {
  auto a = std::make_shared<InfoArguments>();
  app.add_option("FILE", a->file,
                 "mesh, points, GLB, tileset.json or a folder that colod build wrote")
      ->required();
  add_input_options(app, a->read);
  return [a] { return info(*a); };
}

}  // namespace colod::cli
