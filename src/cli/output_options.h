// The options of what is written, shared by `build`, `export` and the library.
#pragma once

#include <string>

#include "cli.h"
#include "numbers.h"
#include "publish/outputs.h"

namespace colod::cli {

inline void add_switch_options(CLI::App& app, SwitchOptions& o) {
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

inline void add_texture_options(CLI::App& app, TextureOptions& o) {
  app.add_option_function<std::string>(
         "--texture",
         [&o](const std::string& v) {
           o.mode = v == "none"     ? Texture::kNone
                    : v == "colors" ? Texture::kColors
                                    : Texture::kAuto;
         },
         "auto (default): layers wear what sources with textures, or colours of vertices or "
         "points, look like; none: "
         "one plain colour; colors: one colour a facet, a few bytes, also of plain materials")
      ->check(CLI::IsMember({"auto", "none", "colors"}));
  app.add_option("--texel-size", o.texel,
                 "least side of a texel [m]; default 0: on the finest layer as fine as the source, "
                 "on others as a pixel where the layer may stand")
      ->check(number_between(0.0, 100.0));
  app.add_option("--texture-size", o.largest,
                 "largest side of an atlas [texels], default 4096; what does not fit gets larger "
                 "texels")
      ->check(number_between(64, 16384));
  app.add_option_function<std::string>(
         "--texture-format",
         [&o](const std::string& v) {
           o.format = v.starts_with("webp")   ? ImageFormat::kWebp
                      : v.starts_with("ktx2") ? ImageFormat::kKtx2
                      : v == "png"            ? ImageFormat::kPng
                                              : ImageFormat::kJpeg;
           o.has_fallback = v.ends_with("+jpeg");
         },
         "of images: jpeg (default), png, webp (EXT_texture_webp), ktx2 (KHR_texture_basisu, by "
         "the "
         "program basisu); +jpeg adds a JPEG for clients that do not read the other")
      ->check(CLI::IsMember({"jpeg", "png", "webp", "webp+jpeg", "ktx2", "ktx2+jpeg"}));
  app.add_option(
         "--texture-quality", o.quality,
         "of JPEG and WebP as their libraries count it, of KTX2 as a share of basisu's 255; "
         "default 85")
      ->check(number_between(1, 100));
  app.add_flag("--normal-map", o.has_normals,
               "with textures: beside each a normal map (PNG) of what the layer gave away, in GLBs "
               "of buildings and for engines; these are lit then (no KHR_materials_unlit)");
  app.add_option("--texture-memory", o.memory,
                 "MiB that decoded images may take together, default 512; an image that takes more "
                 "is left out")
      ->check(number_between(1.0, 1e6));
}

inline void add_output_options(CLI::App& app, OutputOptions& a) {
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
      "or local; default: what a LAS says itself, or metadata.xml, ODM or Pix4D files beside the "
      "input");
  app.add_option("--origin", a.origin,
                 "added to the input's coordinates: easting,northing[,height] in --crs; without "
                 "--crs latitude,longitude[,height] of the input's origin")
      ->check(position());
  app.add_option("--target-sse", a.target_sse,
                 "the screen-space error that clients refine at [pixels], default 16")
      ->check(number_between(0.01, 1e4));
  add_switch_options(app, a.switching);
  add_texture_options(app, a.texture);
  app.add_flag("--no-report-html", a.has_no_page,
               "report.json only, no report.html and no pictures for it");
}

}  // namespace colod::cli
