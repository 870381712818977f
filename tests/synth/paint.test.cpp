#include "synth/paint.h"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "core/rays.h"
#include "image/look_sampler.h"
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

TEST_CASE("a scan's bumps are painted with what its clean model shows") {
  SynthOptions options{.buildings = 1, .seed = 3};
  const std::vector<SynthBuilding> clean = make_neighbourhood(options);
  options.is_scan = true;
  options.density = 8;
  const std::vector<SynthBuilding> scan = make_neighbourhood(options);
  const ImageCache images(std::size_t{1} << 28);
  const TemporaryFolder folder;
  const auto read = [&](const PaintedModel& model, const std::string& below) {
    std::filesystem::create_directory(folder / below);
    const std::string path = (folder / below / clean[0].source.name).string();
    std::ofstream(path + ".obj", std::ios::binary) << model.obj;
    std::ofstream(path + ".mtl", std::ios::binary) << model.mtl;
    std::ofstream(path + ".jpg", std::ios::binary) << model.image;
    return read_single(path + ".obj");
  };
  const Source truth = read(paint(clean[0], 0.1), "clean");
  const LookSampler shown(truth.mesh, truth.look, images);
  const RayScene surface(truth.mesh);
  // How far the middles of faces are from the colour of the clean model nearest to them.
  const auto error = [&](const Source& s) {
    const LookSampler look(s.mesh, s.look, images);
    Lens own(images), other(images);
    double sum = 0;
    int count = 0;
    for (std::size_t f = 0; f < s.mesh.faces.size(); ++f) {
      const auto& [a, b, c] = s.mesh.faces[f];
      const Vec3 p = (s.mesh.vertices[a] + s.mesh.vertices[b] + s.mesh.vertices[c]) / 3;
      const NearestPoint near = surface.nearest(p);
      if (near.distance > 0.3) continue;  // a floater
      ++count;
      sum += (look.sample(static_cast<int>(f), p, 0.3, own) -
              shown.sample(near.triangle, near.point, 0.3, other))
                 .norm();
    }
    return sum / count;
  };
  const double bumpy = error(read(paint(scan[0], 0.1), "bumpy"));
  const double smooth = error(read(paint(scan[0], 0.1, clean.data()), "smooth"));
  INFO(smooth << " instead of " << bumpy);
  CHECK(smooth < 0.7 * bumpy);
}
