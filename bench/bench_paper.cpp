// What bench/paper asks of scene files.
//
//   bench_paper detected REFERENCE.colod SCENE.colod
//     The paper's structure detection rate, by matching: the share of REFERENCE's segments to which
//     one of SCENE's is alike, an IoU of their planes' area of at least a half, each at most once.
//     Both files hold the same buildings with the same planes.
//   bench_paper matrix SCENE.colod OUT.png
//     dis and Sim_co between all segments as two squares side by side, buildings one after another:
//     black is 0, white the largest dis, or a similarity of 1.
//   bench_paper scaling SCENE.colod [--rules robust|paper]
//     Processor seconds of the co-analysis of the first 1, 2, 4 … buildings.
// All but `matrix` print JSON.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "core/error.h"
#include "picture/picture.h"
#include "store/store.h"

using namespace colod;
using nlohmann::json;

namespace {

constexpr double kAlike = 0.5;     // IoU from which on two segments are one structure
constexpr int kMostPixels = 1200;  // of a matrix, a side

std::vector<Building> buildings_of(const Store& store) {
  std::vector<Building> buildings;
  for (const std::string& name : store.names()) buildings.push_back(store.building(name));
  return buildings;
}

double area_of(const Building& b, const std::vector<int>& planes) {
  double sum = 0;
  for (const int p : planes) sum += b.planes.planes[p].area;
  return sum;
}

double overlap(const Building& b, const Segment& s, const Segment& t) {
  std::vector<int> both;
  std::set_intersection(s.planes.begin(), s.planes.end(), t.planes.begin(), t.planes.end(),
                        std::back_inserter(both));
  const double common = area_of(b, both);
  return common / std::max(1e-12, area_of(b, s.planes) + area_of(b, t.planes) - common);
}

/// How many of the reference's segments are found. Above a half no segment has two partners.
int matched(const Building& reference, const Building& other) {
  if (reference.planes.planes.size() != other.planes.planes.size())
    throw Error(Stage::kInput, other.source.name, "has other planes than in the reference");
  return static_cast<int>(std::count_if(
      reference.segments.segments.begin(), reference.segments.segments.end(),
      [&](const Segment& s) {
        return std::any_of(other.segments.segments.begin(), other.segments.segments.end(),
                           [&](const Segment& t) { return overlap(reference, s, t) > kAlike; });
      }));
}

json detected(const std::string& reference_path, const std::string& path) {
  const Store reference(reference_path, false), scene(path, false);
  std::size_t wanted = 0, has = 0;
  int found = 0;
  for (const std::string& name : reference.names()) {
    const Building a = reference.building(name), b = scene.building(name);
    if (!a.failure.empty() || !b.failure.empty()) continue;
    wanted += a.segments.segments.size(), has += b.segments.segments.size();
    found += matched(a, b);
  }
  return {{"reference", wanted},
          {"segments", has},
          {"matched", found},
          {"rate", wanted > 0 ? found / static_cast<double>(wanted) : 0.0}};
}

/// A square of n × n values in 0..1, each `scale` pixels wide, into the image from column `left`.
void draw_square(const std::vector<double>& values, std::size_t n, int scale, int left,
                 Image& image) {
  for (int y = 0; y < scale * static_cast<int>(n); ++y)
    for (int x = 0; x < scale * static_cast<int>(n); ++x) {
      const double value = values[static_cast<std::size_t>(y / scale) * n + x / scale];
      const auto grey = static_cast<std::uint8_t>(std::clamp(255 * value, 0.0, 255.0));
      for (int c = 0; c < 3; ++c) image.rgb[3 * (y * image.width + left + x) + c] = grey;
    }
}

void write_matrix(const std::string& path, const std::string& out) {
  const Store store(path, false);
  const double eta = store.options().eta;
  std::vector<Descriptor> all;
  for (const Building& b : buildings_of(store))
    all.insert(all.end(), b.descriptors.begin(), b.descriptors.end());
  const std::size_t n = all.size();
  if (n == 0) throw Error(Stage::kInput, path, "has no segment");
  std::vector<double> distance(n * n), similarity(n * n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      distance[i * n + j] = segment_distance(all[i], all[j], eta),
                       similarity[i * n + j] = segment_similarity(all[i], all[j], eta);
  const double most = std::max(1e-12, *std::max_element(distance.begin(), distance.end()));
  for (double& d : distance) d /= most;
  const int scale = std::max(1, kMostPixels / static_cast<int>(n));
  const int side = scale * static_cast<int>(n), gap = std::max(4, side / 40);
  Image image{2 * side + gap, side, {}};
  image.rgb.assign(std::size_t{3} * image.width * image.height, 255);
  draw_square(distance, n, scale, 0, image);
  draw_square(similarity, n, scale, side + gap, image);
  std::ofstream file(out, std::ios::binary);
  if (!(file << encode_png(image))) throw Error(Stage::kOutput, out, "cannot be written");
}

/// Layer 0 and the layers beyond it, of the first buildings of a scene.
json analyze(const std::vector<Building>& buildings, std::size_t count, Options options) {
  Scene scene;
  scene.buildings.assign(buildings.begin(), buildings.begin() + static_cast<std::ptrdiff_t>(count));
  std::size_t segments = 0;
  for (const Building& b : scene.buildings) segments += b.descriptors.size();
  const std::clock_t start = std::clock();
  analyze_scene(scene, options);
  return {{"buildings", count},
          {"segments", segments},
          {"seconds", static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC},
          {"gap", scene.selection.gap}};
}

json scaling(const std::string& path, const std::string& rules) {
  const Store store(path, false);
  std::vector<Building> buildings = buildings_of(store);
  for (Building& b : buildings) drop_geometry(b);
  Options options = store.options();
  options.rules = rules == "paper" ? RuleSet::none() : RuleSet::all();
  std::set<std::size_t> counts{buildings.size()};
  for (std::size_t n = 1; n < buildings.size(); n *= 2) counts.insert(n);
  json rows = json::array();
  for (const std::size_t n : counts) rows.push_back(analyze(buildings, n, options));
  return rows;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("what bench/paper asks of scene files");
  app.require_subcommand(1);
  std::string first, second, rules = "robust";
  CLI::App* rate = app.add_subcommand("detected", "structure detection rate");
  CLI::App* matrix = app.add_subcommand("matrix", "picture of all distances and similarities");
  CLI::App* growth = app.add_subcommand("scaling", "co-analysis against segments");
  rate->add_option("REFERENCE", first)->required()->check(CLI::ExistingFile);
  rate->add_option("SCENE", second)->required()->check(CLI::ExistingFile);
  matrix->add_option("SCENE", first)->required()->check(CLI::ExistingFile);
  matrix->add_option("OUT", second)->required();
  growth->add_option("SCENE", first)->required()->check(CLI::ExistingFile);
  growth->add_option("--rules", rules)->check(CLI::IsMember({"robust", "paper"}));
  CLI11_PARSE(app, argc, argv);
  try {
    if (rate->parsed()) std::printf("%s\n", detected(first, second).dump().c_str());
    if (matrix->parsed()) write_matrix(first, second);
    if (growth->parsed()) std::printf("%s\n", scaling(first, rules).dump().c_str());
  } catch (const std::exception& e) {
    std::fprintf(stderr, "bench_paper: %s\n", e.what());
    return 1;
  }
  return 0;
}
