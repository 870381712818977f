// Based on: own work.
#include "looks.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "image/packing.h"

namespace colod {

namespace {

constexpr Rgb kPlain = {231, 231, 231};  // the plain material's 0.8 of light
constexpr int kBlock = 4;                // texels a side: what a building without texture takes
constexpr double kFaces = 0.5;           // cosine between a stand-in's side and what it stands for
constexpr double kLeastPixels = 16;      // of a triangle that tells how large texels are
constexpr int kCoarseQuality = 75;       // of images that finer ones replace, as around buildings

/// Light times area, and the area.
using Sum = Eigen::Vector4d;

void add(Sum& sum, const Rgb& rgb, double area) {
  sum += area * Sum(to_linear(rgb[0]), to_linear(rgb[1]), to_linear(rgb[2]), 1);
}

Rgb color_of(const Sum& sum) {
  Rgb rgb = kPlain;
  for (int k = 0; k < 3 && sum[3] > 0; ++k)
    rgb[static_cast<std::size_t>(k)] = to_srgb(static_cast<float>(sum[k] / sum[3]));
  return rgb;
}

/// Of a box: what its buildings' coarsest levels show to each side, else their mean.
std::vector<Rgb> side_colors(const TilePart& part,
                             const std::function<CoarsestLook(int building)>& coarsest) {
  std::vector<Sum> sides(part.mesh->facets.size(), Sum::Zero());
  Sum all = Sum::Zero();
  for (const int b : part.buildings) {
    const CoarsestLook level = coarsest(b);
    for (std::size_t t = 0; t < level.mesh.faces.size(); ++t) {
      const Vec3 cross = face_cross(level.mesh, level.mesh.faces[t]);
      const auto facet = static_cast<std::size_t>(level.facet_of_triangle[t]);
      const Rgb rgb = level.facet_colors.empty() ? kPlain : level.facet_colors[facet];
      add(all, rgb, 0.5 * cross.norm());
      for (std::size_t s = 0; s < sides.size(); ++s)
        if (part.mesh->facets[s].normal.dot(cross) > kFaces * cross.norm())
          add(sides[s], rgb, 0.5 * cross.norm());
    }
  }
  std::vector<Rgb> colors;
  for (const Sum& side : sides) colors.push_back(color_of(side[3] > 0 ? side : all));
  return colors;
}

std::vector<Rgb> level_colors(const TilePart& part) {
  if (!part.level->look.facet_colors.empty()) return part.level->look.facet_colors;
  return std::vector<Rgb>(part.mesh->facets.size(), kPlain);
}

TileLook colored(const PlannedTile& tile,
                 const std::function<std::vector<Rgb>(const TilePart&)>& colors_of) {
  TileLook look;
  for (const TilePart& part : tile.parts) {
    look.parts.emplace_back();
    look.parts.back().facet_colors = colors_of(part);
  }
  look.whole.facet_colors = {kPlain};  // that there are colours
  return look;
}

/// What a building of a shared image wears there.
Raster swatch(const LevelLook& look) {
  if (look.has_texture()) return look.raster;
  Raster plain(kBlock, kBlock);
  std::fill(plain.rgb.begin(), plain.rgb.end(), kPlain[0]);
  return plain;
}

/// Metres along a side of a texel of what a part wears, by its finest triangle: charts are not
/// distorted, and those that nobody saw are small. Infinite: none tells.
double texel_of(const TilePart& part) {
  const LevelLook& look = part.level->look;
  const std::vector<Vec3>& at = part.mesh->vertices;
  const double pixels = static_cast<double>(look.width) * look.height;
  double least = INFINITY;
  for (std::size_t t = 0; t < look.uvs.size(); ++t) {
    const Vec2f a = look.uvs[t][1] - look.uvs[t][0], b = look.uvs[t][2] - look.uvs[t][0];
    const double own = 0.5 * pixels * std::abs(a.x() * b.y() - a.y() * b.x());
    if (own < kLeastPixels) continue;
    const Face& f = part.mesh->triangles[t];
    const double area = 0.5 * (at[f[1]] - at[f[0]]).cross(at[f[2]] - at[f[0]]).norm();
    if (area > 0) least = std::min(least, std::sqrt(area / own));
  }
  return least;
}

/// What a part wears, halved as often as leaves no texel larger than `pixel`, in metres.
Raster as_seen(const TilePart& part, double pixel) {
  Raster image = swatch(part.level->look);
  for (double texel = texel_of(part); 2 * texel <= pixel; texel *= 2) image = halve(image);
  return image;
}

int blocks(int texels) { return (texels + kBlock - 1) / kBlock * kBlock; }

/// A building's image in the tile's, and its coordinates there; the rest of its last blocks is like
/// its border.
LevelLook moved(const LevelLook& look, std::size_t triangles, const Raster& image,
                const PackedRect& rect, Raster& whole) {
  LevelLook out;
  out.width = whole.width, out.height = whole.height;
  const Vec2f size(static_cast<float>(whole.width), static_cast<float>(whole.height));
  const Vec2f corner(static_cast<float>(rect.x), static_cast<float>(rect.y));
  const Vec2f own(static_cast<float>(image.width), static_cast<float>(image.height));
  const Vec2f middle = (corner + 0.5f * own).cwiseQuotient(size);
  out.uvs.assign(triangles, {middle, middle, middle});
  for (std::size_t t = 0; t < look.uvs.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c)
      out.uvs[t][c] = (corner + look.uvs[t][c].cwiseProduct(own)).cwiseQuotient(size);
  for (int y = 0; y < rect.height; ++y)
    for (int x = 0; x < rect.width; ++x)
      std::memcpy(whole.at(rect.x + x, rect.y + y),
                  image.at(std::min(x, image.width - 1), std::min(y, image.height - 1)), 3);
  return out;
}

/// Places the images, each half as large and half again until they fit. Returns width and height;
/// {0, 0}: one block for each is too much.
std::array<int, 2> fit(std::vector<Raster>& images, std::vector<PackedRect>& rects, int largest) {
  while (true) {
    rects.clear();
    bool is_least = true;
    for (const Raster& image : images) {
      rects.push_back({blocks(image.width), blocks(image.height)});
      is_least = is_least && image.width <= kBlock && image.height <= kBlock;
    }
    const std::array<int, 2> size = pack_rects(rects, largest);
    if (size[0] > 0 || is_least) return size;
    for (Raster& image : images)
      if (image.width > kBlock || image.height > kBlock) image = halve(image);
  }
}

TileLook shared(const PlannedTile& tile, int largest) {
  double pixel = 0;  // what each covers from where finer tiles take this one's place on
  for (const TilePart& part : tile.parts)
    if (!tile.is_finest) pixel = std::max(pixel, part.gsd);
  std::vector<Raster> images;
  const LevelLook* first = nullptr;
  for (const TilePart& part : tile.parts) {
    const LevelLook& own = part.level->look;
    if (own.has_texture() && own.raster.rgb.empty()) return colored(tile, level_colors);
    images.push_back(as_seen(part, pixel));
    if (own.has_texture() && !first) first = &own;
  }
  std::vector<PackedRect> rects;
  const auto [width, height] = fit(images, rects, largest);
  if (width == 0) return colored(tile, level_colors);
  TileLook look;
  Raster whole(width, height);
  std::fill(whole.rgb.begin(), whole.rgb.end(), kPlain[0]);
  for (std::size_t i = 0; i < tile.parts.size(); ++i)
    look.parts.push_back(moved(tile.parts[i].level->look, tile.parts[i].mesh->triangles.size(),
                               images[i], rects[i], whole));
  look.whole.uvs = look.parts.front().uvs;  // that there is a texture
  look.whole.format = first->format;
  look.whole.quality = tile.is_finest ? first->quality : std::min(first->quality, kCoarseQuality);
  look.whole.has_fallback = first->has_fallback;
  look.whole.encode(whole);
  return look;
}

}  // namespace

CoarsestLook coarsest_look(const ExportLevel& coarsest) {
  return {coarsest.mesh.mesh(), coarsest.mesh.facet_of_triangle, coarsest.look.facet_colors};
}

TileLook look_of_levels(const PlannedTile& tile, int largest) {
  const auto any = [&](auto&& holds) {
    return std::any_of(tile.parts.begin(), tile.parts.end(),
                       [&](const TilePart& part) { return holds(part.level->look); });
  };
  if (any([](const LevelLook& look) { return look.has_texture(); }))
    return tile.parts.size() == 1 ? TileLook{{tile.parts[0].level->look}, tile.parts[0].level->look}
                                  : shared(tile, largest);
  if (any([](const LevelLook& look) { return !look.facet_colors.empty(); }))
    return colored(tile, level_colors);
  return {std::vector<LevelLook>(tile.parts.size()), {}};
}

TileLook look_of_stand_ins(const PlannedTile& tile,
                           const std::function<CoarsestLook(int building)>& coarsest) {
  return colored(tile, [&](const TilePart& part) { return side_colors(part, coarsest); });
}

}  // namespace colod
