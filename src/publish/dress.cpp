#include "dress.h"

#include <algorithm>

#include "bake/bake.h"

namespace colod {

namespace {

constexpr double kLeastReach = 0.25;  // metres: a source's own noise, and windows' reveals
constexpr double kMostReach = 4;  // metres: a larger part that a layer gave away is not its wall

/// How far from a layer what it stands for may lie.
double reach_of(const Building& b, const ExportLevel& level) {
  double far = level.deviation;
  for (const Layer& layer : b.layers)
    if (layer.layer == level.layers.back()) far += layer.distances.taken.p99;
  return std::clamp(far, kLeastReach, kMostReach);
}

/// Layers are parallel to the world's axes, the source stands in its own frame.
Mesh turned_back(const Building& b) {
  Mesh mesh = b.source.mesh;
  const Frame turn{Vec3::Zero(), b.frame.yaw};
  for (Vec3& v : mesh.vertices) v = turn.to_world(v);
  return mesh;
}

void note(Building& b, const ExportLevel& level, const BakeFacts& facts) {
  for (Layer& layer : b.layers)
    if (std::ranges::count(level.layers, layer.layer) > 0)
      layer.texture = LayerTexture{facts, level.look.image.size()};
}

void warn(Building& b, const std::string& warning) {
  if (std::ranges::count(b.warnings, warning) == 0) b.warnings.push_back(warning);
}

void dress_level(Building& b, const Baker& baker, const TextureOptions& options,
                 ExportLevel& level) {
  LevelLook& look = level.look;
  const BakeOptions bake{.texel = std::max(level.gsd, options.texel),
                         .largest = options.largest,
                         .reach = reach_of(b, level)};
  BakedTexture baked = baker.bake(level.mesh, bake);
  look.format = options.format;
  look.quality = options.quality;
  look.width = baked.image.width, look.height = baked.image.height;
  look.image = encode_image(baked.image, options.format, options.quality);
  look.raster = std::move(baked.image);
  look.uvs = std::move(baked.uvs);
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
  const Mesh mesh = turned_back(b);
  const Baker baker(mesh, b.source.look, images);
  for (const std::string& w : baker.warnings()) warn(b, w);
  for (ExportLevel& level : out.levels) {
    level.look.facet_colors = baker.facet_colors(level.mesh, reach_of(b, level));
    if (options.mode == Texture::kAuto) dress_level(b, baker, options, level);
  }
}

}  // namespace colod
