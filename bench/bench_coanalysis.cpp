// Time, memory and gap of the co-analysis alone, on generated descriptors.
//
//   bench_coanalysis --buildings B --segments S [--seed N] [--layers N] [--paper]
//   [--gap G] [--prototypes N] [--exact N] [--threads N] [--json]
//
// Similarities, layer 0 and the layers of S segments in B buildings. --json prints one line.
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "coanalysis/clustering.h"
#include "core/parallel.h"
#include "generated_scene.h"

using namespace colod;

namespace {

struct Settings {
  int buildings = 37, segments = 814, threads = 0;
  std::uint64_t seed = 1;
  SelectionOptions selection;
  ClusteringOptions clustering;
  bool is_json = false;
};

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double cpu_seconds(const rusage& usage) {
  return static_cast<double>(usage.ru_utime.tv_sec) +
         1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
}

std::int64_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::int64_t>(usage.ru_maxrss) * 1024;
}

nlohmann::ordered_json run(const Settings& settings) {
  const auto scene = bench::generated_scene(settings.buildings, settings.segments, settings.seed);
  const auto start = std::chrono::steady_clock::now();
  const Selection selection = select_layer0(scene, settings.selection);
  const double selection_seconds = seconds_since(start);
  const std::int64_t selection_memory = peak_memory();
  std::vector<Descriptor> rest;
  for (std::size_t i = 0; i < scene.size(); ++i)
    for (std::size_t s = 0; s < scene[i].segments.size(); ++s)
      if (!selection.is_layer0[i][s]) rest.push_back(scene[i].segments[s]);
  const Clustering clustering = cluster_segments(rest, settings.clustering);
  const double seconds = seconds_since(start);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::vector<int> layers(settings.clustering.layers, 0);
  for (const int layer : clustering.layer) ++layers[layer];
  layers[0] = settings.segments - static_cast<int>(rest.size());
  return {{"buildings", settings.buildings},
          {"segments", settings.segments},
          {"seconds", seconds},
          {"objective", selection.objective},
          {"bound", selection.bound},
          {"gap", selection.gap},
          {"starts", selection.starts},
          {"peak_memory_bytes", peak_memory()},
          {"selection_peak_memory_bytes", selection_memory},
          {"cpu_seconds", cpu_seconds(usage)},
          {"status", to_string(selection.status)},
          {"is_exact", selection.is_exact},
          {"selection_seconds", selection_seconds},
          {"clustering_seconds", seconds - selection_seconds},
          {"layers", layers}};
}

}  // namespace

int main(int argc, char** argv) {
  Settings s;
  bool is_paper = false;
  CLI::App app("time, memory and gap of the co-analysis");
  app.add_option("--buildings", s.buildings)->check(CLI::Range(1, 10000000));
  app.add_option("--segments", s.segments)->check(CLI::Range(1, 10000000));
  app.add_option("--seed", s.seed);
  app.add_option("--layers", s.clustering.layers)->check(CLI::Range(1, 8));
  app.add_flag("--paper", is_paper, "the paper's rules");
  app.add_option("--gap", s.selection.gap, "stop as soon as the gap is no more");
  app.add_option("--prototypes", s.selection.prototypes);
  app.add_option("--exact", s.selection.exact_similarities,
                 "segments up to which all pairs are compared");
  app.add_option("--threads", s.threads);
  app.add_flag("--json", s.is_json, "one line");
  CLI11_PARSE(app, argc, argv);
  s.selection.rules = s.clustering.rules = is_paper ? RuleSet::none() : RuleSet::all();
  s.selection.seed = s.clustering.seed = s.seed;
  limit_threads(s.threads);
  std::printf("%s\n", run(s).dump(s.is_json ? -1 : 2).c_str());
}
