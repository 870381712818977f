#include "image/look_sampler.h"

#include <catch2/catch.hpp>
#include <fstream>

#include "meshes.h"
#include "temporary_folder.h"

using namespace colod;
using namespace colod::test;
using Catch::Contains;

namespace {

/// A square of one metre in the plane z = 0 whose image of 4 × 4 has one red pixel, the upper left.
struct Square {
  TemporaryFolder folder;
  Mesh mesh;
  Appearance look;
  ImageCache cache{1 << 20};

  Square() {
    Raster raster(4, 4);
    raster.at(0, 0)[0] = 255;
    const std::string path = (folder / "red.png").string();
    std::ofstream(path, std::ios::binary) << encode_image(raster, ImageFormat::kPng, 0);
    look.images = {{.path = path}};
    look.materials.resize(1);
    look.materials[0].image = 0;
    look.face_material = {0, 0};
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.faces = {{0, 1, 2}, {0, 2, 3}};
    spread(0, 1);
  }
  /// Coordinates from `from` to `to` along both sides.
  void spread(float from, float to) {
    look.uvs = {{Vec2f(from, to), Vec2f(to, to), Vec2f(to, from)},
                {Vec2f(from, to), Vec2f(to, from), Vec2f(from, from)}};
  }
  float red_at(double x, double y, double spacing = 0.01) const {
    const LookSampler sampler(mesh, look, cache);
    Lens lens(cache);
    return sampler.sample(x > y ? 0 : 1, Vec3(x, y, 0), spacing, lens)[0];
  }
};

}  // namespace

TEST_CASE("beyond an image's border it is repeated, mirrored or its border goes on") {
  Square s;
  CHECK(s.red_at(0.125, 0.875) == Approx(1));
  CHECK(s.red_at(0.625, 0.875) == Approx(0));
  s.spread(-1, 3);  // four times along each side; a pixel is 1/16 wide
  const auto pixel = [&](int column, int row) {
    return s.red_at((column + 0.5) / 16, 1 - (row + 0.5) / 16);
  };
  for (const int k : {0, 4, 12}) CHECK(pixel(k, k) == Approx(1));
  CHECK(pixel(3, 3) == Approx(0));
  s.look.materials[0].wrap_u = s.look.materials[0].wrap_v = Wrap::kMirror;
  CHECK(pixel(3, 3) == Approx(1));
  CHECK(pixel(4, 4) == Approx(1));
  CHECK(pixel(0, 0) == Approx(0));
  s.look.materials[0].wrap_u = s.look.materials[0].wrap_v = Wrap::kClamp;
  CHECK(pixel(0, 0) == Approx(1));
  CHECK(pixel(1, 2) == Approx(1));
  CHECK(pixel(8, 8) == Approx(0));
  CHECK(pixel(15, 2) == Approx(0));
}

TEST_CASE("coordinates that are no places give the image's mean, with a warning that names it") {
  Square s;
  for (const float bad : {NAN, INFINITY, 1e30f}) {
    Square own;
    own.look.uvs[0][1].y() = bad;
    CHECK(own.red_at(0.75, 0.25) == Approx(1.0 / 16).epsilon(0.05));
    CHECK(own.red_at(0.125, 0.875) == Approx(1));  // the other face
    const LookSampler sampler(own.mesh, own.look, own.cache);
    REQUIRE(sampler.warnings().size() == 1);
    CHECK_THAT(sampler.warnings()[0], Contains("red.png") && Contains("1 faces"));
    CHECK(sampler.texel() == Approx(0.25));
  }
  s.look.uvs.clear();
  CHECK(s.red_at(0.3, 0.3) == Approx(1.0 / 16).epsilon(0.05));
  CHECK(LookSampler(s.mesh, s.look, s.cache).warnings().size() == 1);
}

TEST_CASE("coarse samples are the mean of what they cover, to four texels") {
  const Square s;
  CHECK(s.red_at(0.25, 0.75, 0.5) == Approx(0.25 * 0.5).margin(0.2));
  CHECK(s.red_at(0.5, 0.5, 1) == Approx(1.0 / 16).epsilon(0.1));
  CHECK(s.red_at(0.5, 0.5, 100) == Approx(1.0 / 16).epsilon(0.1));
}

TEST_CASE("only an image that is transparent somewhere has holes") {
  Square s;
  s.look.materials[0].cutoff = 0.5f;
  CHECK_FALSE(LookSampler(s.mesh, s.look, s.cache).has_holes());
  Raster fence(4, 4);
  fence.alpha.assign(16, 255);
  fence.alpha[5] = 0;
  s.cache.put(missing_image("fence"), fence);
  s.look.images[0] = missing_image("fence");
  CHECK(LookSampler(s.mesh, s.look, s.cache).has_holes());
  s.look.materials[0].cutoff = 0;
  CHECK_FALSE(LookSampler(s.mesh, s.look, s.cache).has_holes());
}
