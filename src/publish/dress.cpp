#include "dress.h"

#include <algorithm>
#include <limits>

#include "bake/bake.h"

namespace colod {

namespace {

constexpr double kLeastReach = 0.25;  // metres: a source's own noise, and windows' reveals
constexpr double kDense = 0.25;  // metres from point to point: beyond it no window shows, and what
                                 // is baked is the scatter of single points
constexpr int kLeastQuality = 45, kQualityStep = 10;
constexpr double kMostReach = 4;  // metres: a larger part that a layer gave away is not its wall

/// How far from a layer what it stands for may lie.
double reach_of(const Building& b, const ExportLevel& level) {
  double far = level.deviation;
  for (const Layer& layer : b.layers)
    if (layer.layer == level.layers.back()) far += layer.distances.taken.p99;
  return std::clamp(far, kLeastReach, kMostReach);
}

/// Layers are parallel to the world's axes, the source stands in its own frame.
Mesh turned_back(Mesh mesh, const Frame& frame) {
  const Frame turn{Vec3::Zero(), frame.yaw};
  for (Vec3& v : mesh.vertices) v = turn.to_world(v);
  return mesh;
}

/// A building's source as a surface that has a look.
struct Shown {
  Mesh mesh;
  Appearance look;
  Sides sides = Sides::kFront;
  bool is_dense = true;  ///< enough for more than a colour a facet

  explicit Shown(const Building& b) : mesh(b.source.mesh), look(b.source.look) {
    if (!b.source.is_mesh()) {
      Splats splats = splat_points(b.source.cloud, b.source.look.colors);
      mesh = std::move(splats.mesh), look = std::move(splats.look);
      sides = Sides::kBoth;  // normals of clouds are guessed
      is_dense = splats.spacing <= kDense;
    }
    mesh = turned_back(std::move(mesh), b.frame);
  }
};

void note(Building& b, const ExportLevel& level, const BakeFacts& facts) {
  for (Layer& layer : b.layers)
    if (std::ranges::count(level.layers, layer.layer) > 0)
      layer.texture = LayerTexture{facts, level.look.bytes()};
}

void warn(Building& b, const std::string& warning) {
  if (std::ranges::count(b.warnings, warning) == 0) b.warnings.push_back(warning);
}

/// Bytes that coarser levels' images may take: all together two fifths of the finest's.
class Allowance {
 public:
  /// Of the next coarser level; the finest may take what it likes.
  std::size_t next() const {
    return is_first_ ? std::numeric_limits<std::size_t>::max()
                     : static_cast<std::size_t>(kNextShare * left_);
  }
  void take(std::size_t bytes) {
    left_ = is_first_ ? kCoarserShare * static_cast<double>(bytes)
                      : std::max(0.0, left_ - static_cast<double>(bytes));
    is_first_ = false;
  }

 private:
  static constexpr double kCoarserShare = 0.4, kNextShare = 0.72;
  bool is_first_ = true;
  double left_ = 0;
};

/// Small atlases are mostly borders of charts, which cost bytes: quality gives way, so far as it
/// may.
void encode_within(std::size_t most, const TextureOptions& options, LevelLook& look) {
  for (look.quality = options.quality;; look.quality -= kQualityStep) {
    look.encode(look.raster);
    const bool is_last = look.quality - kQualityStep < std::min(kLeastQuality, options.quality);
    if (look.bytes() <= most || is_last || options.format == ImageFormat::kPng) return;
  }
}

void dress_level(Building& b, const Baker& baker, const TextureOptions& options,
                 Allowance& allowance, ExportLevel& level) {
  LevelLook& look = level.look;
  const BakeOptions bake{.texel = std::max(level.gsd, options.texel),
                         .largest = options.largest,
                         .reach = reach_of(b, level),
                         .has_normals = options.has_normals};
  BakedTexture baked = baker.bake(level.mesh, bake);
  look.format = options.format;
  look.has_fallback = options.has_fallback;
  look.width = baked.image.width, look.height = baked.image.height;
  look.raster = std::move(baked.image);
  encode_within(allowance.next(), options, look);
  allowance.take(look.bytes());
  look.uvs = std::move(baked.uvs);
  if (options.has_normals) {
    look.normals = encode_image(baked.normals, ImageFormat::kPng, options.quality);
    look.normal_raster = std::move(baked.normals);
  }
  note(b, level, baked.facts);
}

}  // namespace

bool is_dressed(const Building& b, const TextureOptions& options) {
  return options.mode == Texture::kAuto     ? b.has_texture
         : options.mode == Texture::kColors ? b.has_colors
                                            : false;
}

void dress(Building& b, const TextureOptions& options, const ImageCache& images,
           ExportBuilding& out) {
  const Shown source(b);
  const Baker baker(source.mesh, source.look, images, source.sides);
  for (const std::string& w : baker.warnings()) warn(b, w);
  b.lost_looks = baker.losses();
  Allowance allowance;
  for (std::size_t i = out.levels.size(); i-- > 0;) {  // finest first
    ExportLevel& level = out.levels[i];
    level.look.facet_colors = baker.facet_colors(level.mesh, reach_of(b, level));
    if (options.mode == Texture::kAuto && baker.has_detail() && source.is_dense)
      dress_level(b, baker, options, allowance, level);
  }
}

}  // namespace colod
