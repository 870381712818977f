// Based on: own work.
#include "survey.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "core/parallel.h"
#include "image/cache.h"
#include "parameters.h"

namespace colod {

namespace {

using namespace parameters::survey;

constexpr Rgb kNone = {128, 128, 128};

/// What a tile shows from above, on the scene's grid.
struct Patch {
  int x = 0, y = 0, width = 0, height = 0;
  std::vector<float> top;
  std::vector<Rgb> color;
};

/// Looks up a face's colour at about the size of a cell.
class Painter {
 public:
  Painter(const Source& source, const ImageCache& images, double cell)
      : source_(source), images_(images), cell_(cell) {}

  /// Called with rising faces; keeps the image of the last one.
  Rgb color(std::size_t f, const Vec3& weights) {
    const Appearance& look = source_.look;
    std::array<float, 3> light = {1, 1, 1};
    const int m = look.face_material.empty() ? -1 : look.face_material[f];
    if (m >= 0) {
      const Material& material = look.materials[static_cast<std::size_t>(m)];
      light = material.color;
      if (material.image >= 0 && !look.uvs.empty()) multiply(f, material, weights, light);
    }
    if (!look.colors.empty())
      for (std::size_t k = 0; k < 3; ++k) {
        double sum = 0;
        for (std::size_t c = 0; c < 3; ++c)
          sum += weights[static_cast<int>(c)] * to_linear(look.colors[f][c][k]);
        light[k] *= static_cast<float>(sum);
      }
    return {to_srgb(light[0]), to_srgb(light[1]), to_srgb(light[2])};
  }

 private:
  void multiply(std::size_t f, const Material& material, const Vec3& w,
                std::array<float, 3>& light) {
    const auto& uvs = source_.look.uvs[f];
    const Vec2f uv = static_cast<float>(w[0]) * uvs[0] + static_cast<float>(w[1]) * uvs[1] +
                     static_cast<float>(w[2]) * uvs[2];
    if (!uv.allFinite()) return;
    if (material.image != image_) {
      image_ = material.image;
      entry_ = images_.get(source_.look.images[static_cast<std::size_t>(image_)]);
    }
    if (!entry_.pyramid) return;
    if (f != face_) face_ = f, level_ = level_of(f);
    const Raster& raster = entry_.pyramid->levels[level_];
    const auto wrap = [](float x, int size) {
      const float part = x - std::floor(x);
      return std::clamp(static_cast<int>(part * static_cast<float>(size)), 0, size - 1);
    };
    const std::uint8_t* rgb = raster.at(wrap(uv.x(), raster.width), wrap(uv.y(), raster.height));
    for (std::size_t k = 0; k < 3; ++k) light[k] *= to_linear(rgb[k]);
  }

  /// Of the image's levels the one whose texels are about as large as a cell on this face.
  std::size_t level_of(std::size_t f) const {
    const auto& uvs = source_.look.uvs[f];
    const Vec2f a = uvs[1] - uvs[0], b = uvs[2] - uvs[0];
    const Raster& first = entry_.pyramid->levels[0];
    const double texels =
        0.5 * std::abs(a.x() * b.y() - a.y() * b.x()) * first.width * first.height;
    const double area = face_area(source_.mesh, source_.mesh.faces[f]);
    const double per_cell = area > 0 ? std::sqrt(texels / area) * cell_ : 1;
    const double level = std::floor(std::log2(std::max(per_cell, 1.0)));
    return std::min(static_cast<std::size_t>(level), entry_.pyramid->levels.size() - 1);
  }

  const Source& source_;
  const ImageCache& images_;
  double cell_;
  int image_ = -1;
  ImageCache::Entry entry_;
  std::size_t face_ = static_cast<std::size_t>(-1), level_ = 0;
};

/// The cells whose middle a face covers, seen from above.
template <typename Body>
void for_each_middle(const Mesh& mesh, const Face& face, const HeightMap& map, Body body) {
  const Vec3 *a = &mesh.vertices[static_cast<std::size_t>(face[0])],
             *b = &mesh.vertices[static_cast<std::size_t>(face[1])],
             *c = &mesh.vertices[static_cast<std::size_t>(face[2])];
  const auto cross = [](const Vec2& u, const Vec2& v) { return u.x() * v.y() - u.y() * v.x(); };
  const double twice = cross((*b - *a).head<2>(), (*c - *a).head<2>());
  if (std::abs(twice) < 1e-12) return;
  const Vec2 low = a->cwiseMin(*b).cwiseMin(*c).head<2>(),
             high = a->cwiseMax(*b).cwiseMax(*c).head<2>();
  const auto first = [&](double v, double origin) {
    return std::max(0, static_cast<int>(std::ceil((v - origin) / map.cell - 0.5)));
  };
  const int x1 = std::min(map.width, first(high.x(), map.origin.x()) + 1);
  const int y1 = std::min(map.height, first(high.y(), map.origin.y()) + 1);
  for (int y = first(low.y(), map.origin.y()); y < y1; ++y)
    for (int x = first(low.x(), map.origin.x()); x < x1; ++x) {
      const Vec2 p = map.middle(x, y);
      const double u =
          cross((*b - p.homogeneous()).head<2>(), (*c - p.homogeneous()).head<2>()) / twice;
      const double v =
          cross((*c - p.homogeneous()).head<2>(), (*a - p.homogeneous()).head<2>()) / twice;
      const Vec3 w(u, v, 1 - u - v);
      if (w.minCoeff() < -1e-9) continue;
      body(x, y, w, w[0] * a->z() + w[1] * b->z() + w[2] * c->z());
    }
}

Patch look_at(const Source& source, const Box& box, const HeightMap& map,
              const ImageCache& images) {
  Patch patch;
  const auto cell = [&](double v, double origin) {
    return static_cast<int>(std::floor((v - origin) / map.cell));
  };
  patch.x = std::clamp(cell(box.min.x(), map.origin.x()), 0, map.width - 1);
  patch.y = std::clamp(cell(box.min.y(), map.origin.y()), 0, map.height - 1);
  patch.width = std::min(map.width, cell(box.max.x(), map.origin.x()) + 1) - patch.x;
  patch.height = std::min(map.height, cell(box.max.y(), map.origin.y()) + 1) - patch.y;
  patch.top.assign(static_cast<std::size_t>(patch.width) * patch.height, NAN);
  if (!source.look.is_empty()) patch.color.assign(patch.top.size(), kNone);
  Painter painter(source, images, map.cell);
  for (std::size_t f = 0; f < source.mesh.faces.size(); ++f)
    for_each_middle(source.mesh, source.mesh.faces[f], map,
                    [&](int x, int y, const Vec3& weights, double z) {
                      const int px = x - patch.x, py = y - patch.y;
                      if (px < 0 || py < 0 || px >= patch.width || py >= patch.height) return;
                      const std::size_t i = static_cast<std::size_t>(py) * patch.width + px;
                      if (patch.top[i] >= static_cast<float>(z)) return;
                      patch.top[i] = static_cast<float>(z);
                      if (!patch.color.empty()) patch.color[i] = painter.color(f, weights);
                    });
  return patch;
}

/// The higher one shows, of equal ones the lighter: the order of tiles does not matter.
void lay(const Patch& patch, HeightMap& map) {
  for (int y = 0; y < patch.height; ++y)
    for (int x = 0; x < patch.width; ++x) {
      const std::size_t from = static_cast<std::size_t>(y) * patch.width + x;
      const std::size_t to = map.at(patch.x + x, patch.y + y);
      if (std::isnan(patch.top[from])) continue;
      const Rgb rgb = patch.color.empty() ? kNone : patch.color[from];
      const bool is_seen = std::isnan(map.top[to]) || patch.top[from] > map.top[to] ||
                           (patch.top[from] == map.top[to] && rgb > map.color[to]);
      if (is_seen) map.top[to] = patch.top[from], map.color[to] = rgb;
    }
}

}  // namespace

void draw_from_above(const Source& source, const ImageCache& images, HeightMap& map) {
  if (source.mesh.faces.empty()) return;
  lay(look_at(source, bounding_box(source.mesh.vertices), map, images), map);
}

HeightMap survey(const SceneTiles& tiles, std::size_t image_memory) {
  HeightMap map;
  const Box& box = tiles.box();
  const Vec3 size = box.size();
  // A long map has a row of cells more than its area asks for.
  map.cell = std::max({kCell, std::sqrt(size.x() * size.y() / kMostCells),
                       4 * std::max(size.x(), size.y()) / kMostCells});
  map.origin = box.min.head<2>();
  map.width = static_cast<int>(std::ceil(size.x() / map.cell)) + 1;
  map.height = static_cast<int>(std::ceil(size.y() / map.cell)) + 1;
  map.top.assign(static_cast<std::size_t>(map.width) * map.height, NAN);
  map.color.assign(map.top.size(), kNone);
  const ImageCache images(image_memory);
  std::mutex mutex;
  bool has_color = false;
  parallel_for(tiles.count(), [&](std::size_t i) {
    const Patch patch = look_at(*tiles.get(i), tiles.box(i), map, images);
    const std::lock_guard lock(mutex);
    has_color |= !patch.color.empty();
    lay(patch, map);
  });
  if (!has_color) map.color.clear();
  return map;
}

}  // namespace colod
