#include "output.h"

#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <set>
#include <sstream>

#include "core/error.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "exporters/files.h"
#include "exporters/gltf/engine.h"
#include "exporters/gltf/glb.h"
#include "exporters/html_report/html_report.h"
#include "exporters/plain/obj.h"
#include "exporters/tiles3d/archive.h"
#include "exporters/tiles3d/tiles3d.h"
#include "numbers.h"
#include "pipeline/losses.h"
#include "place/place.h"
#include "publish/publish.h"
#include "publish/report.h"
#include "publish/report_parts.h"
#include "publish/report_pictures.h"
#include "store/store.h"

namespace colod::cli {
namespace {

/// What the files beside all sources say alike. Where they contradict each other or cannot be read,
/// nothing, with a warning: never an invented place.
std::optional<Georeference> georeference_of_sources(const Scene& scene, const Log& log) {
  std::optional<Georeference> found;
  std::set<std::string> folders;
  for (const Building& b : scene.buildings) {
    const std::string folder = std::filesystem::path(b.source.path).parent_path().string();
    if (!folders.insert(folder).second) continue;
    try {
      const auto here = georeference_beside(b.source.path);
      if (folders.size() == 1)
        found = here;
      else if (found.has_value() != here.has_value() ||
               (found && (found->crs != here->crs || found->offset != here->offset)))
        throw Error(Stage::kInput, folder, "lies elsewhere on Earth than the other sources");
    } catch (const Error& error) {
      log.message(Level::kWarning,
                  std::string(error.what()) + "; the tileset stays local: use --crs and --origin");
      return {};
    }
  }
  return found;
}

/// The map of a place that files beside the input tell of: nothing, with a warning, where it is no
/// place for these buildings.
std::optional<EarthMap> try_place(const Georeference& g, const std::vector<ExportBuilding>& all,
                                  const Log& log) {
  try {
    EarthMap map = place_on_earth(g, all.front().origin);
    for (const ExportBuilding& b : all) map.to_ecef(b.origin);
    return map;
  } catch (const Error& error) {
    const bool is_named = error.item == g.source;
    log.message(Level::kWarning, (is_named ? "" : g.source + ": ") + error.what() +
                                     "; the tileset stays local: use --crs and --origin");
    return {};
  }
}

/// Where the tileset stands, said in the log.
Placement place(const Scene& scene, const OutputArguments& a,
                const std::vector<ExportBuilding>& buildings, const Log& log) {
  const std::optional<Georeference> given = georeference_from_options(a.crs, a.origin);
  std::optional<Georeference> found;
  if (!given && a.crs.empty()) found = georeference_of_sources(scene, log);
  std::optional<EarthMap> map;
  if (given)
    map = place_on_earth(*given, buildings.front().origin);
  else if (found)
    map = try_place(*found, buildings, log);
  if (!map) {
    if (!found)
      log.message(Level::kInfo,
                  "no --crs, --origin or file beside the input says where this is: the tileset is "
                  "local, not placed on Earth");
    return {};
  }
  for (const std::string& w : map->warnings) log.message(Level::kWarning, w);
  log.message(Level::kInfo, "the tileset is placed on Earth: " + map->name + ", from " +
                                (given ? given->source : found->source));
  return {map->to_ecef, map->name};
}

void write_page(const Scene& scene, const Options& options, const std::string& report,
                Pictures pictures, const OutputArguments& a) {
  HtmlReport page{report, parts_json(scene, options), std::move(pictures), {}};
  for (int layer = 0; layer < options.layers; ++layer) {
    const Color c = layer_color(layer);
    char text[8];
    std::snprintf(text, sizeof text, "#%02x%02x%02x", c[0], c[1], c[2]);
    page.layer_colors.push_back(text);
  }
  write_file(a.out, encode_html_report(page));
}

EngineOptions engine_options(const OutputArguments& a, const SwitchFacts& facts) {
  return {.quantization = a.quantization, .switching = facts};
}

bool writes(const OutputArguments& a, const char* format) {
  return std::find(a.formats.begin(), a.formats.end(), format) != a.formats.end();
}

/// The chain; notes what each layer's mesh takes of it.
Encoded encode_glb(const ExportBuilding& out, const SwitchFacts& facts, const OutputArguments& a,
                   Building& b) {
  const BuildingGlb glb = encode_building_glb(
      out, {.compression = a.compression, .quantization = a.quantization, .switching = facts});
  for (std::size_t level = 0; level < out.levels.size(); ++level)
    for (Layer& layer : b.layers)
      if (std::ranges::count(out.levels[level].layers, layer.layer) > 0)
        layer.bytes = glb.level_bytes[level];
  return glb;
}

/// The files of one building.
std::vector<Encoded> encode_building(const ExportBuilding& out, const SwitchFacts& facts,
                                     const OutputArguments& a, Building& b) {
  std::vector<Encoded> files;
  if (writes(a, "glb")) files.push_back(encode_glb(out, facts, a, b));
  if (writes(a, "engine"))
    for (Encoded& file : encode_engine_levels(out, engine_options(a, facts)))
      files.push_back(std::move(file));
  for (const ExportLevel& level : out.levels)
    for (const int layer : level.layers) {
      if (writes(a, "obj")) files.push_back(encode_obj(out, level, layer));
      if (writes(a, "ply")) files.push_back(encode_ply(out, level, layer));
    }
  return files;
}

/// In the order of names: in what order a scene file grew shows in no tile.
std::vector<Building*> by_name(Scene& scene) {
  std::vector<Building*> sorted;
  for (Building& b : scene.buildings) sorted.push_back(&b);
  std::stable_sort(sorted.begin(), sorted.end(), [](const Building* a, const Building* b) {
    return a->source.name < b->source.name;
  });
  return sorted;
}

/// A building that cannot be encoded fails alone; only what cannot be written ends the run.
void write_building(const ExportBuilding& out, const SwitchFacts& facts, const OutputArguments& a,
                    Building& b) {
  std::vector<Encoded> files;
  try {
    files = encode_building(out, facts, a, b);
  } catch (const std::exception& e) {
    b.failure = b.source.name + ": cannot be exported: " + e.what();
  }
  for (const Encoded& file : files) write_file(a.out, file);
}

std::vector<Encoded> encode_tiles(const Scene& scene, const std::vector<ExportBuilding>& buildings,
                                  const SwitchFacts& facts, const OutputArguments& a,
                                  const Log& log) {
  return encode_tileset(buildings, {.compression = a.compression,
                                    .quantization = a.quantization,
                                    .target_sse = a.target_sse,
                                    .switching = facts,
                                    .placement = place(scene, a, buildings, log)});
}

/// A tileset that cannot be made leaves the buildings' files and the report as they are.
void write_tileset(Scene& scene, const std::vector<ExportBuilding>& buildings,
                   const SwitchFacts& facts, const OutputArguments& a, const Log& log) {
  std::vector<Encoded> files;
  try {
    files = encode_tiles(scene, buildings, facts, a, log);
  } catch (const std::exception& e) {
    scene.tileset_failure = e.what();
    return;
  }
  if (writes(a, "3tz")) write_file(a.out, encode_3tz(files));
  if (writes(a, "3dtiles"))  // tileset.json last: whoever finds it finds the tiles it names
    for (std::size_t i = files.size(); i-- > 0;) write_file(a.out, files[i]);
}

}  // namespace

void add_switch_options(CLI::App& app, SwitchOptions& o) {
  app.add_option_function<std::string>(
         "--switch",
         [&o](const std::string& v) {
           o.measure = v == "deviation" ? SwitchMeasure::kDeviation : SwitchMeasure::kVisual;
         },
         "what decides from where on a layer may stand: visual (default), pictures of it beside "
         "the finest one; or deviation, the distance between them")
      ->check(CLI::IsMember({"visual", "deviation"}));
  app.add_option_function<std::string>(
         "--switch-scope",
         [&o](const std::string& v) {
           o.scope = v == "building" ? SwitchScope::kBuilding : SwitchScope::kScene;
         },
         "scene (default): all buildings switch at the same distance; building: each at its own")
      ->check(CLI::IsMember({"scene", "building"}));
  app.add_option(
         "--visual-error", o.visual_error,
         "with --switch visual: a change may be as large as a square of this side [pixels], "
         "default 14")
      ->check(number_between(1.0, 32.0));
  app.add_option(
         "--pixel-error", o.pixel_error,
         "with --switch deviation, and for merged boxes of far tiles: how many pixels a layer "
         "may be wrong when it is shown, default 2")
      ->check(number_between(0.01, 1e4));
  app.add_option("--switch-share", o.share,
                 "with --switch-scope scene: the share of buildings whose own bound is kept, "
                 "default 0.9")
      ->check(number_between(0.0, 1.0));
}

void add_output_options(CLI::App& app, OutputArguments& a) {
  app.add_option("-o,--out", a.out, "folder to write to")->required();
  app.add_option("--format", a.formats,
                 "glb, 3dtiles, 3tz, engine, obj, ply; several with commas (default glb,3dtiles)")
      ->delimiter(',')
      ->check(CLI::IsMember({"glb", "3dtiles", "3tz", "engine", "obj", "ply"}));
  app.add_option_function<std::string>(
         "--compression",
         [&a](const std::string& v) {
           a.compression = v == "none"      ? Compression::kNone
                           : v == "meshopt" ? Compression::kMeshopt
                                            : Compression::kDraco;
         },
         "of GLBs: draco (default), meshopt or none")
      ->check(CLI::IsMember({"draco", "meshopt", "none"}));
  app.add_option("--quantization", a.quantization,
                 "how far rounding may move a vertex [m], a third of it on the finest layer, "
                 "default 0.01")
      ->check(number_between(1e-5, 1.0));
  app.add_option(
      "--crs", a.crs,
      "where on Earth the input is: EPSG:n of a projected system, EPSG:n+m with heights, "
      "or local; default: what metadata.xml, ODM or Pix4D files beside the input say");
  app.add_option("--origin", a.origin,
                 "added to the input's coordinates: easting,northing[,height] in --crs; without "
                 "--crs latitude,longitude[,height] of the input's origin")
      ->check(position());
  app.add_option("--target-sse", a.target_sse,
                 "the screen-space error that clients refine at [pixels], default 16")
      ->check(number_between(0.01, 1e4));
  add_switch_options(app, a.switching);
  app.add_flag("--no-report-html", a.has_no_page,
               "report.json only, no report.html and no pictures for it");
}

void write_outputs(Scene& scene, const OutputArguments& a, const Log& log) {
  Stopwatch watch(scene.export_seconds);
  const SwitchFacts facts = switch_facts(scene.switching);
  std::vector<ExportBuilding> buildings;
  std::vector<Building*> sources;
  for (Building* b : by_name(scene))
    if (ExportBuilding out = export_building(*b); !out.levels.empty())
      buildings.push_back(std::move(out)), sources.push_back(b);
  parallel_for(buildings.size(), [&](std::size_t i) {
    Stopwatch own(sources[i]->timings.export_);
    write_building(buildings[i], facts, a, *sources[i]);
  });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < buildings.size(); ++i)
    if (sources[i]->failure.empty()) std::swap(buildings[kept++], buildings[i]);
  buildings.resize(kept);
  if (buildings.empty()) return;
  if (writes(a, "engine")) write_file(a.out, encode_lods_json(buildings, engine_options(a, facts)));
  if (writes(a, "3dtiles") || writes(a, "3tz")) write_tileset(scene, buildings, facts, a, log);
}

void check_place(const OutputArguments& a) {
  if (const auto given = georeference_from_options(a.crs, a.origin))
    place_on_earth(*given, Vec3::Zero());
}

SwitchOptions switch_options(const OutputArguments& a) {
  SwitchOptions options = a.switching;
  options.rounding = a.quantization;
  return options;
}

std::vector<BuildingSights> read_sights(const std::string& prior, int layers, const Log& log) {
  if (prior.empty()) return {};
  const Store store(prior, false);
  if (const int its = store.options().layers; its != layers)
    throw Error(Stage::kUsage, "--prior",
                "it has " + std::to_string(its) + " layers, not " + std::to_string(layers));
  std::vector<BuildingSights> sights = store.sights();
  if (sights.empty())
    log.message(Level::kWarning, prior +
                                     ": holds no meshes, so that this scene's own buildings "
                                     "decide where layers switch: run colod mesh on it first");
  return sights;
}

void report_problems(const Scene& scene, const Log& log) {
  for (const std::string& w : scene.warnings) log.message(Level::kWarning, w);
  for (const std::string& w : scene.switching.warnings) log.message(Level::kWarning, w);
  if (!scene.tileset_failure.empty())
    log.message(Level::kError, "tileset.json is not written: " + scene.tileset_failure);
  for (const ReadFailure& f : scene.failures) log.message(Level::kError, f.path + ": " + f.message);
  for (const Building& b : scene.buildings) {
    if (!b.failure.empty()) log.message(Level::kError, b.failure);
    for (const Layer& layer : b.layers)
      if (!layer.failure.empty())
        log.message(Level::kError, b.source.name + ", layer " + std::to_string(layer.layer) + ": " +
                                       layer.failure);
      else if (is_failure(layer.stand_in))
        log.message(Level::kError, b.source.name + ", layer " + std::to_string(layer.layer) + ": " +
                                       describe(layer.stand_in));
    for (const std::string& w : loss_warnings(b))
      log.message(b.has_lost() ? Level::kError : Level::kWarning, b.source.name + ": " + w);
    for (const std::string& w : b.warnings) log.message(Level::kWarning, b.source.name + ": " + w);
  }
}

int exit_code(const Scene& scene) {
  std::size_t failed = scene.failures.size() + !scene.tileset_failure.empty();
  for (const Building& b : scene.buildings) failed += b.has_failed() || b.has_lost();
  if (failed == 0) return 0;
  const bool is_any_done = std::any_of(scene.buildings.begin(), scene.buildings.end(),
                                       [](const Building& b) { return b.failure.empty(); });
  if (is_any_done) return 1;
  return static_cast<int>(scene.buildings.empty() ? Stage::kInput : Stage::kProcess);
}

int finish(const Scene& scene, const Options& options, double seconds, Pictures pictures,
           const OutputArguments& a, const Log& log) {
  const std::string report = report_json(scene, options, {seconds, peak_memory_bytes()});
  if (!a.has_no_page) write_page(scene, options, report, std::move(pictures), a);
  write_file(a.out, {"report.json", report});
  report_problems(scene, log);
  const auto done = std::count_if(scene.buildings.begin(), scene.buildings.end(),
                                  [](const Building& b) { return b.failure.empty(); });
  const auto lossy = std::count_if(
      scene.buildings.begin(), scene.buildings.end(),
      [](const Building& b) { return b.failure.empty() && (b.has_lost() || b.has_failed()); });
  std::ostringstream summary;
  summary << done << " of " << scene.buildings.size() + scene.failures.size() << " buildings in "
          << std::fixed << std::setprecision(1) << seconds << " s, written to " << a.out
          << " (layer 0 is the coarsest)";
  if (lossy > 0) summary << "; of " << lossy << " of them something is lost, as said above";
  log.message(Level::kInfo, summary.str());
  return exit_code(scene);
}

}  // namespace colod::cli
