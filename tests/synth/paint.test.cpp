#include "synth/paint.h"

#include <catch2/catch.hpp>
#include <fstream>

#include "image/cache.h"
#include "read/read.h"
#include "temporary_folder.h"

using namespace colod;
using namespace colod::test;

TEST_CASE("a painted house has every face in its image, and its parts' numbers") {
  const std::vector<SynthBuilding> houses = make_neighbourhood({.buildings = 1, .seed = 3});
  const SynthBuilding& house = houses.at(0);
  const PaintedModel model = paint(house, 0.1);
  CHECK(paint(house, 0.1).image == model.image);
  const TemporaryFolder folder;
  const std::string name = house.source.name;
  std::ofstream(folder / (name + ".obj"), std::ios::binary) << model.obj;
  std::ofstream(folder / (name + ".mtl"), std::ios::binary) << model.mtl;
  std::ofstream(folder / (name + ".jpg"), std::ios::binary) << model.image;
  const Source s = read_single((folder / (name + ".obj")).string());
  CHECK(s.warnings.empty());
  REQUIRE(s.look.uvs.size() == house.source.mesh.faces.size());
  for (const auto& corners : s.look.uvs)
    for (const Vec2f& uv : corners) CHECK((uv.minCoeff() >= 0 && uv.maxCoeff() <= 1));
  for (std::size_t part = 0; part < house.parts.size(); ++part)
    CHECK(std::count(s.face_object.begin(), s.face_object.end(), static_cast<int>(part)) ==
          std::count(house.source.face_object.begin(), house.source.face_object.end(),
                     static_cast<int>(part)));
  const ImageCache::Facts facts = ImageCache(std::size_t{1} << 28).facts(s.look.images.at(0));
  CHECK(facts.problem.empty());
  CHECK(facts.width > 100);
}
