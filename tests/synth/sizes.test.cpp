// Streets in which no size tells a kind.
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
