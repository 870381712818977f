// Varied streets: plans, roofs and makes from wide ranges.
#include <catch2/catch.hpp>
#include <map>
#include <set>

#include "core/error.h"
#include "measure/metrics.h"
#include "synth/synth.h"

using namespace colod;

namespace {

std::vector<SynthBuilding> varied(int buildings, std::uint64_t seed, bool has_slopes = false) {
  return make_neighbourhood(
      {.buildings = buildings, .seed = seed, .is_varied = true, .has_slopes = has_slopes});
}

}  // namespace

TEST_CASE("varied houses of 50 seeds are closed manifolds without self-intersections") {
  for (std::uint64_t seed = 1; seed <= 50; ++seed)
    for (const SynthBuilding& b : varied(6, seed, seed % 3 == 0)) {
      INFO("seed " << seed << " " << b.source.name << " " << b.style);
      const Validity v = check_validity(b.source.mesh);
      CHECK(v.is_watertight);
      CHECK(v.is_manifold);
      CHECK(v.self_intersections == 0);
      CHECK(v.degenerate_faces == 0);
      CHECK(v.components == 1);
      CHECK(v.volume > 40);
    }
}

TEST_CASE("varied streets have every kind of part and of plan") {
  std::set<std::string> types, styles, dormers;
  for (std::uint64_t seed : {1, 3, 5, 7, 9})
    for (const SynthBuilding& b : varied(24, seed)) {
      styles.insert(b.style);
      for (const SynthPart& p : b.parts) {
        types.insert(name_of(p.kind));
        if (p.kind == ElementKind::kDormer) dormers.insert(p.model.substr(p.model.rfind('_')));
      }
    }
  for (const char* type :
       {"body", "roof", "tower", "annex", "window", "door", "balcony", "dormer", "chimney",
        "recess", "bay", "stairhead", "parapet", "cornice", "arcade", "passage"}) {
    INFO(type);
    CHECK(types.count(type) == 1);
  }
  for (const char* style : {"varied_rectangle", "varied_l", "varied_t", "varied_u", "varied_z",
                            "varied_court", "row_house", "hall", "office"}) {
    INFO(style);
    CHECK(styles.count(style) == 1);
  }
  CHECK(dormers == std::set<std::string>{"_gabled", "_shed", "_hipped", "_flat", "_mansard"});
}

TEST_CASE("makes repeat within a house and between neighbours, and differ between streets") {
  std::map<std::string, std::set<std::size_t>> houses;
  std::size_t repeated = 0;
  const auto street = varied(16, 3);
  for (std::size_t i = 0; i < street.size(); ++i) {
    std::map<std::string, int> models;
    for (const SynthPart& p : street[i].parts)
      if (p.kind == ElementKind::kWindow) ++models[p.model], houses[p.model].insert(i);
    for (const auto& [model, count] : models) repeated += count > 3;
  }
  std::size_t shared = 0;
  for (const auto& [model, where] : houses) shared += where.size() > 1;
  CHECK(repeated >= 10);
  CHECK(shared >= 3);
  const auto widest = [](const std::vector<SynthBuilding>& all) {
    double depth = 0;
    for (const SynthBuilding& b : all)
      for (const SynthPart& p : b.parts)
        if (p.kind == ElementKind::kWindow) depth += p.depth;
    return depth;
  };
  CHECK(widest(street) != widest(varied(16, 5)));
}

TEST_CASE("reveals and sizes come from wide ranges") {
  double shallow = 1, deep = 0, narrow = 10, wide = 0;
  for (std::uint64_t seed : {1, 3, 5})
    for (const SynthBuilding& b : varied(12, seed))
      for (const SynthPart& p : b.parts) {
        if (p.kind != ElementKind::kWindow || p.model == "roof_window") continue;
        shallow = std::min(shallow, p.depth), deep = std::max(deep, p.depth);
        narrow = std::min(narrow, p.box.size().head<2>().norm());
        wide = std::max(wide, p.box.size().head<2>().norm());
      }
  CHECK(shallow < 0.08);
  CHECK(deep > 0.24);
  CHECK(narrow < 0.9);
  CHECK(wide > 2);
}

TEST_CASE("on slopes the feet of walls lie at several heights") {
  double lowest = 0;
  for (const SynthBuilding& b : varied(8, 3, true)) {
    std::set<double> feet;
    for (const Vec3& p : b.source.mesh.vertices)
      if (p.z() < 0) feet.insert(p.z());
    lowest = std::min(lowest, bounding_box(b.source.mesh.vertices).min.z());
  }
  CHECK(lowest < -0.8);
  CHECK_THROWS_AS(make_neighbourhood({.buildings = 1, .has_slopes = true}), Error);
}

TEST_CASE("varied houses do not run into each other") {
  for (std::uint64_t seed : {2, 3}) {
    Mesh together;
    for (const SynthBuilding& b : varied(24, seed)) {
      const int base = static_cast<int>(together.vertices.size());
      together.vertices.insert(together.vertices.end(), b.source.mesh.vertices.begin(),
                               b.source.mesh.vertices.end());
      for (const Face& f : b.source.mesh.faces)
        together.faces.push_back({f[0] + base, f[1] + base, f[2] + base});
    }
    const Validity v = check_validity(together);
    CHECK(v.self_intersections == 0);
    CHECK(v.components == 24);
  }
}
