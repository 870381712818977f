#include <catch2/catch.hpp>

#include "walls.h"

using namespace colod;
using namespace colod::test;

namespace {

/// Where u rises on a triangle, by its coordinates, as clients find a tangent without being given
/// one.
Vec3 tangent_of(const BakedTexture& t, const PolygonMesh& mesh, std::size_t triangle) {
  const Face& f = mesh.triangles[triangle];
  const Vec3 a = mesh.vertices[f[1]] - mesh.vertices[f[0]];
  const Vec3 b = mesh.vertices[f[2]] - mesh.vertices[f[0]];
  const auto& uv = t.uvs[triangle];
  const Vec2 d = (uv[1] - uv[0]).cast<double>(), e = (uv[2] - uv[0]).cast<double>();
  return ((e.y() * a - d.y() * b) / (d.x() * e.y() - e.x() * d.y())).normalized();
}

}  // namespace

TEST_CASE("a normal map gives back, in the frame that clients make, how the source is turned") {
  const double wave = GENERATE(1.0, 0.4), high = 0.03 * wave;
  const bool is_wide = GENERATE(true, false);
  INFO(wave << (is_wide ? " wide" : " high"));
  const Vec2 size = is_wide ? Vec2(kEdge, 1) : Vec2(1, kEdge);
  const double k = 2 * M_PI / wave, step = wave / 40;
  Mesh relief;  // y = high · (sin kx + sin kz), seen from −y
  const int nx = static_cast<int>(std::lround(size.x() / step)) + 1;
  const int nz = static_cast<int>(std::lround(size.y() / step)) + 1;
  for (int j = 0; j < nz; ++j)
    for (int i = 0; i < nx; ++i)
      relief.vertices.emplace_back(
          i * step, high * (std::sin(k * i * step) + std::sin(k * j * step)), j * step);
  for (int j = 0; j + 1 < nz; ++j)
    for (int i = 0; i + 1 < nx; ++i) {
      const int v = j * nx + i;
      relief.faces.push_back({v, v + 1, v + nx + 1}),
          relief.faces.push_back({v, v + nx + 1, v + nx});
    }
  Appearance look;
  look.colors.assign(relief.faces.size(), {Rgb{9, 9, 9}, Rgb{99, 9, 9}, Rgb{9, 99, 9}});
  const ImageCache none(0);
  const Baker baker(relief, look, none);
  const PolygonMesh layer = rectangles({{0, 0, size.x(), size.y()}}, 0);
  const BakeOptions options{.texel = wave / 50, .reach = 0.5, .has_normals = true};
  const BakedTexture t = baker.bake(layer, options);
  REQUIRE(t.normals.width == t.image.width);
  REQUIRE(t.normals.height == t.image.height);
  double farthest = 0;
  for (double x = 0.1; x < size.x() - 0.1; x += 0.07)
    for (double z = 0.1; z < size.y() - 0.1; z += 0.07) {
      const Vec3 p(x, 0, z);
      const std::size_t own = barycentric(layer.mesh(), layer.triangles[0], p).minCoeff() < 0;
      const Eigen::Vector3d seen = seen_at(t, layer, own, p, t.normals) / 127.5;
      const Vec3 right = tangent_of(t, layer, own), out = -Vec3::UnitY();
      const Vec3 n =
          (seen.x() - 1) * right + (seen.y() - 1) * out.cross(right) + (seen.z() - 1) * out;
      const Vec3 real =
          Vec3(high * k * std::cos(k * x), -1, high * k * std::cos(k * z)).normalized();
      CHECK(std::abs(n.norm() - 1) < 0.05);
      farthest = std::max(farthest, std::acos(std::min(1.0, n.normalized().dot(real))));
    }
  CHECK(farthest * 180 / M_PI < 2);  // of 15 degrees
  CHECK(baker.bake(layer, {.texel = wave / 50}).normals.rgb.empty());
}

TEST_CASE("a normal map of a plain box is flat up to its edges, and beyond them") {
  const Mesh box = box_mesh({0, 0, 0}, {4, 0.5, 2});
  Appearance look;
  look.colors.assign(box.faces.size(), {Rgb{9, 9, 9}, Rgb{99, 9, 9}, Rgb{9, 99, 9}});
  const ImageCache none(0);
  const PolygonMesh layer = rectangles({{0, 0, 9, 2}}, 0);  // twice as wide as the box
  const BakedTexture t =
      Baker(box, look, none).bake(layer, {.texel = 0.05, .reach = 0.5, .has_normals = true});
  int turned = 0;
  for (std::size_t i = 0; i < t.normals.rgb.size(); i += 3)
    turned += std::abs(t.normals.rgb[i] - 128) > 1 || std::abs(t.normals.rgb[i + 1] - 128) > 1 ||
              t.normals.rgb[i + 2] != 255;
  CHECK(turned == 0);
}
