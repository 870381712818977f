// Time and memory of a merge's tileset over very many buildings, each two boxes of one level: how
// large a scene's tree can become before it, or the root, breaks.
//
//   bench_tileset --buildings N [--threads N] [--json]
//
// Streets of houses 20 m apart; nothing is written, sizes alone are counted. --json prints one
// line.
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/parallel.h"
#include "exporters/tiles3d/tiles3d.h"

using namespace colod;

namespace {

constexpr double kPitch = 20;  // metres from house to house

PolygonMesh box_of(double height) {
  StandInBox box;
  box.half = {5, 4, height};
  return mesh_of(box);
}

ExportBuilding house(int number, int row) {
  ExportBuilding b{.name = "house_" + std::to_string(number),
                   .source = "city.gml",
                   .origin = Vec3(kPitch * (number % row), kPitch * (number / row), 0),
                   .levels = {}};
  b.levels.push_back({.layers = {0}, .mesh = {}, .gsd = 0.5, .deviation = 1});
  b.levels.push_back({.layers = {1, 2}, .mesh = {}});
  return b;
}

nlohmann::ordered_json run(int count) {
  const auto start = std::chrono::steady_clock::now();
  const int row = static_cast<int>(std::ceil(std::sqrt(count)));
  std::vector<ExportBuilding> buildings;
  std::vector<TileOutline> outlines;
  for (int i = 0; i < count; ++i) {
    buildings.push_back(house(i, row));
    TileOutline o;
    o.box = {buildings.back().origin + Vec3(-5, -4, 0), buildings.back().origin + Vec3(5, 4, 6)};
    o.triangles = 10;
    o.stand_in.origin = buildings.back().origin;
    o.stand_in.half = {5, 4, 6};
    o.stand_in.gsd = 2, o.stand_in.error = 1;
    outlines.push_back(o);
  }
  const PolygonMesh coarse = box_of(6), fine = box_of(7);
  const LevelDepot depot{
      .get =
          [&](int b) {
            buildings[static_cast<std::size_t>(b)].levels[0].mesh = coarse;
            buildings[static_cast<std::size_t>(b)].levels[1].mesh = fine;
          },
      .drop =
          [&](int b) {
            for (ExportLevel& level : buildings[static_cast<std::size_t>(b)].levels)
              level.mesh = {};
          },
      .coarsest = [](int) { return CoarsestLook{}; }};
  std::atomic<std::size_t> files = 0, bytes = 0;
  const auto rest = encode_tileset(buildings, outlines, depot, {}, [&](const Encoded& file) {
    ++files, bytes += file.bytes.size();
  });
  ++files, bytes += rest.front().bytes.size();  // tileset.json, which is not handed over
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return {
      {"buildings", count},
      {"seconds", std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()},
      {"cpu_seconds", static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec)},
      {"peak_memory_bytes", static_cast<std::int64_t>(usage.ru_maxrss) * 1024},
      {"files", files.load()},
      {"bytes", bytes.load()},
      {"root_tileset_bytes", rest.front().bytes.size()}};
}

}  // namespace

int main(int argc, char** argv) {
  int buildings = 1000, threads = 0;
  bool is_json = false;
  CLI::App app("time and memory of a tileset over very many buildings");
  app.add_option("--buildings", buildings)->check(CLI::Range(1, 20000000));
  app.add_option("--threads", threads);
  app.add_flag("--json", is_json, "one line");
  CLI11_PARSE(app, argc, argv);
  limit_threads(threads);
  std::printf("%s\n", run(buildings).dump(is_json ? -1 : 2).c_str());
}
