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
#include <nlohmann/json.hpp>

#include "bodies.h"
#include "core/bytes.h"
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
constexpr int kBatch = 16;            // houses at a time
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

/// What of a house decides where it and the others stand.
struct Lot {
  std::string style;
  double width, depth, before, beside;  ///< as in House
};

bool is_row_house(const Lot& lot) { return lot.style == "row_house"; }

/// Four frontages, both sides of two streets that drift apart. The houses of one are placed side by
/// side; only row houses touch.
std::vector<Site> place_houses(const std::vector<Lot>& houses, std::uint64_t seed) {
  constexpr double kStreetYaw[2] = {-0.07, 0.09};  // rad
  double deepest = 0;
  for (const Lot& h : houses) deepest = std::max(deepest, h.depth + 2 * h.before);
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

bool overlap(const Box& a, const Box& b) {
  return (a.min.array() <= b.max.array()).all() && (b.min.array() <= a.max.array()).all();
}

/// Where all houses stand; the houses themselves are made when they are asked for.
class Street {
 public:
  explicit Street(const SynthOptions& options)
      : options_(options), catalogue_(options.seed), styles_(choose_styles(options)) {
    std::vector<Lot> lots(styles_.size());
    parallel_for(lots.size(), [&](std::size_t i) {
      const House house = make(static_cast<int>(i));
      lots[i] = {house.style, house.width, house.depth, house.before, house.beside};
    });
    sites_ = place_houses(lots, options.seed);
    if (!options.is_scan && !options.is_drone) return;
    boxes_.resize(lots.size());
    parallel_for(lots.size(), [&](std::size_t i) {
      boxes_[i] = bounding_box(clean(static_cast<int>(i)).source.mesh.vertices);
    });
    for (const Box& box : boxes_) whole_.extend(box);
  }

  SynthBatch batch(int first, int count) const {
    SynthBatch batch;
    batch.buildings.resize(count);
    parallel_for(count,
                 [&](std::size_t i) { batch.buildings[i] = clean(first + static_cast<int>(i)); });
    if (!options_.is_scan && !options_.is_drone) return batch;
    batch.clean = batch.buildings;
    if (options_.is_drone)
      fly_over(batch.buildings, first, around(first, count), options_);
    else
      scan(batch.buildings, first);
    return batch;
  }

 private:
  House make(int i) const {
    const std::uint64_t seed = building_seed(options_.seed, i);
    if (options_.is_varied) return make_varied_house(i, seed, options_);
    if (options_.sizes == SynthSizes::kMixed)
      return make_mixed_house(i, styles_[i], options_.seed, seed);
    return make_house(styles_[i], seed, catalogue_);
  }
  SynthBuilding clean(int i) const { return finish(make(i), sites_[i], i, options_.sizes); }

  Vec3 to_street(int i) const { return sites_[i].to_world(-Vec3::UnitY()) - sites_[i].origin; }

  /// What may lie between a building and who looks at it.
  Box reach(int i) const {
    if (!options_.is_drone) return scan_reach(boxes_[i], to_street(i));
    return {boxes_[i].min - Vec3::Constant(kMostSkirt), boxes_[i].max + Vec3::Constant(kMostSkirt)};
  }

  std::vector<NumberedModel> around(int first, int count) const {
    std::vector<Box> reaches;
    for (int i = first; i < first + count; ++i) reaches.push_back(reach(i));
    std::vector<NumberedModel> models;
    for (int i = 0; i < static_cast<int>(boxes_.size()); ++i)
      if (std::any_of(reaches.begin(), reaches.end(),
                      [&](const Box& r) { return overlap(r, boxes_[i]); }))
        models.push_back({i, {}});
    parallel_for(models.size(),
                 [&](std::size_t i) { models[i].mesh = clean(models[i].number).source.mesh; });
    return models;
  }

  void scan(std::vector<SynthBuilding>& buildings, int first) const {
    const int count = static_cast<int>(buildings.size());
    std::vector<Vec3> to_streets;
    for (int i = first; i < first + count; ++i) to_streets.push_back(to_street(i));
    Mesh all;
    for (const auto& [number, mesh] : around(first, count)) {
      const int base = static_cast<int>(all.vertices.size());
      all.vertices.insert(all.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
      for (const Face& f : mesh.faces) all.faces.push_back({f[0] + base, f[1] + base, f[2] + base});
    }
    scan_buildings(buildings, first, all, whole_, to_streets, options_);
  }

  SynthOptions options_;
  Catalogue catalogue_;
  std::vector<int> styles_;
  std::vector<Site> sites_;
  std::vector<Box> boxes_;  // of scans
  Box whole_;
};

void check(const SynthOptions& options) {
  if (options.buildings < 1) throw Error(Stage::kUsage, "synth", "needs at least one building");
  if (options.is_varied && options.sizes == SynthSizes::kMixed)
    throw Error(Stage::kUsage, "synth", "mixed sizes are for streets that are not varied");
  if ((options.has_slopes || options.plans != SynthPlans::kAny) && !options.is_varied)
    throw Error(Stage::kUsage, "synth", "sloping ground and plans are of varied streets only");
  if (!(options.scan_edge > 0))
    throw Error(Stage::kUsage, "synth", "the length of a scan's edges must be positive");
  if (!(options.noise >= 0) || !(options.density > 0))
    throw Error(Stage::kUsage, "synth", "noise must not be negative, density must be positive");
}

nlohmann::json to_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

std::vector<SynthBuilding> make_neighbourhood(const SynthOptions& options) {
  std::vector<SynthBuilding> buildings;
  stream_neighbourhood(options, [&](const SynthBatch& batch) {
    buildings.insert(buildings.end(), batch.buildings.begin(), batch.buildings.end());
  });
  return buildings;
}

void stream_neighbourhood(const SynthOptions& options,
                          const std::function<void(const SynthBatch&)>& take) {
  check(options);
  const Street street(options);
  for (int first = 0; first < options.buildings; first += kBatch)
    take(street.batch(first, std::min(kBatch, options.buildings - first)));
}

std::string truth_json(const std::vector<SynthBuilding>& buildings, const SynthOptions& options) {
  std::string text = truth_before(options);
  for (std::size_t i = 0; i < buildings.size(); ++i)
    text += (i > 0 ? ",\n" : "") + truth_entry(buildings[i]);
  return text + truth_after();
}

std::string truth_before(const SynthOptions& options) {
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
  const std::string text = root.dump(1);
  return text.substr(0, text.rfind("\n}")) + ",\n \"buildings\": [\n";
}

std::string truth_entry(const SynthBuilding& b) {
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
  std::string text;
  for (const char c : "\n" + building.dump(1)) text += c == '\n' ? "\n  " : std::string(1, c);
  return text.substr(1);
}

std::string truth_after() { return "\n ]\n}\n"; }

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
    for (int k = 0; k < 3; ++k) put(bytes, v[k]);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    put(bytes, static_cast<std::uint8_t>(3));
    for (int v : mesh.faces[f]) put(bytes, static_cast<std::int32_t>(v));
    put(bytes, static_cast<std::int32_t>(building.source.face_object[f]));
  }
  return bytes;
}

}  // namespace colod
