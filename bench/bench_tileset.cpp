// Time and memory of a merge's tileset over very many buildings, each two boxes of one level: how
// large a scene's tree can become before it, or the root, breaks.
//
//   bench_tileset --buildings N [--structure] [--threads N] [--json]
//
// Streets of houses 20 m apart; nothing is written, sizes alone are counted. --json prints one
// line.
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>
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

constexpr double kFloor = 5;  // metres: half of a house's longer side

/// All that is known of a house before its tile is made.
TileOutline outline_at(const Vec3& origin) {
  TileOutline o;
  o.box = {origin + Vec3(-kFloor, -4, 0), origin + Vec3(kFloor, 4, 6)};
  o.triangles = 10;
  o.stand_in.origin = origin;
  o.stand_in.half = {kFloor, 4, 6};
  o.stand_in.gsd = 2, o.stand_in.error = 1;
  return o;
}

/// Every tile is there already: of what is made the tilesets alone are left.
KeptTiles all_kept(std::size_t count) {
  return {.keys = std::vector<BuildingKey>(count),
          .find =
              [](const std::string&, const std::string&, const std::string& key) {
                return TileFacts{key, {Vec3(-10, -10, 0), Vec3(10, 10, 7)}, 0.5, 2000, {}};
              },
          .put = [](const std::string&, const auto&) {}};
}

struct Written {
  std::atomic<std::size_t> files = 0, bytes = 0, largest_json = 0;

  void add(const Encoded& file) {
    ++files, bytes += file.bytes.size();
    if (!file.path.ends_with(".json")) return;
    std::size_t most = largest_json;
    while (most < file.bytes.size() && !largest_json.compare_exchange_weak(most, file.bytes.size()))
      ;
  }
};

nlohmann::ordered_json run(int count, bool is_structure) {
  const auto start = std::chrono::steady_clock::now();
  const int row = static_cast<int>(std::ceil(std::sqrt(count)));
  std::vector<TileOutline> outlines;
  outlines.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) outlines.push_back(outline_at(house(i, row).origin));
  const PolygonMesh coarse = box_of(6), fine = box_of(7);
  std::map<int, ExportBuilding> open;
  const LevelDepot depot{
      .open =
          [&](const std::vector<int>& buildings) {
            for (const int b : buildings) open[b] = house(b, row);
          },
      .close = [&] { open.clear(); },
      .at = [&](int b) -> const ExportBuilding& { return open.at(b); },
      .get = [&](int b) { open.at(b).levels[0].mesh = coarse, open.at(b).levels[1].mesh = fine; },
      .drop =
          [&](int b) {
            for (ExportLevel& level : open.at(b).levels) level.mesh = {};
          },
      .named = [&](int b) { return house(b, row); },
      .coarsest = [](int) { return CoarsestLook{}; }};
  Written written;
  const KeptTiles kept = all_kept(is_structure ? static_cast<std::size_t>(count) : 0);
  const TilesOptions options{.kept = is_structure ? &kept : nullptr, .lists_files = false};
  const auto rest =
      encode_tileset(outlines, depot, options, [&](const Encoded& file) { written.add(file); });
  written.add(rest.front());  // tileset.json, which is not handed over
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return {
      {"buildings", count},
      {"is_structure", is_structure},
      {"seconds", std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()},
      {"cpu_seconds", static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec)},
      {"peak_memory_bytes", static_cast<std::int64_t>(usage.ru_maxrss) * 1024},
      {"files", written.files.load()},
      {"bytes", written.bytes.load()},
      {"largest_json_bytes", written.largest_json.load()},
      {"root_tileset_bytes", rest.front().bytes.size()}};
}

}  // namespace

int main(int argc, char** argv) {
  int buildings = 1000, threads = 0;
  bool is_json = false, is_structure = false;
  CLI::App app("time and memory of a tileset over very many buildings");
  app.add_option("--buildings", buildings)->check(CLI::Range(1, 20000000));
  app.add_option("--threads", threads);
  app.add_flag("--structure", is_structure, "tilesets alone, as if every tile were there already");
  app.add_flag("--json", is_json, "one line");
  CLI11_PARSE(app, argc, argv);
  limit_threads(threads);
  std::printf("%s\n", run(buildings, is_structure).dump(is_json ? -1 : 2).c_str());
}
