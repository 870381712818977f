#include "outputs.h"

#include <algorithm>
#include <exception>
#include <mutex>

#include "building_files.h"
#include "context.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "exporters/html_report/html_report.h"
#include "exporters/tiles3d/archive.h"
#include "exporters/tiles3d/tiles3d.h"
#include "place/place.h"
#include "placement.h"
#include "publish.h"
#include "report_parts.h"
#include "report_pictures.h"

namespace colod {
namespace {

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
  std::vector<std::string> paths;
  for (const Building& b : scene.buildings) paths.push_back(b.source.path);
  std::vector<Vec3> origins;
  for (const ExportBuilding& b : buildings) origins.push_back(b.origin);
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
                            .placement = find_placement(paths, a.crs, a.origin, origins, tell)});
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
    files.push_back(encode_html_report({report, parts_json(scene, options), std::move(pictures),
                                        css_layer_colors(options.layers)}));
  files.push_back({"report.json", std::move(report)});
  return files;
}

}  // namespace colod
