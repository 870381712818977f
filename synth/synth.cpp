// *Based on:* nothing published; streets of houses whose parts come from one catalogue, so that
// what repeats is known.
//
// *Differs:* no --rules here.
//
// *Notation:* none.
#include "synth.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>

#include "bodies.h"
#include "core/error.h"
#include "core/parallel.h"
#include "drone.h"
#include "internal.h"
#include "mixed.h"
#include "variety.h"

namespace colod {
namespace {

using namespace synth;

constexpr double kLargeRelief = 0.4;  // m; see SynthPart::level
constexpr double kLargeVolume = 1.5;  // m³
constexpr int kChurchAt = 6;          // one church, in neighbourhoods that have as many buildings

std::uint64_t building_seed(std::uint64_t seed, int index) {
  std::uint64_t z = seed * 0xD1342543DE82EF95ull + (index + 1) * 0x9E3779B97F4A7C15ull;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
  return z ^ (z >> 27);
}

/// Runs of three row houses between detached ones, which come in shuffled rounds.
std::vector<int> choose_styles(const SynthOptions& options) {
  Random random(options.seed * 31 + 5);
  std::vector<int> styles, deck;
  const auto draw = [&] {
    if (deck.empty())
      for (int s = 1; s + 1 < style_count(); ++s) deck.push_back(s);
    const int i = random.pick(static_cast<int>(deck.size()));
    const int style = deck[i];
    deck.erase(deck.begin() + i);
    return style;
  };
  while (static_cast<int>(styles.size()) < options.buildings) {
    styles.insert(styles.end(), 3, 0);
    for (int i = 0; i < 4; ++i) styles.push_back(draw());
  }
  styles.resize(std::max(options.buildings, 0));
  if (options.buildings > kChurchAt) styles[kChurchAt] = style_count() - 1;
  return styles;
}

/// Where a house's own origin lies and how it is turned.
struct Site {
  Vec3 origin = Vec3::Zero();
  double yaw = 0;

  Vec3 to_world(const Vec3& p) const {
    const double c = std::cos(yaw), s = std::sin(yaw);
    return origin + Vec3(c * p.x() - s * p.y(), s * p.x() + c * p.y(), p.z());
  }
};

bool is_row_house(const House& house) { return house.style == "row_house"; }

/// Four frontages, both sides of two streets that drift apart. The houses of one are placed side by
/// side; only row houses touch.
std::vector<Site> place_houses(const std::vector<House>& houses, std::uint64_t seed) {
  constexpr double kStreetYaw[2] = {-0.07, 0.09};  // rad
  double deepest = 0;
  for (const House& h : houses) deepest = std::max(deepest, h.depth + 2 * h.before);
  const Vec3 street_start[2] = {{0, 0, 0}, {6, std::max(78.0, 30 + 2 * deepest), 0}};
  constexpr double kHalfStreet = 5.5, kPartyGap = 0.02;
  Random random(seed * 101 + 3);
  std::vector<Site> sites(houses.size());
  const std::size_t n = houses.size(), per_side = std::max<std::size_t>(1, (n + 3) / 4);
  double along = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t side = std::min<std::size_t>(3, i / per_side), street = side / 2;
    if (i % per_side == 0 && i / per_side <= 3) along = 0;
    const bool is_row = is_row_house(houses[i]);
    const bool has_neighbour = is_row && i > 0 && is_row_house(houses[i - 1]) && along > 0;
    along += has_neighbour ? kPartyGap : houses[i].beside + random.uniform(3.5, 7);
    const double yaw = kStreetYaw[street], begin = along;
    const double setback =
        kHalfStreet + houses[i].before + (is_row ? 3.0 : random.uniform(3.5, 6)) +
        (houses[i].style == "winged_house" || houses[i].style == "church" ? 6 : 0);
    const double turn = is_row ? 0 : random.uniform(-0.04, 0.04);
    along += houses[i].width + houses[i].beside;
    const Vec3 x(std::cos(yaw), std::sin(yaw), 0), y(-x.y(), x.x(), 0);
    const bool is_far = side % 2 == 0;  // beyond the street, which lies towards its own −y
    sites[i].origin = street_start[street] + (is_far ? begin : along - houses[i].beside) * x +
                      (is_far ? setback : -setback) * y;
    sites[i].yaw = yaw + turn + (is_far ? 0 : M_PI);
  }
  return sites;
}

double round_to_micrometre(double x) { return std::round(x * 1e6) / 1e6; }

/// Boxes and levels of the parts, from the faces that carry their number.
void measure_parts(SynthBuilding& building, const Mesh& local, SynthSizes sizes) {
  std::vector<Box> local_box(building.parts.size());
  for (std::size_t f = 0; f < local.faces.size(); ++f)
    for (int v : local.faces[f]) {
      const int part = building.source.face_object[f];
      local_box[part].extend(local.vertices[v]);
      building.parts[part].box.extend(building.source.mesh.vertices[v]);
    }
  for (SynthPart& part : building.parts) {
    const bool is_main = part.kind == ElementKind::kPlain || part.kind == ElementKind::kRoof ||
                         part.kind == ElementKind::kSpire;
    const bool is_large =
        sizes == SynthSizes::kMixed
            ? is_large_kind(part.kind)
            : part.depth >= kLargeRelief && local_box[part.instance].size().prod() >= kLargeVolume;
    part.level = is_main ? 0 : is_large ? 1 : 2;
  }
}

SynthBuilding finish(const House& house, const Site& site, int index, SynthSizes sizes) {
  SynthBuilding building;
  building.style = house.style;
  building.parts = house.parts;
  char name[32];
  std::snprintf(name, sizeof name, "house_%02d", index);
  building.source.name = building.source.path = name;
  const Mesh local = house.solid.triangulate(building.source.face_object);
  building.source.mesh = local;
  for (Vec3& v : building.source.mesh.vertices)
    v = site.to_world(v).unaryExpr([](double x) { return round_to_micrometre(x); });
  measure_parts(building, local, sizes);
  return building;
}

std::vector<House> build_houses(const SynthOptions& options) {
  const Catalogue catalogue(options.seed);
  const std::vector<int> styles = choose_styles(options);
  std::vector<House> houses;
  for (int i = 0; i < options.buildings; ++i) {
    const std::uint64_t seed = building_seed(options.seed, i);
    if (options.is_varied)
      houses.push_back(make_varied_house(i, seed, options));
    else if (options.sizes == SynthSizes::kMixed)
      houses.push_back(make_mixed_house(i, styles[i], options.seed, seed));
    else
      houses.push_back(make_house(styles[i], seed, catalogue));
  }
  return houses;
}

nlohmann::json to_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

template <typename T>
void append(std::string& bytes, const T& value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));  // little-endian hosts only, as the PLY header says
  bytes.append(raw, sizeof(T));
}

}  // namespace

std::vector<SynthBuilding> make_neighbourhood(const SynthOptions& options) {
  if (options.buildings < 1) throw Error(Stage::kUsage, "synth", "needs at least one building");
  if (options.is_varied && options.sizes == SynthSizes::kMixed)
    throw Error(Stage::kUsage, "synth", "mixed sizes are for streets that are not varied");
  if ((options.has_slopes || options.plans != SynthPlans::kAny) && !options.is_varied)
    throw Error(Stage::kUsage, "synth", "sloping ground and plans are of varied streets only");
  if (!(options.scan_edge > 0))
    throw Error(Stage::kUsage, "synth", "the length of a scan's edges must be positive");
  if (!(options.noise >= 0) || !(options.density > 0))
    throw Error(Stage::kUsage, "synth", "noise must not be negative, density must be positive");
  const std::vector<House> houses = build_houses(options);
  const std::vector<Site> sites = place_houses(houses, options.seed);
  std::vector<SynthBuilding> buildings(houses.size());
  parallel_for(houses.size(), [&](std::size_t i) {
    buildings[i] = finish(houses[i], sites[i], static_cast<int>(i), options.sizes);
  });
  if (options.is_drone) {
    fly_over(buildings, options);
  } else if (options.is_scan) {
    std::vector<Vec3> to_street;
    for (const Site& s : sites) to_street.push_back(s.to_world(-Vec3::UnitY()) - s.origin);
    scan_neighbourhood(buildings, to_street, options);
  }
  return buildings;
}

std::string truth_json(const std::vector<SynthBuilding>& buildings, const SynthOptions& options) {
  nlohmann::ordered_json root;
  root["options"] = {{"buildings", options.buildings},
                     {"seed", options.seed},
                     {"scan", options.is_scan},
                     {"noise", options.noise},
                     {"density", options.density}};
  if (options.sizes == SynthSizes::kMixed) root["options"]["sizes"] = "mixed";
  if (options.is_varied) root["options"]["variety"] = true;
  if (options.is_drone) root["options"]["drone"] = true;
  if (options.is_drone) root["options"]["scan_edge"] = options.scan_edge;
  if (options.has_slopes) root["options"]["slopes"] = true;
  root["buildings"] = nlohmann::ordered_json::array();
  for (const SynthBuilding& b : buildings) {
    nlohmann::ordered_json building;
    building["name"] = b.source.name;
    building["style"] = b.style;
    building["faces"] = b.source.mesh.faces.size();
    building["parts"] = nlohmann::ordered_json::array();
    for (const SynthPart& p : b.parts)
      building["parts"].push_back(
          {{"type", name_of(p.kind)},
           {"model", p.model},
           {"instance", p.instance},
           {"level", p.level},
           {"depth", p.depth},
           {"box", {{"min", to_json(p.box.min)}, {"max", to_json(p.box.max)}}}});
    root["buildings"].push_back(building);
  }
  return root.dump(1) + "\n";
}

std::string synth_obj(const SynthBuilding& building) {
  const Mesh& mesh = building.source.mesh;
  std::string text = "# " + building.source.name + ", " + building.style + ", metres, z up\n";
  char line[128];
  for (const Vec3& v : mesh.vertices) {
    std::snprintf(line, sizeof line, "v %.6f %.6f %.6f\n", v.x(), v.y(), v.z());
    text += line;
  }
  std::vector<std::vector<int>> faces_of(building.parts.size() + 1);  // the last: floaters
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const int object = building.source.face_object[f];
    faces_of[object < 0 ? building.parts.size() : object].push_back(static_cast<int>(f));
  }
  for (std::size_t part = 0; part < faces_of.size(); ++part) {
    if (faces_of[part].empty()) continue;
    const std::string type =
        part < building.parts.size() ? name_of(building.parts[part].kind) : "floater";
    text += "g " + type + "__" + std::to_string(part) + "\n";
    for (int f : faces_of[part]) {
      const Face& c = mesh.faces[f];
      std::snprintf(line, sizeof line, "f %d %d %d\n", c[0] + 1, c[1] + 1, c[2] + 1);
      text += line;
    }
  }
  return text;
}

std::string synth_ply(const SynthBuilding& building) {
  const Mesh& mesh = building.source.mesh;
  std::string bytes = "ply\nformat binary_little_endian 1.0\ncomment " + building.source.name +
                      ", " + building.style + ", metres, z up\nelement vertex " +
                      std::to_string(mesh.vertices.size()) +
                      "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
                      std::to_string(mesh.faces.size()) +
                      "\nproperty list uchar int vertex_indices\nproperty int object\nend_header\n";
  for (const Vec3& v : mesh.vertices)
    for (int k = 0; k < 3; ++k) append(bytes, v[k]);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    append(bytes, static_cast<std::uint8_t>(3));
    for (int v : mesh.faces[f]) append(bytes, static_cast<std::int32_t>(v));
    append(bytes, static_cast<std::int32_t>(building.source.face_object[f]));
  }
  return bytes;
}

}  // namespace colod
