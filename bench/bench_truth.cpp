// Which parts of a made-up neighbourhood become visible on which layer.
//
//   bench_truth FOLDER [--ns N] [--layers N] [--rules robust|paper] [--seed N] [--threads N]
//   [--json]
//
// FOLDER is what `colod synth` wrote: meshes whose faces carry part numbers (OBJ groups or the PLY
// property `object`), and truth.json. A part counts as present on a layer when three quarters of
// its telling samples lie within half its relief of the layer's mesh; telling are points on the
// part's own faces that are farther than that from the faces of body, roof and tower. A part
// appears on the first layer from which on it is present. Parts whose faces the mesh does not show
// (a scan sees no back yard) are not counted.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "../src/error.h"
#include "../src/mesh_io.h"
#include "../src/parallel.h"
#include "../src/pipeline.h"
#include "../src/rays.h"

using namespace colod;
using nlohmann::json;

namespace {

constexpr double kPresentShare = 0.75;
constexpr double kSpacing = 0.1;  // metres between samples
constexpr int kLeastSamples = 20;

struct Settings {
  std::string folder, rules = "robust";
  Options options;
  int threads = 0;
  bool is_json = false, has_parts = false;
};

struct Part {
  std::string type;
  int instance = 0, level = 0;
  double depth = 0;
  std::vector<Vec3> samples;  ///< the telling ones
};

/// Per type. `first[k]`: appear on layer k; `present[k]`: are present there.
struct Tally {
  int seen = 0, unseen = 0, never = 0, expected = 0;
  std::vector<int> first, present;

  int appearing() const { return seen - never; }
  json to_json() const {
    const int most = *std::max_element(first.begin(), first.end());
    return {{"seen", seen},
            {"unseen", unseen},
            {"never", never},
            {"first", first},
            {"present", present},
            {"on_majority_layer", appearing() ? double(most) / appearing() : 0},
            {"on_expected_layer", appearing() ? double(expected) / appearing() : 0}};
  }
};

/// Evenly over a triangle, about one a square of kSpacing.
void sample_face(const Mesh& mesh, const Face& f, std::vector<Vec3>& samples) {
  const Vec3 &a = mesh.vertices[f[0]], &b = mesh.vertices[f[1]], &c = mesh.vertices[f[2]];
  const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  const int n = std::clamp(static_cast<int>(longest / kSpacing), 1, 200);
  for (int i = 0; i < n; ++i)
    for (int j = 0; i + j < n; ++j) {
      const double u = (i + 1.0 / 3) / n, v = (j + 1.0 / 3) / n;
      samples.push_back(a + u * (b - a) + v * (c - a));
    }
}

RayScene faces_of(const Source& source, const std::vector<int>& objects) {
  Mesh mesh{source.mesh.vertices, {}};
  for (std::size_t f = 0; f < source.mesh.faces.size(); ++f)
    if (std::find(objects.begin(), objects.end(), source.face_object[f]) != objects.end())
      mesh.faces.push_back(source.mesh.faces[f]);
  return RayScene(mesh);
}

/// The parts that are detail, with samples in the building's frame.
std::vector<Part> read_parts(const Source& source, const json& truth) {
  std::vector<Part> parts;
  std::map<int, std::size_t> part_of;
  std::vector<int> body;
  for (const json& p : truth["parts"]) {
    if (p["level"] == 0) {
      body.push_back(p["instance"]);
      continue;
    }
    part_of[p["instance"]] = parts.size();
    parts.push_back({p["type"], p["instance"], p["level"], p["depth"], {}});
  }
  for (std::size_t f = 0; f < source.mesh.faces.size(); ++f)
    if (const auto at = part_of.find(source.face_object[f]); at != part_of.end())
      sample_face(source.mesh, source.mesh.faces[f], parts[at->second].samples);
  const RayScene rest = faces_of(source, body);
  for (Part& part : parts)
    std::erase_if(part.samples, [&](const Vec3& x) {
      const NearestPoint near = rest.nearest(x);
      return near.triangle >= 0 && near.distance <= 0.5 * part.depth;
    });
  return parts;
}

bool is_present(const Part& part, const RayScene& mesh, const Frame& turn) {
  std::size_t near = 0;
  for (const Vec3& x : part.samples) {
    const NearestPoint point = mesh.nearest(turn.to_world(x));
    near += point.triangle >= 0 && point.distance <= 0.5 * part.depth;
  }
  return static_cast<double>(near) >= kPresentShare * static_cast<double>(part.samples.size());
}

void tally_building(const Building& b, const json& truth, int layers,
                    std::map<std::string, Tally>& tallies, json& parts) {
  const Frame turn{Vec3::Zero(), b.frame.yaw};  // layers are parallel to the world's axes
  std::vector<RayScene> meshes;
  for (const Layer& layer : b.layers) meshes.emplace_back(layer.mesh.mesh());
  for (const Part& part : read_parts(b.source, truth)) {
    parts.push_back(
        {{"building", b.source.name}, {"type", part.type}, {"instance", part.instance}});
    Tally& t = tallies[part.type];
    t.first.resize(layers), t.present.resize(layers);
    if (part.samples.size() < kLeastSamples) {
      ++t.unseen;
      continue;
    }
    ++t.seen;
    int first = layers;
    for (int k = layers; k-- > 0;) {
      const bool is_here = is_present(part, meshes[k], turn);
      t.present[k] += is_here;
      if (is_here && first == k + 1) first = k;
    }
    if (first == layers)
      ++t.never;
    else
      ++t.first[first], t.expected += first == part.level;
    parts.back()["level"] = part.level, parts.back()["first"] = first < layers ? first : -1;
  }
}

json read_truth(const std::string& folder) {
  std::ifstream in(std::filesystem::path(folder) / "truth.json");
  if (!in) throw Error(Stage::kInput, folder, "no truth.json");
  return json::parse(in);
}

/// The body: volume of each layer against the finest.
json volumes(const Scene& scene, int layers) {
  json result = json::array();
  for (int k = 0; k < layers; ++k) {
    double worst = 0;
    for (const Building& b : scene.buildings)
      if (!b.has_failed())
        worst = std::max(
            worst, std::abs(b.layers[k].validity.volume / b.layers.back().validity.volume - 1));
    result.push_back(worst);
  }
  return result;
}

void print(const json& result) {
  std::printf("%-10s %5s %6s %6s  %-14s %-16s %9s %9s\n", "type", "seen", "unseen", "never",
              "appear on", "present on", "majority", "expected");
  const auto row = [](const json& counts) {
    std::string text;
    for (const json& n : counts) text += (text.empty() ? "" : "/") + n.dump();
    return text;
  };
  for (const auto& [type, t] : result["types"].items())
    std::printf("%-10s %5d %6d %6d  %-14s %-16s %8.0f%% %8.0f%%\n", type.c_str(),
                t["seen"].get<int>(), t["unseen"].get<int>(), t["never"].get<int>(),
                row(t["first"]).c_str(), row(t["present"]).c_str(),
                100 * t["on_majority_layer"].get<double>(),
                100 * t["on_expected_layer"].get<double>());
  std::printf(
      "%d of %d buildings failed; greatest difference of a layer's volume from the finest's: %s\n",
      result["failed"].get<int>(), result["buildings"].get<int>(),
      result["volume_difference"].dump().c_str());
}

json run(const Settings& settings) {
  const json truth = read_truth(settings.folder);
  const Scene scene = build_scene(read_sources({settings.folder}), settings.options);
  std::map<std::string, Tally> tallies;
  int failed = 0;
  json parts = json::array();
  for (const Building& b : scene.buildings) {
    const auto at = std::find_if(truth["buildings"].begin(), truth["buildings"].end(),
                                 [&](const json& t) { return t["name"] == b.source.name; });
    if (at == truth["buildings"].end())
      throw Error(Stage::kInput, b.source.name, "truth.json does not name this building");
    if (b.has_failed())
      ++failed;
    else
      tally_building(b, *at, settings.options.layers, tallies, parts);
  }
  json result{
      {"folder", settings.folder}, {"rules", settings.rules},
      {"ns", settings.options.ns}, {"buildings", scene.buildings.size()},
      {"failed", failed},          {"volume_difference", volumes(scene, settings.options.layers)}};
  for (const auto& [type, t] : tallies) result["types"][type] = t.to_json();
  if (settings.has_parts) result["parts"] = std::move(parts);
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  Settings s;
  s.options.ns = 64;
  CLI::App app("which parts of a made-up neighbourhood become visible on which layer");
  app.add_option("folder", s.folder)->required()->check(CLI::ExistingDirectory);
  app.add_option("--ns", s.options.ns);
  app.add_option("--layers", s.options.layers);
  app.add_option("--seed", s.options.seed);
  app.add_option("--rules", s.rules)->check(CLI::IsMember({"robust", "paper"}));
  app.add_option("--threads", s.threads);
  app.add_flag("--json", s.is_json);
  app.add_flag("--parts", s.has_parts,
               "with --json: every part, and the layer on which it appears");
  CLI11_PARSE(app, argc, argv);
  s.options.rules = s.rules == "paper" ? Rules::kPaper : Rules::kRobust;
  try {
    validate(s.options);
    limit_threads(s.threads);
    const json result = run(s);
    if (s.is_json)
      std::printf("%s\n", result.dump(1).c_str());
    else
      print(result);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "bench_truth: %s\n", e.what());
    return 1;
  }
}
