// Based on: own work.
#include "closing.h"

#include <algorithm>
#include <cmath>

#include "cutter.h"
#include "ground_tint.h"
#include "parameters.h"
#include "tiles.h"

namespace colod {

namespace {

using namespace parameters::closing;

using FlatPolygon = std::vector<Vec2>;

Vec2 snapped(const Vec2& p) { return (p / kGrid).array().round() * kGrid; }

/// Where an edge meets a line of the grid; the same for both of its directions.
Vec2 crossing(Vec2 a, Vec2 b, int axis, double at) {
  if (b[axis] < a[axis]) std::swap(a, b);
  Vec2 p = snapped(a + (at - a[axis]) / (b[axis] - a[axis]) * (b - a));
  p[axis] = at;
  return p;
}

/// A convex polygon cut along all lines across an axis that it meets.
void slice(FlatPolygon rest, int axis, std::vector<FlatPolygon>& out) {
  const auto [least, most] = std::minmax_element(
      rest.begin(), rest.end(), [&](const Vec2& a, const Vec2& b) { return a[axis] < b[axis]; });
  const double end = (*most)[axis];
  for (double at = kSide * (std::floor((*least)[axis] / kSide) + 1); at < end; at += kSide) {
    FlatPolygon low, high;
    for (std::size_t i = 0; i < rest.size(); ++i) {
      const Vec2 &a = rest[i], &b = rest[(i + 1) % rest.size()];
      if (a[axis] <= at) low.push_back(a);
      if (a[axis] >= at) high.push_back(a);
      if ((a[axis] - at) * (b[axis] - at) >= 0) continue;
      const Vec2 p = crossing(a, b, axis, at);
      low.push_back(p), high.push_back(p);
    }
    out.push_back(std::move(low));
    rest = std::move(high);
  }
  out.push_back(std::move(rest));
}

}  // namespace

ClosingGround::ClosingGround(const HeightMap& map, const SceneClasses& classes)
    : map_(map), classes_(classes), tint_(std::make_unique<const GroundTint>(map, classes)) {}

ClosingGround::~ClosingGround() = default;

std::array<int, 2> ClosingGround::cell_at(const Vec2& p) const {
  const Vec2 at = (p - map_.origin) / map_.cell;
  return {std::clamp(static_cast<int>(std::floor(at.x())), 0, map_.width - 1),
          std::clamp(static_cast<int>(std::floor(at.y())), 0, map_.height - 1)};
}

std::size_t ClosingGround::index_at(const Vec2& p) const {
  const auto [x, y] = cell_at(p);
  return map_.at(x, y);
}

bool ClosingGround::is_bare(std::size_t cell) const {
  return std::abs(map_.top[cell] - classes_.ground[cell]) < kBare;
}

double ClosingGround::height(std::size_t cell) const {
  return is_bare(cell) ? map_.top[cell] : classes_.ground[cell];
}

/// Between the middles of cells.
double ClosingGround::height_at(const Vec2& p) const {
  const auto [x0, y0] = cell_at(p - Vec2::Constant(map_.cell / 2));
  const int x1 = std::min(x0 + 1, map_.width - 1), y1 = std::min(y0 + 1, map_.height - 1);
  const Vec2 part = ((p - map_.middle(x0, y0)) / map_.cell).cwiseMax(0).cwiseMin(1);
  const auto along = [&, from = x0](int y) {
    return (1 - part.x()) * height(map_.at(from, y)) + part.x() * height(map_.at(x1, y));
  };
  return (1 - part.y()) * along(y0) + part.y() * along(y1);
}

double ClosingGround::lowest(const Vec2& p) const {
  const auto [x, y] = cell_at(p);
  double least = height_at(p);
  for (int v = std::max(0, y - 1); v <= std::min(map_.height - 1, y + 1); ++v)
    for (int u = std::max(0, x - 1); u <= std::min(map_.width - 1, x + 1); ++u) {
      const std::size_t i = map_.at(u, v);
      least = std::min<double>(least, classes_.ground[i]);
      if (map_.top[i] < least) least = map_.top[i];  // no number: nothing is there
    }
  return least;
}

Rgb ClosingGround::color_at(const Vec2& p) const {
  const std::size_t cell = index_at(p);
  return is_bare(cell) ? map_.color[cell] : tint_->at(p);
}

/// Cut along the lines of one grid, so that neighbours have the same vertices where they meet.
Source ClosingGround::below(const std::vector<Territories::Piece>& pieces) const {
  Source out;
  for (const Territories::Piece& piece : pieces) {
    std::vector<FlatPolygon> strips, squares;
    const auto& c = piece.corners;
    slice({snapped(c[0]), snapped(c[1]), snapped(c[2])}, 0, strips);
    for (FlatPolygon& strip : strips) slice(std::move(strip), 1, squares);
    for (const FlatPolygon& p : squares)
      for (std::size_t k = 1; k + 1 < p.size(); ++k) add_face({p[0], p[k], p[k + 1]}, out);
  }
  return joined({out});
}

void ClosingGround::add_face(const std::array<Vec2, 3>& corners, Source& out) const {
  Face face;
  std::array<Rgb, 3> colors;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2& p = corners[k];
    face[k] = static_cast<int>(out.mesh.vertices.size());
    out.mesh.vertices.emplace_back(p.x(), p.y(), height_at(p));
    if (!map_.color.empty()) colors[k] = color_at(p);
  }
  out.mesh.faces.push_back(face);
  if (!map_.color.empty()) out.look.colors.push_back(colors);
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
      is_all &= std::abs(p.z() - classes_.ground[index_at(p.head<2>())]) < kBare;
    }
    if (is_all) cutter.add_whole(f);
  }
  return cutter.take();
}

}  // namespace colod
