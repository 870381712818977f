#include "outputs.h"

#include <algorithm>
#include <exception>
#include <mutex>

#include "context.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "dress.h"
#include "exporters/gltf/engine.h"
#include "exporters/gltf/glb.h"
#include "exporters/html_report/html_report.h"
#include "exporters/plain/obj.h"
#include "exporters/tiles3d/archive.h"
#include "exporters/tiles3d/tiles3d.h"
#include "place/place.h"
#include "placement.h"
#include "publish.h"
#include "report_parts.h"
#include "report_pictures.h"

namespace colod {
namespace {

Encoded encode_page(const Scene& scene, const Options& options, const std::string& report,
                    Pictures pictures) {
  HtmlReport page{report, parts_json(scene, options), std::move(pictures), {}};
  for (int layer = 0; layer < options.layers; ++layer) {
    const Color c = layer_color(layer);
    char text[8];
    std::snprintf(text, sizeof text, "#%02x%02x%02x", c[0], c[1], c[2]);
    page.layer_colors.push_back(text);
  }
  return encode_html_report(page);
}

EngineOptions engine_options(const OutputOptions& a, const SwitchFacts& facts) {
  return {.quantization = a.quantization, .switching = facts};
}

bool writes(const OutputOptions& a, const char* format) {
  return std::find(a.formats.begin(), a.formats.end(), format) != a.formats.end();
}

/// The chain; notes what each layer's mesh takes of it.
Encoded encode_glb(const ExportBuilding& out, const SwitchFacts& facts, const OutputOptions& a,
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
std::vector<Encoded> building_files(const ExportBuilding& out, const SwitchFacts& facts,
                                    const OutputOptions& a, Building& b) {
  std::vector<Encoded> files;
  if (writes(a, "glb")) files.push_back(encode_glb(out, facts, a, b));
  if (writes(a, "engine"))
    for (Encoded& file : encode_engine_levels(out, engine_options(a, facts)))
      files.push_back(std::move(file));
  for (const ExportLevel& level : out.levels)
    for (const int layer : level.layers) {
      if (writes(a, "obj")) {
        files.push_back(encode_obj(out, level, layer));
        for (Encoded& file : encode_obj_material(out, level, layer))
          files.push_back(std::move(file));
      }
      if (writes(a, "ply")) files.push_back(encode_ply(out, level, layer));
    }
  return files;
}

int most_layers(const Scene& scene) {
  std::size_t most = 0;
  for (const Building& b : scene.buildings) most = std::max(most, b.layers.size());
  return static_cast<int>(most);
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

/// What all buildings of a scene are written with.
struct Writer {
  const OutputOptions& options;
  SwitchFacts facts;
  const ImageCache& images;
  PictureOptions look;  // of pictures of looks
};

/// A building is not lost for want of its picture.
void add_looks(const Writer& w, Building& b, const ExportBuilding& out,
               std::vector<std::string>& pictures) {
  try {
    for (std::string& picture : draw_looks(b, out, w.images, w.look))
      pictures.push_back(std::move(picture));
  } catch (const std::exception& e) {
    b.warnings.push_back(std::string("no pictures of its looks: ") + e.what());
  }
}

/// Brings the source back for as long as its layers are dressed; `pictures` may be null.
void dress_from(Depot& depot, const Writer& w, Building& b, ExportBuilding& out,
                std::vector<std::string>* pictures) {
  if (!is_dressed(b, w.options.texture)) return;
  depot.get(b);
  try {
    dress(b, w.options.texture, w.images, out);
    if (pictures && !pictures->empty() && w.options.texture.mode == Texture::kAuto)
      add_looks(w, b, out, *pictures);
  } catch (const std::exception& e) {  // a failure of its looks alone
    b.lost_looks.push_back(std::string("is written without textures: ") + e.what());
    for (ExportLevel& level : out.levels) level.look = {};
  }
  depot.drop(b);
}

/// Of the levels' pixels only the coarsest's are needed after a building's own files: groups of far
/// buildings share an atlas.
void let_go_of_pixels(ExportBuilding& out) {
  for (std::size_t i = 0; i < out.levels.size(); ++i) {
    if (i > 0) out.levels[i].look.raster = {};
    out.levels[i].look.normals.clear();  // tiles have none
    out.levels[i].look.normal_raster = {};
  }
}

/// A building that cannot be encoded fails alone.
void encode_building(ExportBuilding& out, const Writer& w, Depot& depot, Building& b,
                     std::vector<std::string>* pictures, const Take& take) {
  std::vector<Encoded> files;
  dress_from(depot, w, b, out, pictures);
  try {
    files = building_files(out, w.facts, w.options, b);
  } catch (const std::exception& e) {
    b.failure = b.source.name + ": cannot be exported: " + e.what();
  }
  for (const Encoded& file : files) take(file);
  let_go_of_pixels(out);
}

/// A tileset that cannot be made leaves the buildings' files and the report as they are.
void encode_tiles(Scene& scene, const std::vector<ExportBuilding>& buildings,
                  const SwitchFacts& facts, const OutputOptions& a, const Take& take,
                  const Tell& tell) {
  std::vector<Encoded> files;
  ContextFailures failures;
  std::mutex mutex;
  std::exception_ptr unwritten;
  const Take writer = [&](const Encoded& file) {
    try {
      take(file);
    } catch (...) {
      const std::lock_guard lock(mutex);
      unwritten = std::current_exception();
      throw;
    }
  };
  const std::optional<ContextTiles> around = context_tiles(scene, a.texture, failures);
  try {
    files = encode_tileset(buildings,
                           {.compression = a.compression,
                            .quantization = a.quantization,
                            .target_sse = a.target_sse,
                            .switching = facts,
                            .largest_texture = a.texture.largest,
                            .context = around ? &*around : nullptr,
                            .take_context = writes(a, "3tz") ? Take{} : writer,
                            .placement = find_placement(scene, a.crs, a.origin, buildings, tell)});
  } catch (const std::exception& e) {
    if (unwritten) std::rethrow_exception(unwritten);
    scene.tileset_failure = e.what();
    return;
  }
  tell_failures(failures, scene);
  if (writes(a, "3tz")) take(encode_3tz(files));
  if (writes(a, "3dtiles"))  // tileset.json last: whoever finds it finds the tiles it names
    for (std::size_t i = files.size(); i-- > 0;) take(files[i]);
}

}  // namespace

SwitchOptions switch_options(const OutputOptions& a) {
  SwitchOptions options = a.switching;
  options.rounding = a.quantization;
  return options;
}

void check_output(const OutputOptions& a) {
  if (a.texture.format == ImageFormat::kKtx2 && a.texture.mode == Texture::kAuto &&
      !can_encode_ktx2())
    throw Error(
        Stage::kUsage, "--texture-format",
        "ktx2 is written by the program basisu (Basis Universal), which is not on the PATH: "
        "install it, or choose webp");
  if (const auto given = georeference_from_options(a.crs, a.origin))
    place_on_earth(*given, Vec3::Zero());
}

void encode_scene(Scene& scene, const OutputOptions& a, Depot& depot, const Take& take,
                  const Tell& tell, Pictures* pictures) {
  Stopwatch watch(scene.export_seconds);
  scene.tileset_failure.clear();
  if (!scene.found_footprints.empty()) take({"footprints.geojson", scene.found_footprints});
  const SwitchFacts facts = switch_facts(scene.switching);
  std::vector<ExportBuilding> buildings;
  std::vector<Building*> sources;
  for (Building* b : by_name(scene))
    if (ExportBuilding out = export_building(*b); !out.levels.empty()) {
      if (const auto own = scene.attributes.find(out.name); own != scene.attributes.end())
        out.attributes = own->second;
      buildings.push_back(std::move(out)), sources.push_back(b);
    }
  const ImageCache images(static_cast<std::size_t>(a.texture.memory * (1 << 20)));
  // Half as many pixels as shapes have: there are as many pictures again.
  const Writer writer{a, facts, images,
                      picture_options(2 * scene.buildings.size(), most_layers(scene))};
  parallel_for(buildings.size(), [&](std::size_t i) {
    Stopwatch own(sources[i]->timings.export_);
    const auto number = static_cast<std::size_t>(sources[i] - scene.buildings.data());
    encode_building(buildings[i], writer, depot, *sources[i],
                    pictures && number < pictures->size() ? &(*pictures)[number] : nullptr, take);
  });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < buildings.size(); ++i)
    if (sources[i]->failure.empty()) std::swap(buildings[kept++], buildings[i]);
  buildings.resize(kept);
  if (buildings.empty()) return;
  if (writes(a, "engine")) take(encode_lods_json(buildings, engine_options(a, facts)));
  if (writes(a, "3dtiles") || writes(a, "3tz"))
    encode_tiles(scene, buildings, facts, a, take, tell);
}

std::vector<Encoded> encode_report(const Scene& scene, const Options& options,
                                   const RunTotals& totals, Pictures pictures,
                                   const OutputOptions& output) {
  std::vector<Encoded> files;
  std::string report = report_json(scene, options, totals);
  if (!output.has_no_page)
    files.push_back(encode_page(scene, options, report, std::move(pictures)));
  files.push_back({"report.json", std::move(report)});
  return files;
}

}  // namespace colod
