// Meshes that are too large for one tile: their parts, and the images that these wear.
#include "scene/pieces.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <set>

#include "image/look_sampler.h"
#include "scene/coarse_images.h"
#include "scene/context_chain.h"
#include "scene/own_images.h"
#include "scene/tiles.h"
#include "scenes.h"
#include "temporary_folder.h"

using namespace colod;
using namespace colod::test;

namespace {

Source place_of(double side) {
  Source s;
  s.mesh = terrain_with_boxes(side, 1, {Box{{3, 3, 0}, {9, 12, 5}}});
  for (std::size_t f = 0; f < s.mesh.faces.size(); ++f) {
    const auto tone = static_cast<std::uint8_t>(f % 251);
    s.look.colors.push_back({Rgb{tone, 0, 0}, Rgb{0, tone, 0}, Rgb{0, 0, tone}});
  }
  return joined({s});
}

/// Each face by its corners, with its colours.
using Told = std::set<std::pair<std::array<double, 9>, std::array<Rgb, 3>>>;

void tell(const Source& s, Told& told) {
  for (std::size_t f = 0; f < s.mesh.faces.size(); ++f) {
    std::array<double, 9> at;
    for (std::size_t k = 0; k < 9; ++k)
      at[k] =
          s.mesh
              .vertices[static_cast<std::size_t>(s.mesh.faces[f][k / 3])][static_cast<int>(k % 3)];
    told.insert({at, s.look.colors[f]});
  }
}

/// A square of `parts` by `parts` squares, of which each other one wears its place in an image of
/// 256 pixels a side, scaled about its corner.
Source checkered(const std::string& image, int parts, float scale) {
  Source s;
  s.look.images.resize(1);
  s.look.images[0].path = image;
  s.look.materials.resize(1);
  s.look.materials[0].image = 0;
  for (int i = 0; i < parts; ++i)
    for (int j = i % 2; j < parts; j += 2) {
      const int v = static_cast<int>(s.mesh.vertices.size());
      const Vec2f uv(static_cast<float>(i) / static_cast<float>(parts),
                     static_cast<float>(j) / static_cast<float>(parts));
      const float side = scale / static_cast<float>(parts);
      for (const Vec2f& c : {Vec2f(0, 0), Vec2f(1, 0), Vec2f(1, 1), Vec2f(0, 1)})
        s.mesh.vertices.emplace_back(i + c.x(), j + c.y(), 0);
      const auto at = [&](float a, float b) { return Vec2f(uv + side * Vec2f(a, b)); };
      s.mesh.faces.push_back({v, v + 1, v + 2}), s.mesh.faces.push_back({v, v + 2, v + 3});
      s.look.uvs.push_back({at(0, 0), at(1, 0), at(1, 1)});
      s.look.uvs.push_back({at(0, 0), at(1, 1), at(0, 1)});
    }
  s.look.face_material.assign(s.mesh.faces.size(), 0);
  return s;
}

std::string write_image(const TemporaryFolder& folder) {
  Raster raster(256, 256);
  for (int y = 0; y < 256; ++y)
    for (int x = 0; x < 256; ++x) {
      raster.at(x, y)[0] = static_cast<std::uint8_t>(x);
      raster.at(x, y)[1] = static_cast<std::uint8_t>(y);
      raster.at(x, y)[2] = 90;
    }
  const std::string path = (folder / "look.png").string();
  std::ofstream(path, std::ios::binary) << encode_image(raster, ImageFormat::kPng, 90);
  return path;
}

Light seen(const Source& s, int face) {
  const ImageCache images(std::size_t{1} << 26);
  const LookSampler sampler(s.mesh, s.look, images);
  Lens lens(images);
  const Face& f = s.mesh.faces[static_cast<std::size_t>(face)];
  Vec3 middle = Vec3::Zero();
  for (const int v : f) middle += s.mesh.vertices[static_cast<std::size_t>(v)] / 3;
  return sampler.sample(face, middle, 0.001, lens);
}

}  // namespace

TEST_CASE("parts of a mesh are all of it once, none larger than asked for") {
  const double side = GENERATE(20, 47, 90);
  const std::size_t most = GENERATE(100, 1000, 1'000'000);
  const Source whole = place_of(side);
  Pieces pieces;
  Told before, after;
  std::size_t faces = 0;
  const std::vector<std::size_t> numbers = pieces.cut(whole, most);
  for (const std::size_t n : numbers) {
    const Source piece = pieces.get(n);
    CHECK(piece.mesh.faces.size() <= most);
    CHECK((pieces.box(n).size() - bounding_box(piece.mesh.vertices).size()).norm() == 0);
    faces += piece.mesh.faces.size();
    tell(piece, after);
  }
  tell(whole, before);
  CHECK(faces == whole.mesh.faces.size());
  CHECK(before == after);
  CHECK((numbers.size() == 1) == (most >= faces));
}

TEST_CASE("what lies on one place is not parted without end") {
  Source s;
  s.mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  s.mesh.faces.assign(50, {0, 1, 2});
  Pieces pieces;
  CHECK(pieces.cut(s, 10).size() == 1);
}

TEST_CASE("a part wears the pieces of an image that it shows, and looks as before") {
  const TemporaryFolder folder;
  const std::string image = write_image(folder);
  const int parts = GENERATE(2, 4, 8);
  const Source before = checkered(image, parts, 0.4f);
  Source after = before;
  const OwnImages own(std::size_t{1} << 26);
  own.give(after);
  CHECK(after.look.images[0].path != image);
  const ImageCache cache(std::size_t{1} << 26);
  const ImageCache::Facts facts = cache.facts(after.look.images[0]);
  CHECK(facts.width * facts.height < 256 * 256 / 2);
  for (int f = 0; f < static_cast<int>(before.mesh.faces.size()); f += 3)
    CHECK((seen(before, f) - seen(after, f)).matrix().norm() < 0.03);
}

TEST_CASE("an image that is mostly worn, repeats or cannot be read stays") {
  const TemporaryFolder folder;
  const std::string image = write_image(folder);
  const OwnImages own(std::size_t{1} << 26);
  Source worn = checkered(image, 1, 1), lost = checkered("nowhere.png", 4, 0.4f),
         repeated = checkered(image, 4, 0.4f);
  for (Vec2f& uv : repeated.look.uvs[0]) uv += Vec2f(2, 0);
  for (Source* s : {&worn, &lost, &repeated}) {
    const Source before = *s;
    own.give(*s);
    CHECK(s->look.images[0] == before.look.images[0]);
    CHECK(s->look.uvs == before.look.uvs);
  }
}

TEST_CASE("a coarse tile wears one image with texels as large as pixels, of what it wears alone") {
  const TemporaryFolder folder;
  const std::string image = write_image(folder);
  const int parts = GENERATE(2, 4, 8);
  const double larger = GENERATE(1.0, 3.0, 6.5);  // a texel than those of the source
  Source before = checkered(image, parts, 0.4f);
  Raster loud = decode_image(read_image(before.look.images[0], 1 << 24), 1 << 24).raster;
  const double side = 256 * 0.4 / parts;  // pixels of a part
  for (int y = 0; y < 256; ++y)
    for (int x = 0; x < 256; ++x) {
      const double u = std::fmod(x, 256.0 / parts), v = std::fmod(y, 256.0 / parts);
      const bool is_worn = (x * parts / 256 + y * parts / 256) % 2 == 0 && u < side && v < side;
      if (!is_worn) loud.at(x, y)[2] = 255;
    }
  std::ofstream(image, std::ios::binary) << encode_image(loud, ImageFormat::kPng, 90);
  Source after = before;
  const CoarseImages coarse(std::size_t{1} << 26);
  coarse.give(after, larger / side, false);
  const std::set<int> worn(after.look.face_material.begin(), after.look.face_material.end());
  REQUIRE(worn.size() == 1);
  const Material& material = after.look.materials[static_cast<std::size_t>(*worn.begin())];
  CHECK(material.image == 1);
  const ImageCache cache(std::size_t{1} << 26);
  const ImageCache::Facts facts = cache.facts(after.look.images[1]);
  const double chart = side / larger + 2 * 2 + 2 + 3;  // with margins, rim, and up to fours
  CHECK(facts.width * facts.height < 1.5 * parts * parts / 2 * chart * chart + 64);
  for (int f = 0; f < static_cast<int>(before.mesh.faces.size()); ++f) {
    const Light a = seen(before, f), b = seen(after, f);
    INFO(f << ": " << a.transpose() << " and " << b.transpose());
    CHECK((a - b).matrix().norm() < 0.1);  // loud neighbours, and JPEG
  }
}

TEST_CASE("where charts would take more room than their image a coarse tile wears all of it") {
  const double larger = GENERATE(1.1, 1.25, 3.0);
  constexpr int kParts = 64;  // charts of four pixels
  const TemporaryFolder folder;
  const Source before = checkered(write_image(folder), kParts, 1);
  Source after = before;
  const CoarseImages coarse(std::size_t{1} << 26);
  coarse.give(after, larger * kParts / 256, false);
  const Material& material =
      after.look.materials[static_cast<std::size_t>(after.look.face_material[0])];
  REQUIRE(material.image == 1);
  const ImageCache cache(std::size_t{1} << 26);
  const ImageCache::Facts facts = cache.facts(after.look.images[1]);
  CAPTURE(larger, facts.width, facts.height);
  CHECK(std::max(facts.width, facts.height) <= 256 / larger + 2 + 3 + 1);  // rim, and up to fours
  CHECK(std::min(facts.width, facts.height) >= 256 / larger);
  for (int f = 0; f < static_cast<int>(before.mesh.faces.size()); f += 7)
    CHECK((seen(before, f) - seen(after, f)).matrix().norm() < 0.06);
}

TEST_CASE("where mip levels are made of a coarse tile's image its sides are powers of two") {
  const double larger = GENERATE(1.1, 1.7, 3.0, 5.0);
  constexpr int kParts = 4;
  const TemporaryFolder folder;
  const Source before = checkered(write_image(folder), kParts, 1);
  Source plain = before, ready = before;
  const CoarseImages coarse(std::size_t{1} << 26);
  coarse.give(plain, larger * kParts / 256, false);
  coarse.give(ready, larger * kParts / 256, true);
  const ImageCache cache(std::size_t{1} << 26);
  const ImageCache::Facts own = cache.facts(plain.look.images.back());
  const ImageCache::Facts facts = cache.facts(ready.look.images.back());
  CAPTURE(larger, own.width, own.height, facts.width, facts.height);
  for (const auto& [side, was] : {std::array{facts.width, own.width}, {facts.height, own.height}}) {
    CHECK((side & (side - 1)) == 0);
    CHECK(side <= 2 * was);
    CHECK(2 * side > was);
  }
  const double share = static_cast<double>(facts.width) * facts.height / own.width / own.height;
  CHECK(share > 0.5);
  CHECK(share < 1.15);
  for (int f = 0; f < static_cast<int>(before.mesh.faces.size()); ++f)
    CHECK((seen(before, f) - seen(ready, f)).matrix().norm() < 0.1);
}

TEST_CASE("a coarse tile whose images are no finer than pixels, tinted or lost keeps them") {
  const TemporaryFolder folder;
  const std::string image = write_image(folder);
  const CoarseImages coarse(std::size_t{1} << 26);
  Source fitting = checkered(image, 1, 1), lost = checkered("nowhere.png", 4, 0.4f),
         repeated = checkered(image, 4, 0.4f), tinted = repeated, clear = repeated;
  for (Vec2f& uv : repeated.look.uvs[0]) uv += Vec2f(2, 0);
  tinted.look.materials[0].color = {1, 0.5f, 0.5f};
  clear.look.materials[0].cutoff = 0.5f;
  for (Source* s : {&fitting, &lost, &repeated, &tinted, &clear}) {
    const Source before = *s;
    coarse.give(*s, s == &fitting ? 1.0 / 256 : 0.1, true);
    CHECK(s->look.images == before.look.images);
    CHECK(s->look.uvs == before.look.uvs);
    CHECK(s->look.face_material == before.look.face_material);
  }
}

TEST_CASE("a mesh of more faces than a client draws at once is several tiles, whichever way up") {
  const bool is_y_up = GENERATE(false, true);
  const int side = GENERATE(60, 180, 360);
  const TemporaryFolder folder;
  Mesh place = terrain_with_boxes(side, 1, {Box{{13, 13, 0}, {29, 32, 5}}});
  const Box box = bounding_box(place.vertices);
  if (is_y_up) place = y_up(place);
  std::ofstream(folder / "place.obj") << obj_text(place);
  const SceneTiles tiles(list_tiles((folder / "place.obj").string()), Eigen::Matrix4d::Identity(),
                         0, true, {});
  CHECK((tiles.count() > 1) == (side > 173));
  CHECK(tiles.faces() == place.faces.size());
  std::size_t faces = 0;
  std::vector<Source> parts;
  for (std::size_t i = 0; i < tiles.count(); ++i) {
    const auto tile = tiles.get(i);
    CHECK(tile->mesh.faces.size() <= 60'000);
    CHECK(tiles.is_piece(i) == (side > 173));
    CHECK((tiles.box(i).size() - bounding_box(tile->mesh.vertices).size()).norm() < 1e-9);
    faces += tile->mesh.faces.size();
    parts.push_back(*tile);
  }
  CHECK(faces == place.faces.size());
  CHECK((tiles.box().size() - box.size()).norm() < 1e-9);
  const Mesh whole = joined(parts).mesh;
  const std::vector<char> open = on_border(whole);
  for (std::size_t v = 0; v < whole.vertices.size(); ++v) {  // no crack between tiles
    const Vec2 p = whole.vertices[v].head<2>();
    const bool is_inside = (p.array() > 0.5).all() && (p.array() < side - 0.5).all();
    if (is_inside && open[v]) FAIL_CHECK("a crack at " << p.transpose());
  }
}
