// Based on: Wavefront OBJ, Greg Turk's PLY.
// Differs: numbers are the shortest that read back as the same double, so that 10^6 metre
// coordinates lose nothing.
#include "obj.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>

#include "core/bytes.h"

namespace colod {
namespace {

template <typename T>
void print(std::string& out, T value) {
  char text[32];
  out.append(text, std::to_chars(text, text + sizeof text, value).ptr);
}

/// Numbers of a look's texture coordinates: one a vertex of a facet.
class Coordinates {
 public:
  Coordinates(const ExportLevel& level, std::string& out) {
    if (!level.look.has_texture()) return;
    for (std::size_t t = 0; t < level.mesh.triangles.size(); ++t)
      for (std::size_t c = 0; c < 3; ++c) {
        const auto [it, is_new] =
            numbers_.emplace(std::pair(level.mesh.facet_of_triangle[t], level.mesh.triangles[t][c]),
                             static_cast<int>(numbers_.size()) + 1);
        if (!is_new) continue;
        const Vec2f& uv = level.look.uvs[t][c];
        out += "vt ", print(out, uv.x()), out += ' ', print(out, 1 - uv.y()), out += '\n';
      }
  }

  bool is_empty() const { return numbers_.empty(); }
  /// Whether all corners of a facet's ring are corners of its triangles too.
  bool has(int facet, const std::vector<int>& ring) const {
    return numbers_.empty() || std::all_of(ring.begin(), ring.end(), [&](int v) {
             return numbers_.contains({facet, v});
           });
  }
  int number(int facet, int vertex) const { return numbers_.at({facet, vertex}); }

 private:
  std::map<std::pair<int, int>, int> numbers_;
};

template <typename Ring>
void print_face(std::string& out, const Ring& ring, int facet, const Coordinates& coordinates) {
  out += 'f';
  for (const int v : ring) {
    out += ' ', print(out, v + 1);
    if (!coordinates.is_empty()) out += '/', print(out, coordinates.number(facet, v));
  }
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
  const std::string name = building.name + ".layer" + std::to_string(layer);
  if (level.look.has_texture()) out += "mtllib " + name + ".mtl\n";
  out += "o " + name + "\n";
  for (const Vec3& p : level.mesh.vertices) {
    const Vec3 world = p + building.origin;
    out += 'v';
    for (int k = 0; k < 3; ++k) out += ' ', print(out, world[k]);
    out += '\n';
  }
  const Coordinates coordinates(level, out);
  if (level.look.has_texture()) out += "usemtl texture\n";
  std::vector<char> is_polygon;
  for (const PolygonMesh::Facet& f : level.mesh.facets)
    is_polygon.push_back(is_strictly_convex(level.mesh, f) &&
                         coordinates.has(static_cast<int>(is_polygon.size()), f.rings[0]));
  for (std::size_t f = 0; f < is_polygon.size(); ++f)
    if (is_polygon[f])
      print_face(out, level.mesh.facets[f].rings[0], static_cast<int>(f), coordinates);
  for (std::size_t t = 0; t < level.mesh.triangles.size(); ++t)
    if (const int f = level.mesh.facet_of_triangle[t]; !is_polygon[f])
      print_face(out, level.mesh.triangles[t], f, coordinates);
  return {stem(building, layer) + ".obj", out};
}

std::vector<Encoded> encode_obj_material(const ExportBuilding& building, const ExportLevel& level,
                                         int layer) {
  const LevelLook& look = level.look;
  if (!look.has_texture()) return {};
  // Hardly a program that reads OBJ knows KTX2: it gets what the fallback is, or would be.
  const bool is_jpeg = !look.fallback.empty() || look.format == ImageFormat::kKtx2;
  const ImageFormat format = is_jpeg ? ImageFormat::kJpeg : look.format;
  const std::string image = stem(building, layer) + "." + extension_of(format);
  return {{stem(building, layer) + ".mtl", "newmtl texture\nKd 1 1 1\nillum 0\nmap_Kd " +
                                               image.substr(image.rfind('/') + 1) + "\n"},
          {image, look.fallback.empty() && is_jpeg ? encode_image(look.raster, format, look.quality)
                  : is_jpeg                        ? look.fallback
                                                   : look.image}};
}

Encoded encode_ply(const ExportBuilding& building, const ExportLevel& level, int layer) {
  std::string out =
      "ply\nformat binary_little_endian 1.0\ncomment colod: layer " + std::to_string(layer) +
      " (0 = coarsest), metres, z up, world coordinates\nelement vertex " +
      std::to_string(level.mesh.vertices.size()) +
      "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
      std::to_string(level.mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\n";
  const std::vector<Rgb>& colors = level.look.facet_colors;
  if (!colors.empty()) out += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  out += "end_header\n";
  for (const Vec3& p : level.mesh.vertices)
    for (int k = 0; k < 3; ++k) put(out, p[k] + building.origin[k]);
  for (std::size_t t = 0; t < level.mesh.triangles.size(); ++t) {
    put(out, std::uint8_t{3});
    for (const int v : level.mesh.triangles[t]) put(out, static_cast<std::int32_t>(v));
    if (colors.empty()) continue;
    for (const std::uint8_t c : colors[static_cast<std::size_t>(level.mesh.facet_of_triangle[t])])
      put(out, c);
  }
  return {stem(building, layer) + ".ply", out};
}

}  // namespace colod
