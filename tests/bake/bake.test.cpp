#include "bake/bake.h"

#include <catch2/catch.hpp>

#include "core/flat.h"
#include "core/parallel.h"
#include "walls.h"

using namespace colod;
using namespace colod::test;

namespace {

template <typename Color>
Raster painted(int side, const Color& color) {
  Raster raster(side, side);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const Rgb rgb = color(x, y);
      std::copy(rgb.begin(), rgb.end(), raster.at(x, y));
    }
  return raster;
}

/// Red rises to the right, green downward; blue is a checkerboard of 16 pixels.
Raster ramps() {
  return painted(kSide, [](int x, int y) {
    return Rgb{static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y),
               static_cast<std::uint8_t>((x / 16 + y / 16) % 2 ? 230 : 20)};
  });
}

/// A mip level as a client makes it: means of 2 × 2 pixels.
Raster halved(const Raster& fine) {
  Raster out(fine.width / 2, fine.height / 2);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x)
      for (int c = 0; c < 3; ++c)
        out.at(x, y)[c] = static_cast<std::uint8_t>(
            (fine.at(2 * x, 2 * y)[c] + fine.at(2 * x + 1, 2 * y)[c] +
             fine.at(2 * x, 2 * y + 1)[c] + fine.at(2 * x + 1, 2 * y + 1)[c] + 2) /
            4);
  return out;
}

}  // namespace

TEST_CASE("what is cut out of an image is seen through, and its colour is baked nowhere") {
  // A black fence before the wall: transparent but for posts of 32 of 64 pixels, which are red.
  for (const float cutoff : {0.5f, 0.f}) {
    Wall wall(painted(kSide, [](int, int) { return Rgb{30, 200, 30}; }));
    Raster fence = painted(kSide, [](int x, int) {
      return x / 32 % 2 ? Rgb{200, 30, 30} : Rgb{0, 0, 0};
    });
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) fence.alpha.push_back(x / 32 % 2 ? 255 : 0);
    const ImagePlace place{.path = "fence"};
    wall.cache.put(place, fence);
    wall.look.images.push_back(place);
    wall.look.materials.push_back({.name = "fence", .image = 1, .cutoff = cutoff});
    for (int i = 0; i < 4; ++i)
      wall.mesh.vertices.push_back(wall.mesh.vertices[static_cast<std::size_t>(i)] -
                                   0.1 * Vec3::UnitY());
    wall.mesh.faces.push_back({4, 5, 6}), wall.mesh.faces.push_back({4, 6, 7});
    wall.look.face_material.insert(wall.look.face_material.end(), 2, 1);
    wall.look.uvs.push_back(wall.look.uvs[0]), wall.look.uvs.push_back(wall.look.uvs[1]);
    const Baker baker(wall.mesh, wall.look, wall.cache);
    for (const double texel : {0.0, 0.1}) {
      const PolygonMesh layer = rectangles({{0, 0, kEdge, kEdge}}, -0.1);
      const BakedTexture t = baker.bake(layer, {.texel = texel, .reach = 0.5});
      INFO(cutoff << " " << texel);
      for (int k = 0; k < 8; ++k) {
        const Vec3 p((k + 0.5) * kEdge / 8, -0.1, 1.3);
        const Vec3 w = barycentric(layer.mesh(), layer.triangles[0], p);
        const Eigen::Vector3d seen = seen_at(t, layer, w.minCoeff() >= 0 ? 0 : 1, p, t.image);
        const Eigen::Vector3d behind =
            cutoff > 0 ? Eigen::Vector3d(30, 200, 30) : Eigen::Vector3d(0, 0, 0);
        CHECK((seen - (k % 2 ? Eigen::Vector3d(200, 30, 30) : behind)).norm() < 8);
      }
    }
    const Rgb mean = baker.facet_colors(rectangles({{0, 0, kEdge, kEdge}}, -0.1), 0.5)[0];
    CHECK((mean[1] > 100) == (cutoff > 0));
  }
}

TEST_CASE("a cloud's colours are baked where its points are, whichever way its normals look") {
  for (const double spacing : {0.02, 0.05, 0.1})
    for (const double sign : {1.0, -1.0}) {
      INFO(spacing << " " << sign);
      PointCloud cloud;
      std::vector<std::array<Rgb, 3>> colors;
      for (double x = spacing / 2; x < kEdge; x += spacing)
        for (double z = spacing / 2; z < kEdge; z += spacing) {
          cloud.points.emplace_back(x, 0, z);
          cloud.normals.emplace_back(0, -sign, 0);
          const Rgb rgb = x < kEdge / 4 ? Rgb{200, 30, 30}
                          : z < 1       ? Rgb{30, 200, 30}
                                        : Rgb{9, 9, 240};
          colors.push_back({rgb, rgb, rgb});
        }
      const Splats splats = splat_points(cloud, colors);
      CHECK(splats.spacing == Approx(spacing).epsilon(0.2));
      const ImageCache none(0);
      const Baker baker(splats.mesh, splats.look, none, Sides::kBoth);
      CHECK(baker.source_texel() == Approx(spacing).epsilon(0.4));
      const PolygonMesh layer = rectangles({{0, 0, kEdge, kEdge}}, 0.05);
      const BakedTexture t = baker.bake(layer, {});
      CHECK(t.facts.seen > 0.99);
      const auto at = [&](double x, double z) {
        for (std::size_t k = 0; k < 2; ++k) {
          const Vec3 p(x, 0.05, z), w = barycentric(layer.mesh(), layer.triangles[k], p);
          if (w.minCoeff() >= 0) return seen_at(t, layer, k, p, t.image);
        }
        return Eigen::Vector3d(0, 0, 0);
      };
      CHECK((at(0.6, 3) - Eigen::Vector3d(200, 30, 30)).norm() < 5);
      CHECK((at(2, 0.6) - Eigen::Vector3d(30, 200, 30)).norm() < 5);
      CHECK((at(3, 3) - Eigen::Vector3d(9, 9, 240)).norm() < 5);
      const PolygonMesh halves = rectangles({{0, 0, 1, kEdge}, {1, 1, 3, 3}}, -0.05);
      const std::vector<Rgb> mean = baker.facet_colors(halves, 0.5);
      CHECK((mean[0][0] > 190 && mean[0][2] < 50));
      CHECK((mean[1][2] > 230 && mean[1][0] < 40));
    }
}

TEST_CASE("what a wall shows is baked where it is, as large as it is, and not mirrored") {
  const Wall wall(ramps());
  const Baker baker(wall.mesh, wall.look, wall.cache);
  CHECK(baker.warnings().empty());
  CHECK(baker.source_texel() == Approx(kTexel).epsilon(1e-6));
  const PolygonMesh layer = rectangles({{0, 0, kEdge, kEdge}}, 0.07);
  const BakedTexture t = baker.bake(layer, {});
  CHECK(t.facts.seen == Approx(1));
  CHECK(t.facts.texel == Approx(kTexel).epsilon(1e-6));
  double shift_x = 0, shift_z = 0;
  int count = 0, wrong = 0;
  for (double x = 0.4; x < 3.6; x += 0.0371)
    for (double z = 0.4; z < 3.6; z += 0.0393) {
      const std::size_t triangle = x > z ? 0 : 1;
      const Eigen::Vector3d rgb = seen_at(t, layer, triangle, Vec3(x, 0.07, z), t.image);
      shift_x += rgb[0] + 0.5 - x / kTexel;  // in texels: red is the column's number
      shift_z += rgb[1] + 0.5 - (kEdge - z) / kTexel;
      const double u = std::fmod(x / kTexel, 16), v = std::fmod((kEdge - z) / kTexel, 16);
      const bool is_inside = u > 1.1 && u < 14.9 && v > 1.1 && v < 14.9;
      const bool is_light =
          (static_cast<int>(x / kTexel) / 16 + static_cast<int>((kEdge - z) / kTexel) / 16) % 2;
      wrong += is_inside && std::abs(rgb[2] - (is_light ? 230 : 20)) > 2;
      ++count;
    }
  CHECK(std::abs(shift_x / count) < 0.25);
  CHECK(std::abs(shift_z / count) < 0.25);
  CHECK(wrong == 0);
}

/// A house whose faces have cells of an atlas each, turned by an angle of their own; the picture is
/// a function of the place in space: red and green rise with height and along, blue is a
/// checkerboard of half metres.
struct House {
  static constexpr int kCell = 160;
  static constexpr double kOwn = 0.06;  // metres a texel
  TemporaryFolder folder;
  Mesh mesh = gable_house(6, 5, 4, 2);
  Appearance look;
  ImageCache cache{std::size_t{64} << 20};

  static Eigen::Vector3d color(const Vec3& p) {
    const auto cell = [](double v) { return static_cast<int>(std::floor(v / 0.5 + 1e-4)); };
    return {20 + 30 * p.z(), 20 + 12 * (p.x() + p.y()),
            (cell(p.x()) + cell(p.y()) + cell(p.z())) % 2 ? 230.0 : 20.0};
  }
  House() {
    const int faces = static_cast<int>(mesh.faces.size()), width = kCell * faces;
    Raster raster(width, kCell);
    for (int f = 0; f < faces; ++f) {
      const auto [a, b, c] = mesh.faces[f];
      const Vec3 base = (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3;
      const auto [u, v] = plane_basis(face_cross(mesh, mesh.faces[f]).normalized());
      const double turn = 0.7 * f;
      const Vec3 x = std::cos(turn) * u + std::sin(turn) * v;
      const Vec3 y = std::sin(turn) * u - std::cos(turn) * v;  // down
      const Vec2 middle(kCell * (f + 0.5), kCell * 0.5);
      for (int row = 0; row < kCell; ++row)
        for (int column = f * kCell; column < (f + 1) * kCell; ++column) {
          const Vec2 q = kOwn * (Vec2(column + 0.5, row + 0.5) - middle);
          const Eigen::Vector3d rgb = color(base + q.x() * x + q.y() * y);
          for (int k = 0; k < 3; ++k)
            raster.at(column, row)[k] =
                static_cast<std::uint8_t>(std::lround(std::clamp(rgb[k], 0.0, 255.0)));
        }
      look.uvs.emplace_back();
      for (int k = 0; k < 3; ++k) {
        const Vec3 p = mesh.vertices[mesh.faces[f][k]] - base;
        const Vec2 at = middle + Vec2(p.dot(x), p.dot(y)) / kOwn;
        look.uvs.back()[k] = Vec2(at.x() / width, at.y() / kCell).cast<float>();
      }
      look.face_material.push_back(0);
    }
    const std::string path = (folder / "house.png").string();
    std::ofstream(path, std::ios::binary) << encode_image(raster, ImageFormat::kPng, 0);
    look.images = {{.path = path}};
    look.materials.resize(1);
    look.materials[0].image = 0;
  }
  /// Each face a facet.
  PolygonMesh layer() const {
    PolygonMesh out;
    out.vertices = mesh.vertices;
    for (const Face& f : mesh.faces) {
      const int facet = static_cast<int>(out.facets.size());
      out.facets.push_back({face_cross(mesh, f).normalized(), facet, {{f[0], f[1], f[2]}}});
      out.triangles.push_back(f);
      out.facet_of_triangle.push_back(facet);
    }
    return out;
  }
};

TEST_CASE("every side of a house shows its own place, to half a texel, whatever way charts lie") {
  const House house;
  const Baker baker(house.mesh, house.look, house.cache);
  CHECK(baker.source_texel() == Approx(House::kOwn).epsilon(1e-4));
  const PolygonMesh layer = house.layer();
  const BakedTexture t = baker.bake(layer, {});
  CHECK(t.facts.seen > 0.99);
  for (std::size_t f = 0; f < layer.triangles.size(); ++f) {
    const auto& [a, b, c] = layer.triangles[f];
    Eigen::Vector3d shift = Eigen::Vector3d::Zero();
    int count = 0, wrong = 0, flat = 0;
    for (double u = 0.03; u < 1; u += 0.031)
      for (double v = 0.03; u + v < 0.97; v += 0.029) {
        const Vec3 p =
            (1 - u - v) * layer.vertices[a] + u * layer.vertices[b] + v * layer.vertices[c];
        const Eigen::Vector3d rgb = seen_at(t, layer, f, p, t.image), wanted = House::color(p);
        shift += rgb - wanted, ++count;
        bool is_plain = true;  // a texel and a half from every border of the checkerboard
        for (int k = 0; k < 3; ++k) {
          const double in_cell = p[k] / 0.5 - std::floor(p[k] / 0.5);
          const bool is_even = layer.facets[f].normal.cwiseAbs()[k] > 0.999;
          is_plain &= is_even || (in_cell > 0.25 && in_cell < 0.75);
        }
        flat += is_plain;
        wrong += is_plain && std::abs(rgb[2] - wanted[2]) > 3;
      }
    INFO("face " << f << " of " << flat << " places");
    CHECK(flat > 20);
    CHECK(wrong == 0);
    CHECK(std::abs(shift[0] / count) < 0.5 * 30 * House::kOwn);  // half a texel's rise
    CHECK(std::abs(shift[1] / count) < 0.5 * 12 * House::kOwn);
  }
}

TEST_CASE("no seam shows where charts of one wall meet, nor two levels down the mip chain") {
  const Wall wall(painted(kSide, [](int x, int y) {
    return Rgb{static_cast<std::uint8_t>(60 + x / 2), static_cast<std::uint8_t>(200 - y / 2), 90};
  }));
  const Baker baker(wall.mesh, wall.look, wall.cache);
  const PolygonMesh layer = rectangles({{0, 0, 1.7, 4}, {1.7, 0, 2.3, 4}}, -0.02);
  const BakedTexture t = baker.bake(layer, {});
  CHECK(t.facts.charts == 2);
  Raster image = t.image;
  for (int level = 0; level < 3; ++level) {
    for (double z = 0.3; z < 3.7; z += 0.05) {
      const Vec3 p(1.7, -0.02, z);
      const Eigen::Vector3d left = seen_at(t, layer, 0, p, image);
      const Eigen::Vector3d right = seen_at(t, layer, 2, p, image);
      INFO("level " << level << " height " << z);
      CHECK((left - right).cwiseAbs().maxCoeff() <= 2 << level);  // ramps rise with the footprint
    }
    image = halved(image);
  }
}

TEST_CASE("coarse texels are the mean of what they cover, in linear light") {
  const Wall wall(painted(kSide, [](int x, int y) {
    return (x + y) % 2 ? Rgb{255, 255, 255} : Rgb{0, 0, 0};
  }));
  const Baker baker(wall.mesh, wall.look, wall.cache);
  const PolygonMesh layer = rectangles({{0, 0, kEdge, kEdge}}, 0.1);
  const BakedTexture t = baker.bake(layer, {.texel = 16 * kTexel});
  for (double x = 0.5; x < 3.5; x += 0.25) {
    const Eigen::Vector3d rgb = seen_at(t, layer, 0, Vec3(x, 0.1, 0.4), t.image);
    CHECK(std::abs(rgb[0] - 188) <= 2);  // half of the light, not half of the number
  }
}

TEST_CASE("what the source does not show is the building's mean, neither black nor smear") {
  const Wall wall(painted(kSide, [](int, int) { return Rgb{200, 100, 50}; }));
  const Baker baker(wall.mesh, wall.look, wall.cache);
  PolygonMesh layer = rectangles({{0, 0, kEdge, kEdge}}, 0);
  const PolygonMesh far = rectangles({{0, 0, 2, 2}}, 30);
  for (const Vec3& p : far.vertices) layer.vertices.push_back(p);
  layer.facets.push_back({-Vec3::UnitY(), 1, {{4, 5, 6, 7}}});
  layer.triangles.insert(layer.triangles.end(), {{4, 5, 6}, {4, 6, 7}});
  layer.facet_of_triangle.insert(layer.facet_of_triangle.end(), {1, 1});
  const BakedTexture t = baker.bake(layer, {});
  CHECK(t.facts.unseen == Approx(0.2).margin(0.01));
  CHECK(t.facts.seen == Approx(0.8).margin(0.01));
  for (std::size_t i = 0; i < t.image.rgb.size(); i += 3) {
    REQUIRE(std::abs(t.image.rgb[i] - 200) <= 1);
    REQUIRE(std::abs(t.image.rgb[i + 2] - 50) <= 1);
  }
  CHECK(baker.facet_colors(layer, 0.5) == std::vector<Rgb>(2, Rgb{200, 100, 50}));
}

TEST_CASE(
    "what nobody saw takes a block of the atlas however large it is, what little is seen its "
    "place") {
  const Wall wall(painted(kSide, [](int, int) { return Rgb{200, 100, 50}; }));
  const Baker baker(wall.mesh, wall.look, wall.cache);
  const BakedTexture alone = baker.bake(rectangles({{0, 0, kEdge, kEdge}}, 0), {});
  for (const double size : {0.5, 2.0, 40.0}) {
    INFO(size << " m that nobody saw");
    PolygonMesh layer = rectangles({{0, 0, kEdge, kEdge}}, 0);
    for (const Vec3& p : rectangles({{0, 0, size, size}}, 30).vertices) layer.vertices.push_back(p);
    layer.facets.push_back({-Vec3::UnitY(), 1, {{4, 5, 6, 7}}});
    layer.triangles.insert(layer.triangles.end(), {{4, 5, 6}, {4, 6, 7}});
    layer.facet_of_triangle.insert(layer.facet_of_triangle.end(), {1, 1});
    const BakedTexture t = baker.bake(layer, {});
    CHECK(t.image.width * t.image.height <= 1.05 * alone.image.width * alone.image.height);
    CHECK(t.facts.unseen == Approx(size * size / (size * size + kEdge * kEdge)).margin(0.01));
    const auto uv = [&](std::size_t triangle, std::size_t k) {
      return Vec2(t.uvs[triangle][k].x() * t.image.width, t.uvs[triangle][k].y() * t.image.height);
    };
    const Vec2 side = uv(2, 1) - uv(2, 0), other = uv(2, 2) - uv(2, 0);
    CHECK(std::abs(cross(side, other)) > 1);  // tangents can be told
    CHECK(side.norm() <= 8);
  }
  for (const double share : {0.1, 0.5})  // of a wall that is mostly beside the source
    CHECK(baker.bake(rectangles({{0, 0, kEdge / share, kEdge}}, 0), {}).facts.unseen < 0.01);
}

TEST_CASE("a riser that nobody saw looks like what it lies against, a party wall like all walls") {
  const Wall wall(painted(kSide, [](int x, int) {
    return x < kSide / 2 ? Rgb{200, 100, 50} : Rgb{20, 60, 220};
  }));
  const Baker baker(wall.mesh, wall.look, wall.cache);
  for (const double height : {0.05, 0.2, 0.4, 6.0}) {
    INFO(height << " m high");
    PolygonMesh layer = rectangles({{0, 0, kEdge, kEdge}}, 0);
    const double x = 1, h = height / 2;  // upright on the wall, in its first half
    for (const Vec3& p : {Vec3(x, -h, 0), Vec3(x, h, 0), Vec3(x, h, kEdge), Vec3(x, -h, kEdge)})
      layer.vertices.push_back(p);
    layer.facets.push_back({Vec3::UnitX(), 1, {{4, 5, 6, 7}}});
    layer.triangles.insert(layer.triangles.end(), {{4, 5, 6}, {4, 6, 7}});
    layer.facet_of_triangle.insert(layer.facet_of_triangle.end(), {1, 1});
    const BakedTexture t = baker.bake(layer, {});
    const auto seen = seen_at(t, layer, 2, Vec3(x, 0, kEdge / 2), t.image);
    INFO(seen.transpose());
    CHECK((height < 1 ? seen[0] > 190 : seen[0] < 160));
    CHECK((height < 1 ? seen[2] < 60 : seen[2] > 120));
  }
}

TEST_CASE("what nobody saw of a wall has the wall's mean beyond half a metre, and no smear") {
  // Sky blue at its foot, which a rim would smear; seen above 2 m only.
  Wall wall(painted(kSide, [](int, int y) {
    return y > kSide / 2 - 8 ? Rgb{20, 60, 220} : Rgb{200, 100, 50};
  }));
  wall.mesh.vertices[0].z() = wall.mesh.vertices[1].z() = 2;
  wall.look.uvs = {{Vec2f(0, 0.5f), Vec2f(1, 0.5f), Vec2f(1, 0)},
                   {Vec2f(0, 0.5f), Vec2f(1, 0), Vec2f(0, 0)}};
  const Baker baker(wall.mesh, wall.look, wall.cache);
  const PolygonMesh layer = rectangles({{0, 0, kEdge, kEdge}}, 0.1);
  const BakedTexture t = baker.bake(layer, {});
  CHECK(t.facts.seen == Approx(0.5).margin(0.01));
  CHECK(t.facts.filled + t.facts.nearest == Approx(0.5).margin(0.01));
  const auto at = [&](double z) { return seen_at(t, layer, 0, Vec3(2.5, 0.1, z), t.image); };
  CHECK(at(2.5)[0] == Approx(200).margin(1));
  CHECK(at(1.95)[2] == Approx(220).margin(2));  // a crack is filled from its rim
  for (double z = 0.1; z < 1.2; z += 0.1) {
    INFO(z);
    CHECK(at(z)[0] == Approx(195).margin(6));  // the mean, in linear light
    CHECK(at(z)[2] < 90);
  }
}

TEST_CASE("beside what is seen a wall goes on as its rim is, each place as the nearest to it") {
  // 16 of 255 from pixel to pixel, up and down, so that a shift by half a texel shows.
  const auto wave = [](double pixel) { return 16 * std::abs(std::remainder(pixel, 32.0)); };
  const Wall wall(painted(kSide, [&](int x, int y) {
    return Rgb{static_cast<std::uint8_t>(std::min(255.0, wave(x + 0.5))),
               static_cast<std::uint8_t>(std::min(255.0, wave(y + 0.5))), 90};
  }));
  const Baker baker(wall.mesh, wall.look, wall.cache);
  const double rim = 0.2;
  const PolygonMesh layer = rectangles({{-rim, -rim, kEdge + 2 * rim, kEdge + 2 * rim}}, 0);
  const BakedTexture t = baker.bake(layer, {});
  CHECK(t.facts.nearest > 0.1);
  const auto at = [&](double x, double z) {
    const Vec3 p(x, 0, z);
    return seen_at(t, layer, x + rim > z + rim ? 0 : 1, p, t.image);
  };
  for (double along = 0.4; along < 3.6; along += 0.037)
    for (const double out : {0.03, 0.1, 0.17}) {
      INFO(along << " m along, " << out << " m out");
      const double red = wave(along / kTexel), green = wave((kEdge - along) / kTexel);
      CHECK(std::abs(at(along, kEdge + out)[0] - red) < 9);
      CHECK(std::abs(at(along, -out)[0] - red) < 9);
      CHECK(std::abs(at(kEdge + out, along)[1] - green) < 9);
      CHECK(std::abs(at(-out, along)[1] - green) < 9);
    }
}

TEST_CASE("an atlas keeps to its largest side, with larger texels") {
  const Wall wall(ramps());
  const Baker baker(wall.mesh, wall.look, wall.cache);
  const BakedTexture t = baker.bake(rectangles({{0, 0, kEdge, kEdge}}, 0), {.largest = 100});
  CHECK(std::max(t.image.width, t.image.height) <= 100);
  CHECK(t.image.width % 4 + t.image.height % 4 == 0);
  CHECK(t.facts.texel > 2 * kTexel);
  CHECK(t.facts.seen == Approx(1));
  for (const auto& corners : t.uvs)
    for (const Vec2f& uv : corners) CHECK((uv.minCoeff() >= 0 && uv.maxCoeff() <= 1));
}

TEST_CASE("any number of threads bakes the same texels") {
  const Wall wall(ramps());
  const PolygonMesh layer = rectangles({{0, 0, 2, 4}, {2.1, 0, 1.9, 2}, {2.1, 2, 1.9, 2}}, 0.03);
  const auto baked = [&](int threads) {
    BakedTexture t;
    in_threads(threads, [&] { t = Baker(wall.mesh, wall.look, wall.cache).bake(layer, {}); });
    return t.image.rgb;
  };
  CHECK(baked(1) == baked(3));
}
