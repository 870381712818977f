// A finished scene → the files that `colod build` and `colod export` write, in memory.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/options.h"
#include "exporters/exporter.h"
#include "messages.h"
#include "pipeline/pipeline.h"
#include "report.h"

namespace colod {

/// kAuto: textures where a source shows more than one colour a face; kColors: one colour a facet,
/// as vertex colours, where it has any colour.
enum class Texture { kAuto, kNone, kColors };

struct TextureOptions {
  Texture mode = Texture::kAuto;
  double texel = 0;    ///< metres, of the finest layer; 0: as the source
  int largest = 4096;  ///< texels a side of an atlas
  ImageFormat format = ImageFormat::kJpeg;
  bool has_fallback = false;  ///< a JPEG beside each image of another format
  int quality = 85;
  bool has_normals = false;  ///< normal maps, and light in place of KHR_materials_unlit
  double memory = 512;       ///< MiB that decoded images may take
};

struct OutputOptions {
  std::vector<std::string> formats = {"glb", "3dtiles"};
  Compression compression = Compression::kDraco;
  double quantization = 0.01, target_sse = 16;
  SwitchOptions switching;
  TextureOptions texture;
  std::string crs, origin;   ///< empty: what lies beside the sources says
  bool has_no_page = false;  ///< no report.html
};

/// Per building of the scene, PNGs of shapes, then JPEGs of looks where it has any
/// (report_pictures.h).
using Pictures = std::vector<std::vector<std::string>>;

/// Takes each file as soon as it is made, from several threads. What it throws ends the job.
using Take = std::function<void(const Encoded&)>;

/// With the rounding of what is written.
SwitchOptions switch_options(const OutputOptions& options);

/// Throws Error{kUsage} when crs and origin name no place, or images cannot be written in their
/// format; before the work rather than after.
void check_output(const OutputOptions& options);

/// After decide_switches: dresses the layers of each building in what its source looks like, which
/// `depot` brings back, makes the files of all buildings, then those of the scene, tileset.json
/// last; notes their seconds and bytes, and tells where on Earth the tileset is, if anywhere. A
/// building that cannot be encoded becomes a failed one, a tileset that cannot is told of by
/// Scene::tileset_failure. Buildings that have `pictures` get pictures of their looks beside them.
void encode_scene(Scene& scene, const OutputOptions& options, Depot& depot, const Take& take,
                  const Tell& tell, Pictures* pictures = nullptr);

/// After encode_scene: report.html, unless options say no, and report.json. Without pictures the
/// page has none.
std::vector<Encoded> encode_report(const Scene& scene, const Options& options,
                                   const RunTotals& totals, Pictures pictures,
                                   const OutputOptions& output);

}  // namespace colod
