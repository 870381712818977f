// What tests of baking share: a wall with an image on it, facets, and what a client sees of them.
#pragma once

#include <fstream>

#include "bake/bake.h"
#include "image/cache.h"
#include "meshes.h"
#include "temporary_folder.h"

namespace colod::test {

inline constexpr int kSide = 256;   // pixels of a source image
inline constexpr double kEdge = 4;  // metres that it covers
inline constexpr double kTexel = kEdge / kSide;

/// A square of kEdge in the plane y = 0, seen from −y, with an image on it: x is u, z is −v.
struct Wall {
  TemporaryFolder folder;
  Mesh mesh;
  Appearance look;
  ImageCache cache{std::size_t{64} << 20};

  explicit Wall(const Raster& raster) {
    const std::string path = (folder / "wall.png").string();
    std::ofstream(path, std::ios::binary) << encode_image(raster, ImageFormat::kPng, 0);
    look.images = {{.path = path}};
    look.materials.resize(1);
    look.materials[0].image = 0;
    mesh.vertices = {{0, 0, 0}, {kEdge, 0, 0}, {kEdge, 0, kEdge}, {0, 0, kEdge}};
    mesh.faces = {{0, 1, 2}, {0, 2, 3}};
    look.face_material = {0, 0};
    look.uvs = {{Vec2f(0, 1), Vec2f(1, 1), Vec2f(1, 0)}, {Vec2f(0, 1), Vec2f(1, 0), Vec2f(0, 0)}};
  }
};

/// Facets that are rectangles, each with vertices of its own, seen from −y.
inline PolygonMesh rectangles(const std::vector<std::array<double, 4>>& x_z_width_height,
                              double y) {
  PolygonMesh mesh;
  for (const auto& [x, z, w, h] : x_z_width_height) {
    const int first = static_cast<int>(mesh.vertices.size());
    const int facet = static_cast<int>(mesh.facets.size());
    for (const Vec3& p :
         {Vec3(x, y, z), Vec3(x + w, y, z), Vec3(x + w, y, z + h), Vec3(x, y, z + h)})
      mesh.vertices.push_back(p);
    mesh.facets.push_back({-Vec3::UnitY(), facet, {{first, first + 1, first + 2, first + 3}}});
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
    mesh.facet_of_triangle.insert(mesh.facet_of_triangle.end(), 2, facet);
  }
  return mesh;
}

/// What a client sees at a place of a triangle: bilinear, clamped.
inline Eigen::Vector3d seen_at(const BakedTexture& t, const PolygonMesh& mesh, std::size_t triangle,
                               const Vec3& p, const Raster& image) {
  const Vec3 w = barycentric(mesh.mesh(), mesh.triangles[triangle], p);
  Eigen::Vector2d uv = Eigen::Vector2d::Zero();
  for (int c = 0; c < 3; ++c)
    uv += w[c] * t.uvs[triangle][static_cast<std::size_t>(c)].cast<double>();
  const double x = uv.x() * image.width - 0.5, y = uv.y() * image.height - 0.5;
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      const std::uint8_t* q =
          image.at(std::clamp(x0 + i, 0, image.width - 1), std::clamp(y0 + j, 0, image.height - 1));
      sum +=
          (i ? x - x0 : 1 - x + x0) * (j ? y - y0 : 1 - y + y0) * Eigen::Vector3d(q[0], q[1], q[2]);
    }
  return sum;
}

}  // namespace colod::test
