#include "building_files.h"

#include <algorithm>
#include <exception>

#include "dress.h"
#include "exporters/gltf/glb.h"
#include "exporters/plain/obj.h"

namespace colod {
namespace {

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

}  // namespace

EngineOptions engine_options(const OutputOptions& a, const SwitchFacts& facts) {
  return {.quantization = a.quantization, .switching = facts};
}

bool writes(const OutputOptions& a, const char* format) {
  return std::find(a.formats.begin(), a.formats.end(), format) != a.formats.end();
}

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

}  // namespace colod
