// *Based on:* Wavefront OBJ; glTF 2.0; 3D Tiles 1.0; RFC 7946.
//
// *Differs:* footprints are in the scene's own metres, as it lies nowhere on Earth.
//
// *Notation:* none.
#include "scene_files.h"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/bytes.h"

namespace colod {
namespace {

using nlohmann::ordered_json;

constexpr int kQualityOfTiles = 85;  // of JPEGs

void pad(std::string& bytes, std::size_t to, char with) {
  while (bytes.size() % to != 0) bytes += with;
}

/// Corner by corner, as charts share no texture coordinates.
struct Streams {
  std::string positions, uvs;
  Box box;
  std::size_t count = 0;
};

Streams streams_of(const SynthTile& tile, const Vec3& center) {
  Streams out;
  for (std::size_t f = 0; f < tile.mesh.faces.size(); ++f)
    for (int k = 0; k < 3; ++k) {
      const Vec3 p = tile.mesh.vertices[tile.mesh.faces[f][k]] - center;
      const std::array<float, 3> at = {static_cast<float>(p.x()), static_cast<float>(p.z()),
                                       static_cast<float>(-p.y())};
      out.box.extend(Vec3(at[0], at[1], at[2]));
      for (const float v : at) put(out.positions, v);
      put(out.uvs, tile.uvs[f][k].x());
      put(out.uvs, tile.uvs[f][k].y());
      ++out.count;
    }
  return out;
}

ordered_json numbers(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

std::string tile_glb(const SynthTile& tile) {
  const Vec3 center = bounding_box(tile.mesh.vertices).center();
  Streams s = streams_of(tile, center);
  std::string image = tile_jpeg(tile);
  const std::size_t image_size = image.size();
  pad(image, 4, '\0');
  const std::size_t a = s.positions.size(), b = s.uvs.size();
  ordered_json root;
  root["asset"] = {{"version", "2.0"}, {"generator", "colod synth"}};
  root["extensionsUsed"] = {"KHR_materials_unlit"};
  root["scene"] = 0;
  root["scenes"] = {{{"nodes", {0}}}};
  root["nodes"] = {{{"mesh", 0}, {"translation", {center.x(), center.z(), -center.y()}}}};
  root["meshes"] = {
      {{"primitives", {{{"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 1}}}, {"material", 0}}}}}};
  root["materials"] = {
      {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}, {"metallicFactor", 0.0}}},
       {"extensions", {{"KHR_materials_unlit", ordered_json::object()}}}}};
  root["textures"] = {{{"source", 0}, {"sampler", 0}}};
  root["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33071}}};
  root["images"] = {{{"bufferView", 2}, {"mimeType", "image/jpeg"}}};
  root["accessors"] = {
      {{"bufferView", 0},
       {"componentType", 5126},
       {"count", s.count},
       {"type", "VEC3"},
       {"min", numbers(s.box.min)},
       {"max", numbers(s.box.max)}},
      {{"bufferView", 1}, {"componentType", 5126}, {"count", s.count}, {"type", "VEC2"}}};
  root["bufferViews"] = {{{"buffer", 0}, {"byteOffset", 0}, {"byteLength", a}},
                         {{"buffer", 0}, {"byteOffset", a}, {"byteLength", b}},
                         {{"buffer", 0}, {"byteOffset", a + b}, {"byteLength", image_size}}};
  root["buffers"] = {{{"byteLength", a + b + image.size()}}};
  std::string json = root.dump();
  pad(json, 4, ' ');
  std::string out = "glTF";
  put(out, std::uint32_t{2});
  put(out, static_cast<std::uint32_t>(28 + json.size() + a + b + image.size()));
  put(out, static_cast<std::uint32_t>(json.size()));
  out += "JSON" + json;
  put(out, static_cast<std::uint32_t>(a + b + image.size()));
  out += std::string("BIN\0", 4) + s.positions + s.uvs + image;
  return out;
}

ordered_json bounding_volume(const Box& box) {
  const Vec3 c = box.center(), h = box.size() / 2;
  return {{"box", {c.x(), c.y(), c.z(), h.x(), 0, 0, 0, h.y(), 0, 0, 0, h.z()}}};
}

double round_to_millimetre(double x) { return std::round(x * 1e3) / 1e3; }

ordered_json closed_ring(const std::vector<Vec2>& ring) {
  ordered_json out = ordered_json::array();
  for (std::size_t i = 0; i <= ring.size(); ++i) {
    const Vec2& p = ring[i % ring.size()];
    out.push_back({round_to_millimetre(p.x()), round_to_millimetre(p.y())});
  }
  return out;
}

}  // namespace

std::string tile_obj(const SynthTile& tile, const std::string& material, ObjCount& count) {
  std::string text = "usemtl " + material + "\n";
  char line[160];
  for (const Vec3& v : tile.mesh.vertices) {
    std::snprintf(line, sizeof line, "v %.3f %.3f %.3f\n", v.x(), v.y(), v.z());
    text += line;
  }
  for (const auto& face : tile.uvs)
    for (const Vec2f& uv : face) {
      std::snprintf(line, sizeof line, "vt %.6f %.6f\n", uv.x(), 1 - uv.y());
      text += line;
    }
  for (std::size_t f = 0; f < tile.mesh.faces.size(); ++f) {
    const Face& c = tile.mesh.faces[f];
    const std::size_t uv = count.coordinates + 3 * f + 1;
    std::snprintf(line, sizeof line, "f %zu/%zu %zu/%zu %zu/%zu\n", count.vertices + c[0] + 1, uv,
                  count.vertices + c[1] + 1, uv + 1, count.vertices + c[2] + 1, uv + 2);
    text += line;
  }
  count.vertices += tile.mesh.vertices.size();
  count.coordinates += 3 * tile.mesh.faces.size();
  return text;
}

std::string tile_mtl(const std::string& material, const std::string& image) {
  return "newmtl " + material + "\nKa 1 1 1\nKd 1 1 1\nd 1\nillum 0\nmap_Kd " + image + "\n";
}

std::string tile_jpeg(const SynthTile& tile) {
  return encode_image(tile.picture, ImageFormat::kJpeg, kQualityOfTiles);
}

std::string tile_b3dm(const SynthTile& tile) {
  const std::string table = "{\"BATCH_LENGTH\":0}  ";  // the GLB begins at a multiple of 8
  std::string glb = tile_glb(tile);
  pad(glb, 8, '\0');
  std::string out = "b3dm";
  put(out, std::uint32_t{1});
  put(out, static_cast<std::uint32_t>(28 + table.size() + glb.size()));
  put(out, static_cast<std::uint32_t>(table.size()));
  for (int i = 0; i < 3; ++i) put(out, std::uint32_t{0});
  return out + table + glb;
}

std::string las_header(std::size_t count, const Box& box) {
  constexpr std::uint16_t kHeader = 227, kPoint = 20;
  std::string out = "LASF";
  out.resize(24, '\0');
  out += {1, 2};
  std::string system = "colod synth";
  system.resize(64, '\0');
  out += system;
  put(out, std::uint16_t{1}), put(out, std::uint16_t{2026});
  put(out, kHeader);
  put(out, std::uint32_t{kHeader}), put(out, std::uint32_t{0});
  put(out, std::uint8_t{0}), put(out, kPoint);
  put(out, static_cast<std::uint32_t>(count)), put(out, static_cast<std::uint32_t>(count));
  out.resize(131, '\0');
  for (int k = 0; k < 3; ++k) put(out, 0.001);
  for (int k = 0; k < 3; ++k) put(out, 0.0);
  for (int k = 0; k < 3; ++k) put(out, box.max[k]), put(out, box.min[k]);
  return out;
}

std::string las_points(const std::vector<SynthPoint>& points) {
  std::string out;
  for (const SynthPoint& p : points) {
    for (int k = 0; k < 3; ++k) put(out, static_cast<std::int32_t>(std::lround(1000 * p.at[k])));
    put(out, std::uint16_t{0});
    put(out, std::uint8_t{9});  // first of one return
    put(out, static_cast<std::uint8_t>(p.kind));
    put(out, std::uint32_t{0});
  }
  return out;
}

std::string tileset_json(const std::vector<std::string>& names, const std::vector<Box>& boxes) {
  Box all;
  ordered_json children = ordered_json::array();
  for (std::size_t i = 0; i < names.size(); ++i) {
    all.extend(boxes[i]);
    children.push_back({{"boundingVolume", bounding_volume(boxes[i])},
                        {"geometricError", 0},
                        {"content", {{"uri", "Tiles/" + names[i] + ".b3dm"}}}});
  }
  ordered_json root;
  root["asset"] = {{"version", "1.0"}};
  root["geometricError"] = 500;
  root["root"] = {{"boundingVolume", bounding_volume(all)},
                  {"geometricError", 500},
                  {"refine", "ADD"},
                  {"children", children}};
  return root.dump(1) + "\n";
}

std::string scene_truth_json(const SynthScene& scene, const SynthSceneOptions& options,
                             const std::vector<std::string>& tiles,
                             const std::vector<Vec2>& corners) {
  ordered_json root;
  root["options"] = {{"buildings", options.buildings},
                     {"seed", options.seed},
                     {"edge", options.edge},
                     {"texel", options.texel}};
  root["classes"] = {{"ground", 1}, {"building", 2}, {"plant", 3}, {"rest", 4}};
  root["cell"] = scene.truth_cell();
  root["tiles"] = ordered_json::array();
  for (std::size_t i = 0; i < tiles.size(); ++i)
    root["tiles"].push_back({{"name", tiles[i]}, {"corner", {corners[i].x(), corners[i].y()}}});
  return root.dump(1) + "\n";
}

std::string scene_footprints(const SynthScene& scene,
                             const std::vector<SynthSceneBuilding>& buildings) {
  ordered_json root;
  root["type"] = "FeatureCollection";
  root["frame"] = "the scene's metres";
  const Box box = scene.box();
  const Vec2 low = box.min.head<2>(), high = box.max.head<2>();
  root["area"] = {
      {"type", "Polygon"},
      {"coordinates", {closed_ring({low, {high.x(), low.y()}, high, {low.x(), high.y()}})}}};
  root["features"] = ordered_json::array();
  for (const SynthSceneBuilding& b : buildings) {
    ordered_json rings = ordered_json::array();
    for (const auto& ring : b.rings) rings.push_back(closed_ring(ring));
    root["features"].push_back({{"type", "Feature"},
                                {"properties",
                                 {{"id", b.id},
                                  {"kind", b.kind},
                                  {"in_row", b.row != 0},
                                  {"height_m", std::round(100 * b.height) / 100}}},
                                {"geometry", {{"type", "Polygon"}, {"coordinates", rings}}}});
  }
  return root.dump() + "\n";
}

}  // namespace colod
