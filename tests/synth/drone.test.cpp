// Made-up drone photogrammetry.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "measure/metrics.h"
#include "synth/synth.h"

using namespace colod;

namespace {

constexpr std::uint64_t kSurface = 1,
                        kField = 3;  // seeds whose streets are full meshes, height fields

SynthOptions flown(double edge, std::uint64_t seed) {
  return {.buildings = 2, .seed = seed, .is_drone = true, .scan_edge = edge, .is_varied = true};
}

double median_edge(const Mesh& mesh) {
  std::vector<double> lengths;
  for (const Face& f : mesh.faces)
    for (int k = 0; k < 3; ++k)
      lengths.push_back((mesh.vertices[f[k]] - mesh.vertices[f[(k + 1) % 3]]).norm());
  std::nth_element(lengths.begin(), lengths.begin() + lengths.size() / 2, lengths.end());
  return lengths[lengths.size() / 2];
}

}  // namespace

TEST_CASE("a drone's mesh is open, near its model, and has the edges that were asked for") {
  for (std::uint64_t seed : {kSurface, kField}) {
    auto models = flown(1, seed);
    models.is_drone = false;
    const auto clean = make_neighbourhood(models);
    for (double edge : {0.5, 0.9}) {
      const auto scans = make_neighbourhood(flown(edge, seed));
      for (std::size_t i = 0; i < scans.size(); ++i) {
        INFO("seed " << seed << " edge " << edge << " " << scans[i].source.name);
        const Mesh& mesh = scans[i].source.mesh;
        const Validity v = check_validity(mesh, false);
        CHECK(v.boundary_edges > 10);
        CHECK(v.nonmanifold_edges < 0.01 * mesh.faces.size());
        CHECK(median_edge(mesh) == Approx(edge).epsilon(0.35));
        const Distances d = measure_distances(clean[i].source.mesh, mesh, {.samples = 5000});
        CHECK(d.mean_b_to_a > 0.02);
        CHECK(d.mean_b_to_a < 1);
      }
    }
  }
}

TEST_CASE("nothing of a height field faces down") {
  for (const SynthBuilding& b : make_neighbourhood(flown(0.5, kField))) {
    int down = 0;
    for (const Face& f : b.source.mesh.faces) down += face_cross(b.source.mesh, f).z() < 0;
    CHECK(down == 0);
  }
}

TEST_CASE("faces of a drone's mesh are named after the model, or are ground and trees") {
  for (std::uint64_t seed : {kSurface, kField})
    for (const SynthBuilding& b : make_neighbourhood(flown(1, seed))) {
      REQUIRE(b.source.face_object.size() == b.source.mesh.faces.size());
      const int parts = static_cast<int>(b.parts.size());
      int ground = 0, walls = 0, roofs = 0;
      for (int object : b.source.face_object) {
        CHECK(object < parts);
        ground += object < 0, walls += object == 0, roofs += object == 1;
      }
      CHECK(ground > 10);
      CHECK(walls > 10);
      CHECK(roofs > 10);
    }
}

TEST_CASE("a hall of few triangles and one of many") {
  SynthOptions options = flown(5, kSurface);
  options.buildings = 1, options.plans = SynthPlans::kHalls;
  const std::size_t few = make_neighbourhood(options)[0].source.mesh.faces.size();
  options.scan_edge = 0.5;
  const std::size_t many = make_neighbourhood(options)[0].source.mesh.faces.size();
  CHECK(few > 50);
  CHECK(few < 700);
  CHECK(many > 20 * few);
}

TEST_CASE("a drone's mesh is the same with one thread and two") {
  for (std::uint64_t seed : {kSurface, kField}) {
    limit_threads(1);
    const auto one = make_neighbourhood(flown(1.5, seed));
    limit_threads(2);
    const auto two = make_neighbourhood(flown(1.5, seed));
    limit_threads(0);
    for (std::size_t i = 0; i < one.size(); ++i) {
      CHECK(one[i].source.mesh.vertices == two[i].source.mesh.vertices);
      CHECK(one[i].source.mesh.faces == two[i].source.mesh.faces);
      CHECK(one[i].source.face_object == two[i].source.face_object);
    }
  }
}

TEST_CASE("edges without a length are an error") {
  CHECK_THROWS_AS(make_neighbourhood(flown(0, kSurface)), Error);
}
