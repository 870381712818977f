// Streets in which no size tells a kind.
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>

#include "measure/metrics.h"
#include "synth/synth.h"

using namespace colod;

namespace {

std::vector<SynthPart> parts_of(SynthSizes sizes, std::uint64_t seed) {
  std::vector<SynthPart> parts;
  for (const SynthBuilding& b : make_neighbourhood({.buildings = 20, .seed = seed, .sizes = sizes}))
    for (const SynthPart& p : b.parts)
      if (p.level > 0) parts.push_back(p);
  return parts;
}

struct Sized {
  double area = 0;
  bool is_large = false;  ///< of a kind for layer 1
};

std::map<ElementKind, std::vector<Sized>> areas_of(std::uint64_t seed, int buildings) {
  std::map<ElementKind, std::vector<Sized>> kinds;
  for (const SynthBuilding& b :
       make_neighbourhood({.buildings = buildings, .seed = seed, .sizes = SynthSizes::kMixed})) {
    std::map<int, double> area;
    for (std::size_t f = 0; f < b.source.mesh.faces.size(); ++f)
      area[b.source.face_object[f]] += face_area(b.source.mesh, b.source.mesh.faces[f]);
    for (const SynthPart& p : b.parts)
      if (p.level > 0) kinds[p.kind].push_back({area[p.instance], p.level == 1});
  }
  return kinds;
}

}  // namespace

TEST_CASE("with mixed sizes the kind decides on the layer") {
  std::map<ElementKind, int> levels;
  for (const SynthPart& p : parts_of(SynthSizes::kMixed, 3)) {
    const auto [known, is_new] = levels.insert({p.kind, p.level});
    CHECK(known->second == p.level);
  }
  CHECK(levels.at(ElementKind::kChimney) == 1);
  CHECK(levels.at(ElementKind::kOrnament) == 2);
  CHECK(levels.at(ElementKind::kDormer) == 1);
  CHECK(levels.at(ElementKind::kBalcony) == 1);
}

TEST_CASE("a threshold on area that is told how many parts are large keeps no kinds together") {
  for (const std::uint64_t seed : {1, 3, 5, 7})
    for (const int buildings : {8, 16}) {
      INFO("seed " << seed << ", " << buildings << " buildings");
      const auto kinds = areas_of(seed, buildings);
      std::vector<double> all;
      std::size_t large = 0, kept = 0;
      for (const auto& [kind, parts] : kinds)
        for (const Sized& s : parts) all.push_back(s.area), large += s.is_large;
      std::sort(all.rbegin(), all.rend());
      for (const auto& [kind, parts] : kinds) {
        const auto above = std::count_if(parts.begin(), parts.end(),
                                         [&](const Sized& s) { return s.area >= all[large - 1]; });
        kept += std::max<std::size_t>(above, parts.size() - above);
      }
      CHECK(static_cast<double>(kept) < 0.82 * static_cast<double>(all.size()));
    }
}

TEST_CASE("dormers have three sizes, and a hall stands among cottages") {
  std::map<std::string, int> models, styles;
  for (const SynthBuilding& b :
       make_neighbourhood({.buildings = 20, .seed = 1, .sizes = SynthSizes::kMixed})) {
    ++styles[b.style];
    for (const SynthPart& p : b.parts) ++models[p.model];
  }
  CHECK(styles["hall"] >= 1);
  CHECK(styles["cottage"] >= 5);
  for (const std::string kind : {"dormer_gabled", "chimney", "balcony", "ornament"})
    for (const std::string size : {"_small", "_middle", "_large"}) {
      INFO(kind << size);
      CHECK(models[kind + size] > 0);
    }
}

TEST_CASE("houses with mixed sizes are solids") {
  for (std::uint64_t seed : {1, 2, 3, 5})
    for (const SynthBuilding& b :
         make_neighbourhood({.buildings = 16, .seed = seed, .sizes = SynthSizes::kMixed})) {
      INFO("seed " << seed << " " << b.source.name << " " << b.style);
      const Validity v = check_validity(b.source.mesh);
      CHECK(v.is_watertight);
      CHECK(v.is_manifold);
      CHECK(v.self_intersections == 0);
      CHECK(v.components == 1);
    }
}
