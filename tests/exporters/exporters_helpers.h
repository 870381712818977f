// Small polygon meshes, and a reader of GLBs that shares no line with the writer.
#pragma once

#include <draco/compression/decode.h>

#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "exporters/exporter.h"
#include "meshes.h"

namespace colod::test {

/// Triangles of one plane become one facet with its rings; planes must differ clearly.
inline PolygonMesh as_polygons(const Mesh& m) {
  PolygonMesh out;
  out.vertices = m.vertices;
  std::map<std::array<long, 4>, int> facet_of_plane;
  std::vector<std::map<int, int>> next;  // per facet: border edge start → end
  for (const Face& f : m.faces) {
    const Vec3 n = face_cross(m, f).normalized();
    const double d = n.dot(m.vertices[f[0]]);
    const std::array<long, 4> key = {std::lround(n.x() * 1e5), std::lround(n.y() * 1e5),
                                     std::lround(n.z() * 1e5), std::lround(d * 1e3)};
    const auto [it, is_new] = facet_of_plane.emplace(key, static_cast<int>(out.facets.size()));
    if (is_new) out.facets.push_back({n, it->second, {}}), next.emplace_back();
    out.triangles.push_back(f);
    out.facet_of_triangle.push_back(it->second);
    for (int c = 0; c < 3; ++c) {
      auto& edges = next[it->second];
      const int a = f[c], b = f[(c + 1) % 3];
      const auto back = edges.find(b);
      if (back != edges.end() && back->second == a)
        edges.erase(back);
      else
        edges[a] = b;
    }
  }
  for (std::size_t f = 0; f < out.facets.size(); ++f)
    while (!next[f].empty()) {
      std::vector<int> ring;
      for (int v = next[f].begin()->first; next[f].count(v);) {
        ring.push_back(v);
        const int w = next[f][v];
        next[f].erase(v);
        v = w;
      }
      out.facets[f].rings.push_back(ring);
    }
  return out;
}

/// A house in three levels: box, gable, gable with a chimney beside it (all closed).
inline ExportBuilding three_layers(const std::string& name, const Vec3& origin) {
  const Mesh gable = gable_house(12.3, 8.1, 5.7, 3.3);
  const Mesh chimney = box_mesh({2.1, 2.2, 7.5}, {2.9, 3.1, 10.4});
  return {name,
          name + ".obj",
          origin,
          {{{0}, as_polygons(box_mesh({0, 0, 0}, {12.3, 8.1, 7.1})), 0.6, 3.3},
           {{1}, as_polygons(gable), 0.3, 2.25},
           {{2}, as_polygons(join(gable, chimney)), 0, 0}},
          ""};
}

struct Glb {
  nlohmann::json json;
  std::string binary;
};

inline std::uint32_t u32(const std::string& bytes, std::size_t at) {
  std::uint32_t value;
  std::memcpy(&value, bytes.data() + at, 4);
  return value;
}

inline Glb parse_glb(const std::string& bytes) {
  if (bytes.substr(0, 4) != "glTF" || u32(bytes, 4) != 2 || u32(bytes, 8) != bytes.size() ||
      bytes.size() % 4 != 0)
    throw std::runtime_error("GLB header");
  const std::uint32_t length = u32(bytes, 12);
  if (bytes.substr(16, 4) != "JSON" || length % 4 != 0) throw std::runtime_error("JSON chunk");
  const std::size_t bin = 20 + length;
  if (bytes.substr(bin + 4, 4) != std::string("BIN\0", 4) ||
      bin + 8 + u32(bytes, bin) != bytes.size())
    throw std::runtime_error("BIN chunk");
  return {nlohmann::json::parse(bytes.substr(20, length)), bytes.substr(bin + 8)};
}

/// One primitive decoded: glTF axes, a value per vertex.
struct Decoded {
  Mesh mesh;
  std::vector<Vec3> normals;
  std::vector<std::uint32_t> features;
};

inline Decoded decode_mesh(const Glb& glb, int mesh) {
  const auto& primitive = glb.json["meshes"][mesh]["primitives"][0];
  const auto& extension = primitive["extensions"]["KHR_draco_mesh_compression"];
  const auto& view = glb.json["bufferViews"][extension["bufferView"].get<int>()];
  draco::DecoderBuffer buffer;
  buffer.Init(glb.binary.data() + view["byteOffset"].get<std::size_t>(),
              view["byteLength"].get<std::size_t>());
  draco::Decoder decoder;
  const auto result = decoder.DecodeMeshFromBuffer(&buffer);
  if (!result.ok()) throw std::runtime_error("Draco");
  const draco::Mesh& m = *result.value();
  const auto attribute = [&](const char* name) {
    return m.GetAttributeByUniqueId(extension["attributes"][name].get<std::uint32_t>());
  };
  Decoded out;
  for (draco::PointIndex p(0); p < m.num_points(); ++p) {
    float v[3], n[3];
    attribute("POSITION")->GetMappedValue(p, v);
    attribute("NORMAL")->GetMappedValue(p, n);
    out.mesh.vertices.emplace_back(v[0], v[1], v[2]);
    out.normals.emplace_back(n[0], n[1], n[2]);
    if (!extension["attributes"].contains("_FEATURE_ID_0")) continue;
    std::uint16_t id;
    attribute("_FEATURE_ID_0")->GetMappedValue(p, &id);
    out.features.push_back(id);
  }
  for (draco::FaceIndex f(0); f < m.num_faces(); ++f)
    out.mesh.faces.push_back({static_cast<int>(m.face(f)[0].value()),
                              static_cast<int>(m.face(f)[1].value()),
                              static_cast<int>(m.face(f)[2].value())});
  return out;
}

/// Building i of a street at 10^6 metres; some have fewer levels.
inline std::vector<ExportBuilding> street(int n) {
  std::vector<ExportBuilding> buildings;
  for (int i = 0; i < n; ++i) {
    buildings.push_back(
        three_layers("b" + std::to_string(i),
                     Vec3(691234.567, 5334567.891, 512.345) + Vec3(20 * (i % 7), 15 * (i / 7), 0)));
    if (i % 5 != 3) continue;
    buildings.back().levels.resize(1 + i % 2);
    buildings.back().levels.back().gsd = buildings.back().levels.back().deviation = 0;
  }
  return buildings;
}

inline const Encoded& find(const std::vector<Encoded>& files, const std::string& path) {
  for (const Encoded& f : files)
    if (f.path == path) return f;
  throw std::runtime_error("no file " + path);
}

/// Box of a tile in its JSON.
inline Box box_of(const nlohmann::json& tile) {
  const std::vector<double> b = tile["boundingVolume"]["box"];
  Box box;
  box.min = Vec3(b[0] - b[3], b[1] - b[7], b[2] - b[11]);
  box.max = Vec3(b[0] + b[3], b[1] + b[7], b[2] + b[11]);
  return box;
}

/// Every edge once in each direction after equal positions became one.
inline bool is_watertight(const Mesh& m) {
  std::map<std::array<double, 3>, int> number;
  std::set<std::pair<int, int>> edges;
  std::vector<int> welded;
  for (const Vec3& p : m.vertices)
    welded.push_back(number.emplace(std::array{p.x(), p.y(), p.z()}, number.size()).first->second);
  for (const Face& f : m.faces)
    for (int c = 0; c < 3; ++c)
      if (!edges.emplace(welded[f[c]], welded[f[(c + 1) % 3]]).second) return false;
  for (const auto& [a, b] : edges)
    if (!edges.contains({b, a})) return false;
  return !edges.empty();
}

}  // namespace colod::test
