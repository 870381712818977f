// What is no building, as it is written.
#include "publish/context.h"

#include <catch2/catch.hpp>
#include <fstream>

#include "image/image.h"
#include "temporary_folder.h"

using namespace colod;

namespace {

/// A square of two faces below an image that is red on its left and blue on its right.
Scene textured_place(const test::TemporaryFolder& folder) {
  Raster raster(64, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) raster.at(x, y)[x < 32 ? 0 : 2] = 200;
  std::ofstream(folder / "look.png", std::ios::binary)
      << encode_image(raster, ImageFormat::kPng, 90);
  Source s;
  s.mesh.vertices = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}};
  s.mesh.faces = {{0, 1, 3}, {1, 2, 3}};
  s.look.images.resize(1);
  s.look.images[0].path = (folder / "look.png").string();
  s.look.materials.resize(1);
  s.look.materials[0].image = 0;
  s.look.face_material = {0, 0};
  s.look.uvs = {{Vec2f(0, 1), Vec2f(1, 1), Vec2f(0, 0)}, {Vec2f(1, 1), Vec2f(1, 0), Vec2f(0, 0)}};
  Scene scene;
  auto context = std::make_shared<Context>();
  context->nodes.resize(1);
  context->read = [s](std::size_t) { return s; };
  scene.context = context;
  return scene;
}

}  // namespace

TEST_CASE("with one colour a face a place has those of its images, and tells which are lost") {
  const test::TemporaryFolder folder;
  const Scene scene = textured_place(folder);
  ContextFailures failures;
  TextureOptions options;
  options.mode = Texture::kColors;
  const ContextMesh mesh = context_tiles(scene, options, failures)->mesh(0);
  CHECK(mesh.images.empty());
  CHECK(failures[0].empty());
  REQUIRE(mesh.colors.size() == 2);
  for (const Rgb& rgb : mesh.colors[0]) CHECK(rgb[0] > rgb[2] + 30);  // three quarters are red
  for (const Rgb& rgb : mesh.colors[1]) CHECK(rgb[2] > rgb[0] + 30);
  std::ofstream(folder / "look.png", std::ios::binary) << "no image";
  const ContextMesh bare = context_tiles(scene, options, failures)->mesh(0);
  CHECK(failures[0].size() == 1);
  CHECK(bare.colors[0][0] == Rgb{255, 255, 255});  // its material's
  options.mode = Texture::kNone;
  context_tiles(scene, options, failures)->mesh(0);
  CHECK(failures[0].empty());
}
