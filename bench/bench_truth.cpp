// Which parts of a made-up neighbourhood become visible on which layer.
//
//   bench_truth FOLDER [--ns N] [--layers N] [--rules robust|paper] [--seed N] [--threads N]
//   [--json]
//
// FOLDER is what `colod synth` wrote: meshes whose faces carry part numbers (OBJ groups or the PLY
// property `object`), and truth.json. src/measure/consistency.h says when a part counts as present.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/parallel.h"
#include "measure/consistency.h"
#include "pipeline/pipeline.h"
#include "read/read.h"

using namespace colod;
using nlohmann::json;

namespace {

struct Settings {
  std::string folder, rules = "robust";
  Options options;
  int threads = 0;
  bool is_json = false, has_parts = false;
};

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
                100 * t["of_appearing"].get<double>(), 100 * t["on_expected_layer"].get<double>());
  std::printf(
      "%d of %d buildings failed; greatest difference of a layer's volume from the finest's: %s\n",
      result["failed"].get<int>(), result["buildings"].get<int>(),
      result["volume_difference"].dump().c_str());
}

json run(const Settings& settings) {
  const Truth truth = read_truth((std::filesystem::path(settings.folder) / "truth.json").string());
  const Scene scene = build_scene(read_sources({settings.folder}), settings.options);
  std::vector<PlacedPart> parts;
  for (const Building& b : scene.buildings)
    for (PlacedPart& p : place_parts(b, b.source, truth)) parts.push_back(std::move(p));
  const auto failed = std::count_if(scene.buildings.begin(), scene.buildings.end(),
                                    [](const Building& b) { return b.has_failed(); });
  json result{
      {"folder", settings.folder}, {"rules", settings.rules},
      {"ns", settings.options.ns}, {"buildings", scene.buildings.size()},
      {"failed", failed},          {"volume_difference", volumes(scene, settings.options.layers)}};
  result["types"] = json::parse(consistency_json(tally_parts(parts, settings.options.layers)));
  for (const PlacedPart& p : parts)
    if (settings.has_parts)
      result["parts"].push_back({{"building", p.building},
                                 {"type", name_of(p.kind)},
                                 {"instance", p.instance},
                                 {"level", p.level},
                                 {"depth", p.depth},
                                 {"seen", p.is_seen},
                                 {"first", p.first}});
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
  s.options.rules = s.rules == "paper" ? RuleSet::none() : RuleSet::all();
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
