// Based on: charts as connected in their image.
#include "image_charts.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/union_find.h"

namespace colod {

namespace {

bool is_inside(const std::array<Vec2f, 3>& uvs) {
  constexpr float kSlack = 1e-4f;
  return std::all_of(uvs.begin(), uvs.end(), [](const Vec2f& uv) {
    return uv.allFinite() && uv.minCoeff() >= -kSlack && uv.maxCoeff() <= 1 + kSlack;
  });
}

int in_fours(int pixels) { return (pixels + 3) / 4 * 4; }

}  // namespace

std::vector<Worn> worn_by_image(const Source& source) {
  const Appearance& look = source.look;
  std::vector<Worn> worn(look.images.size());
  if (look.uvs.empty()) return worn;
  for (std::size_t f = 0; f < look.face_material.size(); ++f) {
    const int m = look.face_material[f];
    const int image = m < 0 ? -1 : look.materials[static_cast<std::size_t>(m)].image;
    if (image < 0) continue;
    Worn& own = worn[static_cast<std::size_t>(image)];
    own.faces.push_back(f);
    own.is_repeated |= !is_inside(look.uvs[f]);
  }
  return worn;
}

void find_charts(const Source& source, int width, int height, int margin, Worn& worn) {
  UnionFind sets(worn.faces.size());
  std::map<std::array<float, 2>, int> first;
  for (std::size_t i = 0; i < worn.faces.size(); ++i)
    for (const Vec2f& uv : source.look.uvs[worn.faces[i]]) {
      const auto [at, is_new] = first.try_emplace({uv.x(), uv.y()}, static_cast<int>(i));
      if (!is_new) sets.unite(at->second, static_cast<int>(i));
    }
  std::map<int, int> number;
  std::vector<Box> boxes;
  for (std::size_t i = 0; i < worn.faces.size(); ++i) {
    const auto [at, is_new] =
        number.try_emplace(sets.find(static_cast<int>(i)), static_cast<int>(boxes.size()));
    if (is_new) boxes.emplace_back();
    worn.chart.push_back(at->second);
    for (const Vec2f& uv : source.look.uvs[worn.faces[i]])
      boxes[static_cast<std::size_t>(at->second)].extend(
          Vec3(uv.x() * static_cast<float>(width), uv.y() * static_cast<float>(height), 0));
  }
  const auto along = [margin](double least, double most, int pixels) {
    const int from = std::clamp(static_cast<int>(least) - margin, 0, pixels - 1);
    const int to = std::min(pixels, static_cast<int>(std::ceil(most)) + margin);
    return std::array{from, std::max(1, to - from)};
  };
  for (const Box& box : boxes) {
    const auto [x, columns] = along(box.min.x(), box.max.x(), width);
    const auto [y, rows] = along(box.min.y(), box.max.y(), height);
    worn.charts.push_back({x, y, columns, rows});
  }
}

PackedRect rect_of(int width, int height) { return {in_fours(width), in_fours(height)}; }

void copy_chart(const Raster& from, const Chart& chart, const PackedRect& rect, Raster& to) {
  for (int y = 0; y < rect.height; ++y)
    for (int x = 0; x < rect.width; ++x) {
      const int u = chart.x + std::min(x, chart.width - 1),
                v = chart.y + std::min(y, chart.height - 1);
      std::copy_n(from.at(u, v), 3, to.at(rect.x + x, rect.y + y));
      if (!to.alpha.empty())
        to.alpha[static_cast<std::size_t>(rect.y + y) * to.width + rect.x + x] =
            from.alpha[static_cast<std::size_t>(v) * from.width + u];
    }
}

}  // namespace colod
