// How much of a scene's layers hangs on one building, or on the seed: the scene is analysed again
// without each of its buildings, and with other seeds, and the segments of the others whose layer
// is another then are counted.
//   bench_stability SCENE.colod... [--seeds 8] [--json]     SCENE.colod: of `colod segment`,
//   analysed or not
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/flat.h"
#include "store/store.h"

using namespace colod;

namespace {

/// Shares of segments that have another layer, one for each repetition.
struct Moves {
  std::vector<double> without_one;
  std::vector<double> seeds;
};

std::vector<Building> read_buildings(const Store& store) {
  std::vector<Building> buildings;
  for (const std::string& name : store.names()) {
    Building b = store.building(name);
    if (!b.failure.empty()) continue;
    drop_geometry(b);
    buildings.push_back(std::move(b));
  }
  return buildings;
}

/// Sets layer_of_segment.
void analyze(std::vector<Building>& buildings, const Options& options) {
  Scene scene;
  scene.buildings = std::move(buildings);
  analyze_scene(scene, options);
  buildings = std::move(scene.buildings);
}

/// Of the segments of `later`, how many lie elsewhere than in `before`, which has these buildings
/// and perhaps one more.
double moved(const std::vector<Building>& before, const std::vector<Building>& later) {
  std::size_t differ = 0, all = 0, at = 0;
  for (const Building& b : later) {
    while (before[at].source.name != b.source.name) ++at;
    all += b.layer_of_segment.size();
    for (std::size_t s = 0; s < b.layer_of_segment.size(); ++s)
      differ += b.layer_of_segment[s] != before[at].layer_of_segment[s];
  }
  return all == 0 ? 0 : static_cast<double>(differ) / static_cast<double>(all);
}

Moves measure(const std::string& path, int seeds) {
  const Store store(path, false);
  Options options = store.options();
  std::vector<Building> all = read_buildings(store);
  analyze(all, options);
  Moves moves;
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::vector<Building> rest = all;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
    analyze(rest, options);
    moves.without_one.push_back(moved(all, rest));
  }
  for (int k = 0; k < seeds; ++k) {
    ++options.seed;
    std::vector<Building> again = all;
    analyze(again, options);
    moves.seeds.push_back(moved(all, again));
  }
  return moves;
}

nlohmann::json facts(std::vector<double> shares) {
  if (shares.empty()) return nullptr;
  double sum = 0;
  for (const double s : shares) sum += s;
  return {{"repetitions", shares.size()},
          {"mean", sum / static_cast<double>(shares.size())},
          {"worst", *std::max_element(shares.begin(), shares.end())},
          {"median", median(shares)}};
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"How much of a scene's layers hangs on one building, or on the seed"};
  std::vector<std::string> scenes;
  int seeds = 8;
  bool is_json = false;
  app.add_option("scenes", scenes, "scene files with segments")->required();
  app.add_option("--seeds", seeds, "other seeds to try")->check(CLI::Range(0, 1000));
  app.add_flag("--json", is_json, "JSON instead of a table");
  CLI11_PARSE(app, argc, argv);
  nlohmann::json all = nlohmann::json::array();
  try {
    for (const std::string& path : scenes) {
      const Moves moves = measure(path, seeds);
      all.push_back({{"scene", path},
                     {"without_one", facts(moves.without_one)},
                     {"seeds", facts(moves.seeds)}});
    }
  } catch (const std::exception& e) {
    std::fprintf(stderr, "bench_stability: %s\n", e.what());
    return 1;
  }
  if (is_json) {
    std::printf("%s\n", all.dump(2).c_str());
    return 0;
  }
  std::printf(
      "| scene | without one building: moved in the mean | worst | with another seed: mean | worst "
      "|\n|---|---|---|---|---|\n");
  const auto cell = [](const nlohmann::json& f, const char* key) {
    return f.is_null() ? 0 : 100 * f[key].get<double>();
  };
  for (const nlohmann::json& f : all)
    std::printf("| %s | %.1f %% | %.1f %% | %.1f %% | %.1f %% |\n",
                f["scene"].get<std::string>().c_str(), cell(f["without_one"], "mean"),
                cell(f["without_one"], "worst"), cell(f["seeds"], "mean"),
                cell(f["seeds"], "worst"));
}
