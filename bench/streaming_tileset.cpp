// Based on: 3D Tiles 1.1; what CesiumJS and 3DTilesRendererJS do with errors, boxes and frustums.
// Differs: everything is loaded at once, as if the viewer waited at every stop.
#include "streaming_tileset.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/error.h"
#include "exporters/check/check.h"

namespace colod::bench {

using Json = nlohmann::json;
namespace fs = std::filesystem;

namespace {

constexpr double kRise = 1.01;       // a parent's error is at least this times its children's
constexpr double kSameError = 1.02;  // and that much it may be of one that switches with it
constexpr double kPixelsBefore = 2;  // that the largest distance to the source could cover

std::string slurp(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw Error(Stage::kInput, path.string(), "cannot be read");
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

Box tile_box(const Json& tile) {
  const auto b = tile.at("boundingVolume").at("box").get<std::vector<double>>();
  Box box;
  for (int c = 0; c < 8; ++c)
    box.extend(Vec3(b.at(0), b.at(1), b.at(2)) +
               (c & 1 ? 1 : -1) * Vec3(b.at(3), b.at(4), b.at(5)) +
               (c & 2 ? 1 : -1) * Vec3(b.at(6), b.at(7), b.at(8)) +
               (c & 4 ? 1 : -1) * Vec3(b.at(9), b.at(10), b.at(11)));
  return box;
}

class Reader {
 public:
  explicit Reader(const fs::path& path) : folder_(path.parent_path()) {
    out_.frames.push_back(Eigen::Affine3d::Identity());
    Json tileset = Json::parse(slurp(path));
    const Json extras = tileset.at("asset").value("extras", Json::object());
    out_.limit = extras.value("targetSse", out_.limit);
    out_.bound = extras.value("/switching/visualError"_json_pointer, out_.bound);
    if (extras.contains("offset"))
      for (int k = 0; k < 3; ++k) out_.offset[k] = extras["offset"].at(k);
    tileset.at("root").erase("transform");
    add_tile(tileset["root"], "", 0, -1);
    for (std::size_t i = out_.tiles.size(); i-- > 0;) gather_buildings(out_.tiles[i]);
  }

  Tileset take() { return std::move(out_); }

 private:
  int add_tile(const Json& json, const fs::path& below, std::size_t frame, int above) {
    const int self = static_cast<int>(out_.tiles.size());
    Tile tile;
    tile.above = above;
    tile.frame = frame;
    if (json.contains("transform")) {
      const auto t = json["transform"].get<std::array<double, 16>>();
      Eigen::Affine3d to_frame;
      to_frame.matrix() = Eigen::Map<const Eigen::Matrix4d>(t.data());
      tile.frame = out_.frames.size();
      out_.frames.push_back(out_.frames[frame] * to_frame);
    }
    tile.box = tile_box(json);
    tile.error = json.at("geometricError");
    const fs::path content = below / decoded_uri(json.at("content").at("uri"));
    tile.uri = content.generic_string();
    tile.is_external = content.extension() == ".json";
    const std::string bytes = slurp(folder_ / content);
    tile.bytes = bytes.size();
    if (!tile.is_external) read_content(tile, bytes, !json.contains("children"));
    const std::size_t inner = tile.frame;
    const int drawable = tile.is_external ? above : self;
    out_.tiles.push_back(std::move(tile));
    const auto add_child = [&](const Json& child, const fs::path& place) {
      const int index = add_tile(child, place, inner, drawable);
      out_.tiles[self].children.push_back(index);
    };
    if (out_.tiles[self].is_external)
      add_child(Json::parse(bytes).at("root"), content.parent_path());
    for (const Json& child : json.value("children", Json::array())) add_child(child, below);
    return self;
  }

  void read_content(Tile& tile, const std::string& bytes, bool is_finest) {
    std::vector<Finding> findings;
    const GlbContent content = check_glb(bytes, tile.uri, findings);
    for (const Finding& f : findings)
      out_.findings.push_back(f.where + ": " + f.code + ", " + f.message);
    if (content.meshes.size() != 1 || content.meshes[0].faces.empty() || content.has_transforms)
      throw Error(Stage::kInput, tile.uri, "not one mesh in the tile's own frame");
    for (const GlbContent::Row& row : content.rows)
      tile.parts.push_back({row.name, row.coarsest_layer, row.layer});
    const GlbContent::MeshContent& mesh = content.meshes[0];
    tile.mesh.faces = mesh.faces;
    for (const Vec3& p : mesh.positions) tile.mesh.vertices.push_back(out_.frames[tile.frame] * p);
    for (const Part& part : tile.parts)
      if (part.layer >= 0) tile.buildings.push_back(index_of(part.name));
    if (!is_finest) return;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
      out_.buildings[index_of(tile.parts.at(mesh.features.at(v)).name)].box.extend(
          tile.mesh.vertices[v]);
  }

  int index_of(const std::string& building) {
    const auto [found, is_new] = index_.emplace(building, out_.buildings.size());
    if (is_new) out_.buildings.push_back({building, {}});
    return static_cast<int>(found->second);
  }

  void gather_buildings(Tile& tile) const {
    std::vector<int>& all = tile.buildings;
    for (const int c : tile.children)
      all.insert(all.end(), out_.tiles[c].buildings.begin(), out_.tiles[c].buildings.end());
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
  }

  fs::path folder_;
  Tileset out_;
  std::map<std::string, std::size_t> index_;
};

/// Per building and layer, never less than a finer layer's.
std::map<std::string, std::map<int, double>> read_hausdorff(const std::string& report) {
  std::map<std::string, std::map<int, double>> out;
  const Json json = Json::parse(slurp(report));
  for (const Json& building : json.at("buildings")) {
    std::map<int, double>& of_layer = out[building.at("name")];
    for (const Json& layer : building.at("layers"))
      if (layer.contains("hausdorff")) of_layer[layer.at("layer")] = layer["hausdorff"];
    double least = 0;
    for (auto layer = of_layer.rbegin(); layer != of_layer.rend(); ++layer)
      least = layer->second = std::max(least, layer->second);
  }
  return out;
}

/// Whether the tile shows one building as the tile above does.
bool is_repeated(const Tileset& tileset, const Tile& tile) {
  if (tile.parts.size() != 1 || tile.above < 0) return false;
  const std::vector<Part>& above = tileset.tiles[tile.above].parts;
  return std::any_of(above.begin(), above.end(), [&](const Part& p) {
    return p.layer >= 0 && p.name == tile.parts[0].name && p.layer == tile.parts[0].layer;
  });
}

/// Whether no plane of the view has the whole box on its outer side.
bool is_in_view(const Tileset& tileset, const Tile& tile, const Camera& camera) {
  std::array<bool, 5> is_inside{};
  for (int c = 0; c < 8; ++c) {
    const Vec3 corner(c & 1 ? tile.box.max.x() : tile.box.min.x(),
                      c & 2 ? tile.box.max.y() : tile.box.min.y(),
                      c & 4 ? tile.box.max.z() : tile.box.min.z());
    const Vec3 p = tileset.frames[tile.frame] * corner - camera.eye;
    const double ahead = p.dot(camera.forward), x = p.dot(camera.right), y = p.dot(camera.up);
    is_inside[0] |= ahead > 0;
    is_inside[1] |= x < ahead * camera.tan_x;
    is_inside[2] |= -x < ahead * camera.tan_x;
    is_inside[3] |= y < ahead * camera.tan_y;
    is_inside[4] |= -y < ahead * camera.tan_y;
  }
  return std::all_of(is_inside.begin(), is_inside.end(), [](bool inside) { return inside; });
}

double distance_to_box(const Box& box, const Vec3& p) {
  return (box.min - p).cwiseMax(p - box.max).cwiseMax(0.0).norm();
}

}  // namespace

Tileset read_tileset(const std::string& path) {
  try {
    return Reader(path).take();
  } catch (const Json::exception& problem) {
    throw Error(Stage::kInput, path, problem.what());
  } catch (const std::logic_error& problem) {  // a broken % escape, a column that is too short
    throw Error(Stage::kInput, path, problem.what());
  }
}

void apply_rule_before(Tileset& tileset, const std::string& report) {
  const auto hausdorff = read_hausdorff(report);
  for (std::size_t i = tileset.tiles.size(); i-- > 0;) {
    Tile& tile = tileset.tiles[i];
    if (tile.children.empty()) continue;
    double error = 0;
    for (const Part& part : tile.parts)
      error = std::max(error, part.layer < 0 ? tile.error
                                             : tileset.limit / kPixelsBefore *
                                                   hausdorff.at(part.name).at(part.layer));
    for (const int c : tile.children) error = std::max(error, kRise * tileset.tiles[c].error);
    tile.error = error;
  }
  for (Tile& tile : tileset.tiles)
    if (!tile.children.empty() && is_repeated(tileset, tile))
      tile.error = tileset.tiles[tile.above].error / kRise;
}

Camera camera_at(const Stop& stop, double fovy_deg, double aspect) {
  Camera camera;
  camera.eye = stop.eye;
  camera.forward = (stop.target - stop.eye).normalized();
  camera.right = camera.forward.cross(Vec3::UnitZ()).normalized();
  camera.up = camera.right.cross(camera.forward);
  camera.tan_y = std::tan(0.5 * fovy_deg * std::numbers::pi / 180);
  camera.tan_x = camera.tan_y * aspect;
  return camera;
}

double distance_to(const Tileset& tileset, const Tile& tile, const Vec3& eye) {
  return distance_to_box(tile.box, tileset.frames[tile.frame].inverse() * eye);
}

Selection select_tiles(const Tileset& tileset, const Camera& camera, int lines, double limit) {
  Selection out;
  std::vector<int> open = {0};
  out.loaded.push_back(0);
  while (!open.empty()) {
    const int index = open.back();
    open.pop_back();
    const Tile& tile = tileset.tiles[index];
    if (!is_in_view(tileset, tile, camera)) continue;
    const double pixel = 2 * camera.tan_y * distance_to(tileset, tile, camera.eye) / lines;
    if (!tile.is_external && (tile.children.empty() || tile.error <= limit * pixel)) {
      out.drawn.push_back(index);
      continue;
    }
    open.insert(open.end(), tile.children.begin(), tile.children.end());
    out.loaded.insert(out.loaded.end(), tile.children.begin(), tile.children.end());
  }
  std::sort(out.drawn.begin(), out.drawn.end());
  std::sort(out.loaded.begin(), out.loaded.end());
  return out;
}

bool is_beside_view(const Tileset& tileset, const Tile& tile, const Camera& camera) {
  if (tile.children.empty()) return !is_in_view(tileset, tile, camera);
  return std::all_of(tile.children.begin(), tile.children.end(), [&](int child) {
    return is_beside_view(tileset, tileset.tiles[child], camera);
  });
}

std::vector<Shown> shown_by(const Tileset& tileset, int tile, const std::vector<Part>& parts,
                            const Vec3& eye) {
  const Tile& shown = tileset.tiles[tile];
  Shown level{.error = shown.error};
  if (shown.above >= 0) {
    level.decided_at = distance_to(tileset, tileset.tiles[shown.above], eye);
    level.decided_error = tileset.tiles[shown.above].error;
  }
  std::vector<Shown> out;
  for (const int b : shown.buildings) {
    const Place& place = tileset.buildings[b];
    const auto part = std::find_if(parts.begin(), parts.end(), [&](const Part& p) {
      return p.layer >= 0 && p.name == place.name;
    });
    const Part of = part == parts.end() ? Part{} : *part;
    level.building = b;
    level.coarsest_layer = of.coarsest_layer;
    level.layer = of.layer;
    level.distance = distance_to_box(place.box, eye);
    out.push_back(level);
  }
  return out;
}

Disorder find_disorder(const Tileset& tileset, const std::vector<Shown>& shown) {
  const auto said = [&](const Shown& s) {
    return tileset.buildings[s.building].name + " shows layer " + std::to_string(s.layer) + " at " +
           std::to_string(std::lround(s.distance)) + " m";
  };
  Disorder out;
  double nearest = std::numeric_limits<double>::infinity();
  for (const Shown& near : shown) {
    if (near.error == 0) continue;  // nothing finer is there
    const Shown* beyond = nullptr;  // what boxes do not explain
    bool is_disordered = false;
    for (const Shown& far : shown) {
      if (near.layer >= far.coarsest_layer || near.distance >= far.distance) continue;
      is_disordered = true;
      if (near.distance < far.decided_at || far.decided_error > kSameError * near.error)
        beyond = &far;
    }
    if (!beyond) {
      out.tolerated += is_disordered;
      continue;
    }
    ++(near.layer < 0 ? out.stand_ins : out.layers);
    if (near.layer < 0 || near.distance >= nearest) continue;
    nearest = near.distance;
    out.worst = said(near) + ", " + said(*beyond);
  }
  return out;
}

}  // namespace colod::bench
