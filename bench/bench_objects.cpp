// How well segments find labelled objects: chimneys, dormers, balconies.
//
//   bench_objects FILE... LABELS.json [--ns N] [--nr N] [--rules robust|paper] [--json]
//
// A FILE is a mesh whose faces carry object numbers (PLY face property `object`, or OBJ groups);
// LABELS.json holds per building (the FILE's stem) `objects` with `index`, `type`, `area_m2` and
// `function_guess_from_geometry`. An object is the set of faces with its number, so its extent is
// ground truth, while its kind is a rule on size and place. Its score is the IoU, by face area,
// with the best segment; its bound the IoU with the best set of planes, which no segment can
// surpass. Objects that the mesh does not show count with 0.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/parallel.h"
#include "read/frame.h"
#include "read/read.h"
#include "segments/segments.h"

using namespace colod;
using nlohmann::json;

namespace {

struct Settings {
  std::vector<std::string> files;
  int ns = 64, nr = 100, threads = 0;
  std::string rules = "robust", plane_rules;
  double alcove_area = 80;
  bool is_json = false, has_objects = false;
};

struct LabelledObject {
  int index = 0;
  std::string kind;
};

struct Score {
  double iou = 0, bound = 0;
  int segment = -1;
};

/// Per kind, or over all buildings.
struct Tally {
  int count = 0, half = 0, third = 0, bound_half = 0;
  double iou = 0, bound = 0;

  void add(const Score& s) {
    ++count, half += s.iou >= 0.5, third += s.iou >= 0.3, bound_half += s.bound >= 0.5;
    iou += s.iou, bound += s.bound;
  }
  void add(const Tally& t) {
    count += t.count, half += t.half, third += t.third, bound_half += t.bound_half;
    iou += t.iou, bound += t.bound;
  }
  json to_json() const {
    const double n = std::max(1, count);
    return {{"count", count},   {"mean_iou", iou / n}, {"iou_0.5", half},
            {"iou_0.3", third}, {"bound", bound / n},  {"bound_0.5", bound_half}};
  }
};

using Tallies = std::map<std::string, Tally>;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Empty for what is not scored: walls, roofs and the like are not one object of one segment.
std::string kind_of(const json& object) {
  const std::string type = object.value("type", "");
  if (type == "Window") return object.value("area_m2", 0.0) >= 1 ? "window" : "";
  if (type != "BuildingInstallation") return "";
  const json& guess = object["function_guess_from_geometry"];
  const std::string text = guess.is_string() ? guess.get<std::string>() : "";
  for (const char* kind : {"chimney", "dormer", "balcony", "steps", "thin"})
    if (text.rfind(kind, 0) == 0) return kind;
  return "other";
}

std::vector<LabelledObject> labelled_objects(const json& labels, const std::string& building) {
  std::vector<LabelledObject> objects;
  if (!labels.contains(building))
    throw Error(Stage::kInput, building, "the labels do not name this building");
  for (const json& object : labels[building]["objects"])
    if (std::string kind = kind_of(object); !kind.empty())
      objects.push_back({object["index"].get<int>(), std::move(kind)});
  return objects;
}

/// The best IoU of `object` with a union of planes: those with the largest share of their area
/// inside it first.
double best_of_planes(const std::vector<double>& inside, const std::vector<double>& area,
                      double object_area) {
  std::vector<std::size_t> order;
  for (std::size_t p = 0; p < inside.size(); ++p)
    if (inside[p] > 0) order.push_back(p);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return inside[a] * area[b] > inside[b] * area[a];
  });
  double best = 0, common = 0, together = object_area;
  for (std::size_t p : order) {
    common += inside[p], together += area[p] - inside[p];
    best = std::max(best, common / together);
  }
  return best;
}

Score score_object(const Source& source, const Planes& planes, const Segments& segments,
                   int object) {
  std::vector<double> inside(planes.planes.size(), 0), area(planes.planes.size(), 0);
  std::vector<double> segment_inside(segments.segments.size(), 0),
      segment_area(segments.segments.size(), 0);
  double object_area = 0;
  for (std::size_t f = 0; f < source.mesh.faces.size(); ++f) {
    const double a = face_area(source.mesh, source.mesh.faces[f]);
    const bool is_inside = source.face_object[f] == object;
    if (is_inside) object_area += a;
    const int p = planes.plane_of_item[f];
    if (p < 0) continue;
    area[p] += a, inside[p] += is_inside ? a : 0;
    const int s = segments.segment_of_plane[p];
    if (s >= 0) segment_area[s] += a, segment_inside[s] += is_inside ? a : 0;
  }
  Score score;
  if (!(object_area > 0)) return score;
  score.bound = best_of_planes(inside, area, object_area);
  for (std::size_t s = 0; s < segment_area.size(); ++s) {
    const double iou = segment_inside[s] / (object_area + segment_area[s] - segment_inside[s]);
    if (iou > score.iou) score.iou = iou, score.segment = static_cast<int>(s);
  }
  return score;
}

json run_building(const std::string& path, const json& labels, const Settings& settings,
                  Tallies& tallies) {
  auto clock = std::chrono::steady_clock::now();
  const auto lap = [&clock] {
    const double seconds = seconds_since(clock);
    clock = std::chrono::steady_clock::now();
    return seconds;
  };
  json seconds;
  const std::string building = std::filesystem::path(path).stem().string();
  const std::vector<LabelledObject> objects = labelled_objects(labels, building);
  const Source read = read_single(path);
  const Source source = localize(read, main_frame(read));
  if (source.face_object.empty())
    throw Error(Stage::kInput, path, "its faces carry no object numbers");
  seconds["read"] = lap();

  PlaneOptions plane_options;
  plane_options.rules = settings.plane_rules == "paper" ? RuleSet::none() : RuleSet::all();
  const Planes planes = detect_planes(source, plane_options);
  seconds["planes"] = lap();

  SegmentOptions options;
  options.rules = settings.rules == "paper" ? RuleSet::none() : RuleSet::all();
  options.alcove_area = settings.alcove_area;
  options.visibility.ns = settings.ns, options.visibility.nr = settings.nr;
  const Segments segments = build_segments(planes, options);
  seconds["visibility"] = segments.visibility_seconds;
  seconds["aggregation"] = segments.aggregation_seconds;

  Tallies own;
  json each = json::array();
  for (const LabelledObject& object : objects) {
    const Score score = score_object(source, planes, segments, object.index);
    own[object.kind].add(score);
    each.push_back({{"index", object.index},
                    {"kind", object.kind},
                    {"iou", score.iou},
                    {"bound", score.bound},
                    {"segment", score.segment}});
  }
  json out = {{"building", building},
              {"rules", settings.rules},
              {"plane_rules", settings.plane_rules},
              {"ns", settings.ns},
              {"nr", settings.nr},
              {"planes", planes.planes.size()},
              {"segments", segments.segments.size()},
              {"seconds", seconds},
              {"kinds", json::object()}};
  out["alcoves"] = std::count_if(segments.segments.begin(), segments.segments.end(),
                                 [](const Segment& s) { return s.is_alcove; });
  for (const auto& [kind, tally] : own) {
    out["kinds"][kind] = tally.to_json();
    tallies[kind].add(tally);
  }
  if (settings.has_objects) out["objects"] = each;
  return out;
}

void print_line(const json& result, bool is_json) {
  if (is_json) {
    std::printf("%s\n", result.dump().c_str());
    return;
  }
  std::printf("%-10s %4d planes %4d segments", result["building"].get<std::string>().c_str(),
              result["planes"].get<int>(), result["segments"].get<int>());
  for (const auto& [kind, t] : result["kinds"].items())
    std::printf("  %s %.2f (%d/%d of %d, bound %.2f)", kind.c_str(), t["mean_iou"].get<double>(),
                t["iou_0.5"].get<int>(), t["iou_0.3"].get<int>(), t["count"].get<int>(),
                t["bound"].get<double>());
  std::printf("\n");
}

int run(const Settings& settings) {
  std::ifstream stream(settings.files.back());
  if (!stream) throw Error(Stage::kInput, settings.files.back(), "cannot be opened");
  const json labels = json::parse(stream);
  Tallies tallies;
  json total = {{"building", "total"},
                {"planes", 0},
                {"segments", 0},
                {"kinds", json::object()},
                {"seconds", json::object()}};
  for (std::size_t i = 0; i + 1 < settings.files.size(); ++i) {
    const json result = run_building(settings.files[i], labels, settings, tallies);
    for (const char* sum : {"planes", "segments"})
      total[sum] = total[sum].get<int>() + result[sum].get<int>();
    for (const auto& [stage, s] : result["seconds"].items())
      total["seconds"][stage] = total["seconds"].value(stage, 0.0) + s.get<double>();
    print_line(result, settings.is_json);
    std::fflush(stdout);
  }
  for (const auto& [kind, tally] : tallies) total["kinds"][kind] = tally.to_json();
  if (settings.files.size() > 2) print_line(total, settings.is_json);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  CLI::App app("How well segments find labelled objects");
  app.add_option("files", settings.files, "FILE... LABELS.json")->required()->expected(2, -1);
  app.add_option("--ns", settings.ns, "voxels a side")->check(CLI::Range(4, 1000));
  app.add_option("--nr", settings.nr, "rays a voxel")->check(CLI::Range(4, 1000));
  app.add_option("--rules", settings.rules)->check(CLI::IsMember({"robust", "paper"}));
  app.add_option("--plane-rules", settings.plane_rules, "as --rules unless given")
      ->check(CLI::IsMember({"robust", "paper"}));
  app.add_option("--alcove-area", settings.alcove_area, "m2");
  app.add_option("--threads", settings.threads);
  app.add_flag("--json", settings.is_json, "one JSON line a building instead of a table");
  app.add_flag("--objects", settings.has_objects, "with --json: every object");
  CLI11_PARSE(app, argc, argv);
  if (settings.plane_rules.empty()) settings.plane_rules = settings.rules;
  limit_threads(settings.threads);
  try {
    return run(settings);
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return static_cast<int>(error.stage);
  } catch (const json::exception& error) {
    std::fprintf(stderr, "labels: %s\n", error.what());
    return static_cast<int>(Stage::kInput);
  }
}
