// Based on: Wavefront OBJ, Greg Turk's PLY.
// Differs: numbers are the shortest that read back as the same double, so that 10^6 metre
// coordinates lose nothing.
#include "obj.h"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <numbers>

namespace colod {

static_assert(std::endian::native == std::endian::little, "put() copies the host's bytes");

namespace {

template <typename T>
void print(std::string& out, T value) {
  char text[32];
  out.append(text, std::to_chars(text, text + sizeof text, value).ptr);
}

template <typename T>
void put(std::string& out, T value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <typename Ring>
void print_face(std::string& out, const Ring& ring) {
  out += 'f';
  for (const int v : ring) out += ' ', print(out, v + 1);
  out += '\n';
}

/// Readers may cut such a polygon up in any way and get the same surface; of any other, some make
/// triangles without area or across its border.
bool is_strictly_convex(const PolygonMesh& mesh, const PolygonMesh::Facet& facet) {
  constexpr double kLeastSine = 1e-3;  // of the turn at a corner
  if (facet.rings.size() != 1 || facet.rings[0].size() < 3) return false;
  const std::vector<int>& ring = facet.rings[0];
  double turned = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vec3& at = mesh.vertices[ring[i]];
    const Vec3 in = (at - mesh.vertices[ring[(i + ring.size() - 1) % ring.size()]]).normalized();
    const Vec3 out = (mesh.vertices[ring[(i + 1) % ring.size()]] - at).normalized();
    const double sine = in.cross(out).dot(facet.normal);
    if (!(sine > kLeastSine)) return false;
    turned += std::atan2(sine, in.dot(out));
  }
  return turned < 3 * std::numbers::pi;  // once round, not twice
}

std::string stem(const ExportBuilding& building, int layer) {
  return "buildings/" + building.name + ".layer" + std::to_string(layer);
}

}  // namespace

Encoded encode_obj(const ExportBuilding& building, const ExportLevel& level, int layer) {
  std::string out = "# colod: layer " + std::to_string(layer) +
                    " (0 = coarsest), metres, z up, world coordinates\n";
  out += "o " + building.name + ".layer" + std::to_string(layer) + "\n";
  for (const Vec3& p : level.mesh.vertices) {
    const Vec3 world = p + building.origin;
    out += 'v';
    for (int k = 0; k < 3; ++k) out += ' ', print(out, world[k]);
    out += '\n';
  }
  std::vector<char> is_polygon;
  for (const PolygonMesh::Facet& f : level.mesh.facets)
    is_polygon.push_back(is_strictly_convex(level.mesh, f));
  for (std::size_t f = 0; f < is_polygon.size(); ++f)
    if (is_polygon[f]) print_face(out, level.mesh.facets[f].rings[0]);
  for (std::size_t t = 0; t < level.mesh.triangles.size(); ++t)
    if (!is_polygon[level.mesh.facet_of_triangle[t]]) print_face(out, level.mesh.triangles[t]);
  return {stem(building, layer) + ".obj", out};
}

Encoded encode_ply(const ExportBuilding& building, const ExportLevel& level, int layer) {
  std::string out = "ply\nformat binary_little_endian 1.0\ncomment colod: layer " +
                    std::to_string(layer) +
                    " (0 = coarsest), metres, z up, world coordinates\nelement vertex " +
                    std::to_string(level.mesh.vertices.size()) +
                    "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
                    std::to_string(level.mesh.triangles.size()) +
                    "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vec3& p : level.mesh.vertices)
    for (int k = 0; k < 3; ++k) put(out, p[k] + building.origin[k]);
  for (const Face& f : level.mesh.triangles) {
    put(out, std::uint8_t{3});
    for (const int v : f) put(out, static_cast<std::int32_t>(v));
  }
  return {stem(building, layer) + ".ply", out};
}

}  // namespace colod
