// Based on: nothing published; the paper measured consistency by a user study only.
//
// Differs: –
//
// Notation: –
#include "consistency.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "closing.h"
#include "core/error.h"
#include "core/flat.h"
#include "core/rays.h"

namespace colod {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kPresentShare = 0.75;
constexpr double kNearest = 0.25;  // metres at most: a scan has no roof under its dormers, and a
                                   // layer's roof may lie half a relief from them
constexpr double kNearestShare =
    0.5;                            // of the relief: nearer to the part than to the closed building
constexpr double kLeastSeen = 0.1;  // m² that tell
constexpr double kLeastRelief = 0.02;  // metres

struct SampledPart {
  TruthPart truth;
  std::vector<PartSample> samples;  // those that tell
};

/// How near counts as there.
double reach(double relief) { return std::min(kNearest, kNearestShare * relief); }

SampledPart sample_part(const ClosedBuilding& building, const TruthPart& truth) {
  PartRelief relief = building.sample(truth);
  SampledPart part{truth, std::move(relief.samples)};
  if (part.truth.depth < 0) part.truth.depth = std::max(kLeastRelief, relief.depth);
  const double least = std::max(kLeastRelief, reach(part.truth.depth));
  std::erase_if(part.samples, [&](const PartSample& s) { return s.relief < least; });
  return part;
}

/// Whether the mesh has surface on the line through the sample that is nearer to it than to the
/// closed building.
bool is_shown(const PartSample& s, double depth, const RayScene& mesh) {
  const double near = reach(std::isfinite(s.relief) ? s.relief : depth);
  return mesh.is_occluded(s.point - near * s.along, s.along, 0, 2 * near);
}

double telling_area(const SampledPart& part) {
  double area = 0;
  for (const PartSample& s : part.samples) area += s.area;
  return area;
}

double share_near(const SampledPart& part, const RayScene& mesh) {
  const auto shown =
      std::count_if(part.samples.begin(), part.samples.end(),
                    [&](const PartSample& s) { return is_shown(s, part.truth.depth, mesh); });
  return static_cast<double>(shown) / static_cast<double>(part.samples.size());
}

TruthBuilding read_synth_building(const nlohmann::json& b) {
  TruthBuilding building{b.at("name"), {}, {}};
  for (const auto& p : b.at("parts"))
    if (p.at("level") == 0)
      building.main_building.push_back(p.at("instance"));
    else
      building.parts.push_back({kind_named(p.at("type").get<std::string>()), p.at("instance"),
                                p.at("level"), p.at("depth")});
  return building;
}

// kPlain for what is not judged: walls, roofs and what no rule names.
ElementKind kind_of(const nlohmann::json& object) {
  const std::string type = object.value("type", "");
  if (type == "Window") return ElementKind::kWindow;
  if (type == "Door") return ElementKind::kDoor;
  if (type != "BuildingInstallation") return ElementKind::kPlain;
  const auto guess = object.find("function_guess_from_geometry");
  const std::string text =
      guess != object.end() && guess->is_string() ? guess->get<std::string>() : "";
  for (const ElementKind kind : {ElementKind::kChimney, ElementKind::kDormer, ElementKind::kBalcony,
                                 ElementKind::kSteps, ElementKind::kThin})
    if (text.starts_with(name_of(kind))) return kind;
  return ElementKind::kOther;
}

TruthBuilding read_labelled_building(const std::string& name, const nlohmann::json& b) {
  TruthBuilding building{name, {}, {}};
  for (const auto& object : b.at("objects"))
    if (const ElementKind kind = kind_of(object); kind == ElementKind::kPlain)
      building.main_building.push_back(object.at("index"));
    else
      building.parts.push_back({kind, object.at("index"), -1, -1});
  return building;
}

TypeConsistency tally_kind(ElementKind kind, const std::vector<const PlacedPart*>& parts,
                           int layers) {
  TypeConsistency t;
  t.kind = kind;
  t.first.assign(layers, 0), t.present.assign(layers, 0);
  std::vector<double> depths;
  for (const PlacedPart* p : parts) {
    t.unseen += !p->is_seen;
    if (!p->is_seen) continue;
    ++t.seen, depths.push_back(p->depth);
    for (int k = 0; k < layers; ++k) t.present[k] += p->present[k];
    t.never += p->first < 0;
    if (p->first >= 0) ++t.first[p->first];
    t.expected += p->first >= 0 && p->first == p->level;
  }
  t.depth = median(depths);
  const auto most = std::max_element(t.first.begin(), t.first.end());
  if (most == t.first.end() || *most == 0) return t;
  t.majority_layer = static_cast<int>(most - t.first.begin());
  t.on_majority_layer = static_cast<double>(*most) / t.seen;
  t.of_appearing = static_cast<double>(*most) / (t.seen - t.never);
  std::map<std::string, bool> agrees;
  for (const PlacedPart* p : parts)
    if (p->is_seen) {
      const auto at = agrees.emplace(p->building, true).first;
      at->second = at->second && p->first == t.majority_layer;
    }
  t.buildings = static_cast<int>(agrees.size());
  const auto agreeing =
      std::count_if(agrees.begin(), agrees.end(), [](const auto& b) { return b.second; });
  t.buildings_agreeing = static_cast<double>(agreeing) / t.buildings;
  return t;
}

}  // namespace

Truth read_truth(const std::string& path) {
  std::ifstream in(path);
  if (!in) throw Error(Stage::kInput, path, "cannot be opened");
  Truth truth;
  try {
    const nlohmann::json json = nlohmann::json::parse(in);
    if (const auto buildings = json.find("buildings");
        buildings != json.end() && buildings->is_array()) {
      for (const auto& b : *buildings) truth.push_back(read_synth_building(b));
    } else {
      for (const auto& [name, b] : json.items())
        if (b.is_object() && b.contains("objects"))
          truth.push_back(read_labelled_building(name, b));
    }
  } catch (const nlohmann::json::exception& e) {
    throw Error(Stage::kInput, path, std::string("no ground truth: ") + e.what());
  }
  if (truth.empty()) throw Error(Stage::kInput, path, "names no building");
  for (TruthBuilding& b : truth) std::sort(b.main_building.begin(), b.main_building.end());
  return truth;
}

std::vector<PlacedPart> place_parts(const Source& source, const TruthBuilding& truth,
                                    const std::vector<Mesh>& layers) {
  if (source.face_object.size() != source.mesh.faces.size() || source.face_object.empty())
    throw Error(Stage::kInput, source.name,
                "its faces carry no object numbers to hold against the truth");
  std::vector<RayScene> scenes;
  for (const Mesh& mesh : layers) scenes.emplace_back(mesh);
  const int count = static_cast<int>(layers.size());
  const ClosedBuilding building(source, truth);
  std::vector<PlacedPart> placed;
  for (const TruthPart& judged : truth.parts) {
    const SampledPart part = sample_part(building, judged);
    PlacedPart p{.building = truth.name,
                 .kind = part.truth.kind,
                 .instance = part.truth.instance,
                 .level = part.truth.level,
                 .depth = part.truth.depth,
                 .is_seen = telling_area(part) >= kLeastSeen,
                 .first = -1,
                 .present = std::vector<char>(count, 0),
                 .near = std::vector<double>(count, 0)};
    int first = count;
    for (int k = count; k-- > 0 && p.is_seen;) {
      p.near[k] = share_near(part, scenes[k]);
      p.present[k] = p.near[k] >= kPresentShare;
      if (p.present[k] && first == k + 1) first = k;
    }
    if (first < count) p.first = first;
    placed.push_back(std::move(p));
  }
  return placed;
}

std::vector<TypeConsistency> tally_parts(const std::vector<PlacedPart>& parts, int layers) {
  std::map<std::string, std::vector<const PlacedPart*>> by_name;
  for (const PlacedPart& p : parts) by_name[name_of(p.kind)].push_back(&p);
  std::vector<TypeConsistency> types;
  for (const auto& [name, members] : by_name)
    types.push_back(tally_kind(members.front()->kind, members, layers));
  return types;
}

std::string consistency_json(const std::vector<TypeConsistency>& types) {
  Json json = Json::object();
  for (const TypeConsistency& t : types)
    json[name_of(t.kind)] = {
        {"seen", t.seen},
        {"unseen", t.unseen},
        {"never", t.never},
        {"first", t.first},
        {"present", t.present},
        {"depth", t.depth},
        {"majority_layer", t.majority_layer},
        {"on_majority_layer", t.on_majority_layer},
        {"of_appearing", t.of_appearing},
        {"on_expected_layer",
         t.seen > t.never ? static_cast<double>(t.expected) / (t.seen - t.never) : 0},
        {"buildings", t.buildings},
        {"buildings_agreeing", t.buildings_agreeing}};
  return json.dump();
}

}  // namespace colod
