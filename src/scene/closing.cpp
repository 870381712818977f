// Based on: own work.
#include "closing.h"

#include <algorithm>
#include <cmath>

#include "cutter.h"
#include "parameters.h"

namespace colod {

namespace {

using namespace parameters::closing;

double side(const std::array<Vec2, 3>& t, int k) {
  const auto a = static_cast<std::size_t>(k);
  return (t[a] - t[(a + 1) % 3]).norm();
}

}  // namespace

ClosingGround::ClosingGround(const HeightMap& map, const SceneClasses& classes)
    : map_(map), classes_(classes) {
  if (map.color.empty()) return;
  std::array<double, 3> sum{};
  double count = 0;
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (classes.of_cell[i] != SceneClass::kGround) continue;
    for (std::size_t k = 0; k < 3; ++k) sum[k] += map.color[i][k];
    ++count;
  }
  for (std::size_t k = 0; k < 3 && count > 0; ++k)
    mean_[k] = static_cast<std::uint8_t>(sum[k] / count);
}

std::size_t ClosingGround::cell_at(const Vec2& p) const {
  const Vec2 at = (p - map_.origin) / map_.cell;
  return map_.at(std::clamp(static_cast<int>(at.x()), 0, map_.width - 1),
                 std::clamp(static_cast<int>(at.y()), 0, map_.height - 1));
}

bool ClosingGround::is_bare(std::size_t cell) const {
  return std::abs(map_.top[cell] - classes_.ground[cell]) < kBare;
}

double ClosingGround::height(std::size_t cell) const {
  return is_bare(cell) ? map_.top[cell] : classes_.ground[cell];
}

/// Halved by their longest sides until these are short, so that neighbours are halved alike.
Source ClosingGround::below(const std::vector<Territories::Piece>& pieces) const {
  Source out;
  std::vector<std::array<Vec2, 3>> open;
  for (const Territories::Piece& piece : pieces) open.push_back(piece.corners);
  while (!open.empty()) {
    const std::array<Vec2, 3> t = open.back();
    open.pop_back();
    int longest = 0;
    for (int k = 1; k < 3; ++k)
      if (side(t, k) > side(t, longest)) longest = k;
    if (side(t, longest) <= kLongest) {
      add_face(t, out);
      continue;
    }
    const auto a = static_cast<std::size_t>(longest);
    const Vec2 middle = 0.5 * (t[a] + t[(a + 1) % 3]);
    open.push_back({t[a], middle, t[(a + 2) % 3]});
    open.push_back({middle, t[(a + 1) % 3], t[(a + 2) % 3]});
  }
  return out;
}

void ClosingGround::add_face(const std::array<Vec2, 3>& corners, Source& out) const {
  Face face;
  for (std::size_t k = 0; k < 3; ++k) {
    face[k] = static_cast<int>(out.mesh.vertices.size());
    out.mesh.vertices.emplace_back(corners[k].x(), corners[k].y(), height(cell_at(corners[k])));
  }
  out.mesh.faces.push_back(face);
  if (map_.color.empty()) return;
  const std::size_t cell = cell_at((corners[0] + corners[1] + corners[2]) / 3);
  const Rgb rgb = is_bare(cell) ? map_.color[cell] : mean_;
  out.look.colors.push_back({rgb, rgb, rgb});
}

Source ClosingGround::terrain(int x0, int y0, int x1, int y1) const {
  Source out;
  const int width = x1 - x0 + 1;
  std::vector<int> number(static_cast<std::size_t>(width) * (y1 - y0 + 1), -1);
  const auto vertex = [&](int x, int y) {
    int& n = number[static_cast<std::size_t>(y - y0) * width + (x - x0)];
    if (n >= 0) return n;
    const Vec2 p = map_.middle(x, y);
    n = static_cast<int>(out.mesh.vertices.size());
    out.mesh.vertices.emplace_back(p.x(), p.y(), height(map_.at(x, y)));
    return n;
  };
  const auto is_there = [&](int x, int y) {
    return classes_.of_cell[map_.at(x, y)] != SceneClass::kNothing;
  };
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) {
      if (!is_there(x, y) || !is_there(x + 1, y) || !is_there(x, y + 1) || !is_there(x + 1, y + 1))
        continue;
      const int a = vertex(x, y), b = vertex(x + 1, y), c = vertex(x + 1, y + 1),
                d = vertex(x, y + 1);
      out.mesh.faces.push_back({a, b, c});
      out.mesh.faces.push_back({a, c, d});
    }
  return out;
}

Source ClosingGround::bare(const Source& source) const {
  Cutter cutter(source);
  for (std::size_t f = 0; f < source.mesh.faces.size(); ++f) {
    const Face& face = source.mesh.faces[f];
    bool is_all = true;
    for (const int v : face) {
      const Vec3& p = source.mesh.vertices[static_cast<std::size_t>(v)];
      is_all &= std::abs(p.z() - classes_.ground[cell_at(p.head<2>())]) < kBare;
    }
    if (is_all) cutter.add_whole(f);
  }
  return cutter.take();
}

}  // namespace colod
