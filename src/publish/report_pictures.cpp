// Based on: own work; the camera and the lines are the preview's.
// Differs: the same under both rules.
#include "report_pictures.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bake/bake.h"
#include "core/stopwatch.h"
#include "image/look_sampler.h"

namespace colod {
namespace {

constexpr std::size_t kMostBytes = 5'200'000;  ///< of all pictures; base64 makes 7 MB of them
constexpr std::size_t kLeastBytes = 600;       ///< of one: a building of 48 × 36 pixels
constexpr double kBytesAPixel = 0.16;          ///< a scan's picture; a clean model's has half
constexpr int kLeastWidth = 48, kMostWidth = 320;
constexpr std::size_t kFineFaces = 20000;  ///< of a source: lines would be noise
constexpr double kAzimuth_deg = 35;
constexpr double kOutlier_ratio = 0.1;  ///< of the layers' diagonal: farther out is out of frame

/// Of light surfaces, so that shading and lines stay visible.
constexpr std::array<Color, 8> kLayerColors{{{228, 209, 166},
                                             {120, 170, 222},
                                             {238, 160, 88},
                                             {126, 196, 130},
                                             {196, 146, 214},
                                             {232, 206, 92},
                                             {110, 200, 200},
                                             {232, 140, 160}}};
constexpr Color kNoSegment{188, 190, 192};

/// FNV-1a.
std::uint32_t number_of(const std::string& text) {
  std::uint32_t hash = 2166136261u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619u;
  return hash;
}

/// A layer in the building's own frame.
Mesh local_mesh(const Building& b, const PolygonMesh& layer) {
  const Frame turn{Vec3::Zero(), b.frame.yaw};  // layers are parallel to the world's axes
  Mesh mesh = layer.mesh();
  for (Vec3& v : mesh.vertices) v = turn.to_local(v);
  return mesh;
}

/// Where the heaviest fault of its looks that has a place is worst, in the building's own frame.
std::vector<Vec3> marks_of(const Building& b, const Layer& layer) {
  for (const LookFault fault : judge_looks(layer.looks).faults)
    if (static_cast<int>(fault) < kPlacedFaults)
      return {Frame{Vec3::Zero(), b.frame.yaw}.to_local(
          layer.looks.worst[static_cast<int>(fault)].place)};
  return {};
}

std::vector<Color> colors_of(const Building& b, const PolygonMesh& mesh) {
  std::vector<Color> colors;
  for (const int facet : mesh.facet_of_triangle) {
    const int plane = mesh.facets[facet].plane;
    const std::vector<int>& owner = b.segments.segment_of_plane;
    const int segment = plane >= 0 && plane < static_cast<int>(owner.size()) ? owner[plane] : -1;
    const bool is_placed = segment >= 0 && segment < static_cast<int>(b.layer_of_segment.size());
    colors.push_back(is_placed ? layer_color(b.layer_of_segment[segment]) : kNoSegment);
  }
  return colors;
}

/// Of four views about the building's axes the one from which the source shows most: a scan often
/// lacks a wall. The first, unless another shows a tenth more.
double best_azimuth(const Source& source) {
  std::array<double, 4> seen{};
  const auto add = [&](const Vec3& normal) {
    for (int side = 0; side < 4; ++side) {
      const double az = (kAzimuth_deg + 90 * side) * std::numbers::pi / 180;
      seen[side] += std::max(0.0, normal.dot(Vec3(std::sin(az), -std::cos(az), 0)));
    }
  };
  for (const Face& f : source.mesh.faces) add(face_cross(source.mesh, f));
  for (const Vec3& n : source.cloud.normals) add(n);
  int best = 0;
  for (int side = 1; side < 4; ++side)
    if (seen[side] > 1.1 * seen[best]) best = side;
  return kAzimuth_deg + 90 * best;
}

/// What the camera frames: all of the layers, and of the source what is near them.
Box frame_of(const Building& b, const std::vector<Mesh>& layers) {
  Box box,
      source = bounding_box(b.source.is_mesh() ? b.source.mesh.vertices : b.source.cloud.points);
  for (const Mesh& mesh : layers) box.extend(bounding_box(mesh.vertices));
  if (box.is_empty() || source.is_empty()) return box.is_empty() ? source : box;
  const Vec3 reach = Vec3::Constant(kOutlier_ratio * box.diagonal());
  source.min = source.min.cwiseMax(box.min - reach);
  source.max = source.max.cwiseMin(box.max + reach);
  box.extend(source);
  return box;
}

/// JPEG of as high a quality as the bytes allow, down to a blur.
std::string encode_photo(const Image& image, std::size_t most) {
  Raster raster(image.width, image.height);
  raster.rgb = image.rgb;
  std::string bytes;
  for (int quality = 85; quality >= 25; quality -= 20) {
    bytes = encode_image(raster, ImageFormat::kJpeg, quality);
    if (bytes.size() <= most) break;
  }
  return bytes;
}

/// A level of a building in its texture.
std::string draw_level(const ExportLevel& level, const Mesh& mesh, const PreviewOptions& view,
                       std::size_t most_bytes) {
  const ImagePlace place{.path = "a level's own atlas"};
  ImageCache own(0);
  own.put(place, level.look.raster);
  Appearance look;
  look.images = {place};
  look.materials.resize(1);
  look.materials[0].image = 0;
  look.face_material.assign(mesh.faces.size(), 0);
  look.uvs = level.look.uvs;
  return encode_photo(render_preview(mesh, LookSampler(mesh, look, own), view), most_bytes);
}

}  // namespace

Color layer_color(int layer) { return kLayerColors[static_cast<std::size_t>(layer) % 8]; }

std::vector<std::string> css_layer_colors(int layers) {
  std::vector<std::string> colors;
  for (int layer = 0; layer < layers; ++layer) {
    const Color c = layer_color(layer);
    char text[8];
    std::snprintf(text, sizeof text, "#%02x%02x%02x", c[0], c[1], c[2]);
    colors.push_back(text);
  }
  return colors;
}

PictureOptions picture_options(std::size_t buildings, int layers) {
  PictureOptions o;
  const std::size_t pictures = std::max<std::size_t>(1, buildings) * (1 + layers);
  o.every = 1 + (pictures * kLeastBytes - 1) / kMostBytes;
  o.most_bytes = std::max(kLeastBytes, kMostBytes / pictures);
  const double pixels = static_cast<double>(o.most_bytes) / kBytesAPixel;
  o.width = std::clamp(static_cast<int>(std::sqrt(pixels * 4 / 3)), kLeastWidth, kMostWidth);
  o.height = o.width * 3 / 4;
  return o;
}

std::vector<std::string> draw_building(const Building& b, const PictureOptions& options) {
  std::vector<Mesh> layers;
  for (const Layer& layer : b.layers) layers.push_back(local_mesh(b, layer.mesh));
  PreviewOptions view{.width = options.width,
                      .height = options.height,
                      .azimuth_deg = best_azimuth(b.source),
                      .box = frame_of(b, layers)};
  std::vector<std::string> pictures(1);
  if (view.box.is_empty()) return {};
  view.has_edges = b.source.mesh.faces.size() < kFineFaces;
  view.samples = view.has_edges ? 2 : 1;
  if (b.source.is_mesh() || !b.source.cloud.points.empty())
    pictures[0] = encode_small_png(b.source.is_mesh() ? render_preview(b.source.mesh, view)
                                                      : render_preview(b.source.cloud, view),
                                   options.most_bytes);
  view.has_edges = true;
  view.samples = 2;
  for (std::size_t k = 0; k < layers.size(); ++k) {
    pictures.emplace_back();
    if (layers[k].faces.empty()) continue;
    const PolygonMesh& mesh = b.layers[k].mesh;
    view.marks = marks_of(b, b.layers[k]);
    pictures.back() = encode_small_png(
        render_preview(layers[k], view, mesh.facet_of_triangle, colors_of(b, mesh)),
        options.most_bytes);
  }
  return pictures;
}

std::vector<std::string> draw_looks(const Building& b, const ExportBuilding& out,
                                    const ImageCache& images, const PictureOptions& options) {
  std::vector<Mesh> levels;
  for (const ExportLevel& level : out.levels) levels.push_back(local_mesh(b, level.mesh));
  const PreviewOptions view{.width = options.width,
                            .height = options.height,
                            .azimuth_deg = best_azimuth(b.source),
                            .has_edges = false,
                            .box = frame_of(b, levels)};
  std::vector<std::string> pictures(1 + b.layers.size());
  const Splats splats = b.source.is_mesh() ? Splats{b.source.mesh, b.source.look}
                                           : splat_points(b.source.cloud, b.source.look.colors);
  const LookSampler source(splats.mesh, splats.look, images);
  pictures[0] = encode_photo(render_preview(splats.mesh, source, view), options.most_bytes);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    if (!out.levels[i].look.has_texture()) continue;
    const std::string picture = draw_level(out.levels[i], levels[i], view, options.most_bytes);
    for (std::size_t k = 0; k < b.layers.size(); ++k)
      if (std::ranges::count(out.levels[i].layers, b.layers[k].layer) > 0)
        pictures[k + 1] = picture;
  }
  return pictures;
}

Gallery::Gallery(std::size_t buildings, int layers)
    : options_(picture_options(buildings, layers)) {}

Observer Gallery::observer() {
  return {.segmented = {}, .meshed = [this](Building& b) { draw(b); }};
}

void Gallery::draw(Building& b) {
  if (number_of(b.source.name) % options_.every != 0) return;
  Stopwatch watch(b.timings.pictures);
  try {
    std::vector<std::string> pictures = draw_building(b, options_);
    const std::lock_guard lock(mutex_);
    pictures_[b.source.name] = std::move(pictures);
  } catch (const std::exception& e) {  // a building is not lost for want of its picture
    b.warnings.push_back(std::string("no pictures: ") + e.what());
  }
}

std::vector<std::string> Gallery::take(const std::string& building) {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> own = std::move(pictures_[building]);
  pictures_.erase(building);
  return own;
}

std::vector<std::vector<std::string>> Gallery::take(const Scene& scene) {
  std::vector<std::vector<std::string>> result;
  for (const Building& b : scene.buildings) result.push_back(std::move(pictures_[b.source.name]));
  pictures_.clear();
  return result;
}

}  // namespace colod
