// What all exporters share: they see results, never the pipeline, and return bytes; files.* alone
// writes them.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "core/geometry.h"
#include "image/image.h"

namespace colod {

/// A file to be: its path below OUT ('/' separated) and its bytes.
struct Encoded {
  std::string path;
  std::string bytes;
};

/// How vertex data are packed: plain floats, KHR_draco_mesh_compression, or
/// EXT_meshopt_compression.
enum class Compression { kNone, kDraco, kMeshopt };

/// How a level looks; empty where the source has no appearance, or none is asked for.
struct LevelLook {
  std::vector<std::array<Vec2f, 3>> uvs;  ///< per triangle, 0,0 is the image's upper left corner;
                                          ///< empty: no texture
  std::string image;                      ///< encoded
  std::string fallback;                   ///< the same as JPEG, for who does not read its format;
                                          ///< empty: none
  int width = 0, height = 0;              ///< texels, multiples of 4
  ImageFormat format = ImageFormat::kJpeg;
  int quality = 85;            ///< of images that are made of this one
  bool has_fallback = false;   ///< whether they have one
  bool has_mip_levels = true;  ///< whether clients make them: no where something coarser is shown
                               ///< before a pixel covers many texels
  Raster raster;               ///< its pixels; empty where the encoded image alone is kept
  /// A tangent-space normal map beside it, as glTF has them: a PNG, and its pixels. Empty: none;
  /// the look is then shown as it is, without light.
  std::string normals;
  Raster normal_raster;
  std::vector<Rgb> facet_colors;  ///< per facet, for where no texture is; empty: none

  bool has_texture() const { return !uvs.empty(); }
  /// Sets image and fallback to these pixels.
  void encode(const Raster& pixels) {
    image = encode_image(pixels, format, quality);
    if (has_fallback) fallback = encode_image(pixels, ImageFormat::kJpeg, quality);
  }
  std::size_t bytes() const { return image.size() + fallback.size() + normals.size(); }
};

/// A mesh of one building as exporters see it: one layer, or several that are alike. Coordinates:
/// building-local metres, z up, axes parallel to the world's (the pipeline has undone the frame's
/// yaw); world = local + ExportBuilding::origin.
struct ExportLevel {
  std::vector<int> layers;  ///< that it is, rising; 0 = coarsest
  PolygonMesh mesh;
  double gsd = 0;        ///< metres a pixel: from where on it may stand for the finest level; falls
                         ///< strictly from level to level, 0 for the finest
  double deviation = 0;  ///< metres, two-sided, from the finest level
  LevelLook look = {};
};

struct ExportBuilding {
  std::string name;
  std::string source;               ///< base name of the file that it came from
  Vec3 origin = Vec3::Zero();       ///< world position of the local origin
  std::vector<ExportLevel> levels;  ///< coarsest first; not empty; layers that failed are absent
  std::string given_name;           ///< as the input writes it, UTF-8; empty: none but `name`
  std::vector<std::pair<std::string, std::string>> attributes = {};  ///< of its footprint
};

/// How the levels' gsd came about, for whoever reads the files.
struct SwitchFacts {
  std::string measure = "visual";  ///< or "deviation"
  std::string scope = "scene";     ///< or "building"
  double visual_error = 14;        ///< pixels that the difference may have (visual)
  double pixel_error = 2;          ///< pixels that the deviation may have (deviation; stand-ins)
  double share = 0.9;              ///< scene: of the buildings whose own bound is kept
  double viewport_height = 1080;   ///< pixels, that coverages and distances are for
  double fov_y_deg = 60;           ///< of the camera that distances are for
  std::vector<double> layer_gsd;   ///< scope scene: per layer; else empty
};

/// Where the scene stands on Earth.
struct Placement {
  std::function<Vec3(const Vec3& world)> to_ecef;  ///< thread-safe; empty: nowhere on Earth
  std::string name;                                ///< of the reference system, for readers
};

}  // namespace colod
