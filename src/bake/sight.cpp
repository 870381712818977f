// Based on: the depth buffer (Catmull 1974), with edge functions (Pineda, A parallel algorithm for
// polygon rasterization, SIGGRAPH 1988).
// Differs: depth counts to both sides of the chart, and only faces that agree with it are drawn.
#include "sight.h"

#include <algorithm>
#include <cmath>

#include "core/flat.h"
#include "parameters.h"
#include "spans.h"

namespace colod::bake {

using namespace parameters::bake;

namespace {

/// Of n that are kNearest wide, the one that holds a place or is nearest to it.
int cell(double metres, int n) {
  return static_cast<int>(std::clamp<double>(std::floor(metres / kNearest), 0, n - 1));
}

}  // namespace

Sight::Sight(const Mesh& source, const Probe& probe, const Chart& chart, double reach)
    : source_(&source),
      chart_(&chart),
      reach_(reach),
      columns_(static_cast<int>(chart.width / kNearest) + 1),
      rows_(static_cast<int>(chart.height / kNearest) + 1) {
  is_near_.assign(static_cast<std::size_t>(columns_) * rows_, 0);
  const Eigen::Array2d size(chart.width, chart.height);
  for (std::size_t f = 0; f < source.faces.size(); ++f) {
    const int face = static_cast<int>(f);
    if (!probe.agrees(face, chart.normal)) continue;
    Vec3 least = Vec3::Constant(kInfinity), most = Vec3::Constant(-kInfinity);
    for (const Vec3& c : corners(face)) least = least.cwiseMin(c), most = most.cwiseMax(c);
    const double far = std::max(reach, kNearest);
    if (least.z() > far || most.z() < -far || (most.head<2>().array() < -kNearest).any() ||
        (least.head<2>().array() > size + kNearest).any())
      continue;
    candidates_.push_back({face, least.head<2>().cast<float>(), most.head<2>().cast<float>()});
    if (least.z() <= kNearest && most.z() >= -kNearest) mark_near(least.head<2>(), most.head<2>());
  }
}

void Sight::mark_near(const Vec2& least, const Vec2& most) {
  for (int y = cell(least.y() - kNearest, rows_); y <= cell(most.y() + kNearest, rows_); ++y)
    for (int x = cell(least.x() - kNearest, columns_); x <= cell(most.x() + kNearest, columns_);
         ++x)
      is_near_[static_cast<std::size_t>(y) * columns_ + x] = 1;
}

bool Sight::may_be_near(const Vec2& q) const {
  return is_near_[static_cast<std::size_t>(cell(q.y(), rows_)) * columns_ + cell(q.x(), columns_)];
}

std::array<Vec3, 3> Sight::corners(int face) const {
  std::array<Vec3, 3> out;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3& p = source_->vertices[source_->faces[static_cast<std::size_t>(face)][k]];
    out[k] << chart_->flat(p), (p - chart_->origin).dot(chart_->normal);
  }
  return out;
}

std::vector<Sighting> Sight::look(const SampleGrid& grid, const Probe::Holes& is_hole) const {
  std::vector<Sighting> out(grid.index(0, grid.rows));
  const Vec2 end = grid.begin + grid.step * Vec2(grid.columns, grid.rows);
  for (const Candidate& c : candidates_)
    if (c.most.x() >= grid.begin.x() && c.most.y() >= grid.begin.y() && c.least.x() <= end.x() &&
        c.least.y() <= end.y())
      draw(c.face, grid, is_hole, out);
  return out;
}

void Sight::draw(int face, const SampleGrid& grid, const Probe::Holes& is_hole,
                 std::vector<Sighting>& out) const {
  std::array<Vec3, 3> c = corners(face);
  std::array<Vec2, 3> at;
  for (std::size_t k = 0; k < 3; ++k) at[k] = (c[k].head<2>() - grid.begin) / grid.step;
  if (cross(at[1] - at[0], at[2] - at[0]) < 0) std::swap(at[1], at[2]), std::swap(c[1], c[2]);
  const double area = cross(at[1] - at[0], at[2] - at[0]);
  if (!(area > 0)) return;
  const Vec2 least = at[0].cwiseMin(at[1]).cwiseMin(at[2]);
  const Vec2 most = at[0].cwiseMax(at[1]).cwiseMax(at[2]);
  const auto clamped = [](double v, int n) {
    return static_cast<int>(std::clamp<double>(v, 0, n));
  };
  const int x0 = clamped(std::ceil(least.x()), grid.columns);
  const int x1 = clamped(std::floor(most.x()) + 1, grid.columns);
  const int y0 = clamped(std::ceil(least.y()), grid.rows);
  const int y1 = clamped(std::floor(most.y()) + 1, grid.rows);
  // Of each side, twice the area of the triangle that it makes with a place: the weight of the
  // corner across.
  std::array<Vec2, 3> side;
  for (std::size_t k = 0; k < 3; ++k) side[k] = at[(k + 1) % 3] - at[k];
  const auto weight = [&](std::size_t k, double x, double y) {
    return cross(side[k], Vec2(x, y) - at[k]);
  };
  const Vec3 depth = Vec3(c[2].z(), c[0].z(), c[1].z()) / area;  // of the corners across
  const double rate = -(depth[0] * side[0].y() + depth[1] * side[1].y() + depth[2] * side[2].y());
  for (int y = y0; y < y1; ++y) {
    Span span{x0, x1};
    for (std::size_t k = 0; k < 3; ++k) span.narrow(weight(k, 0, y), -side[k].y());
    // Weights grow or fall along a row, also as they are rounded: its places lie together.
    span.shrink([&](int x) {
      return std::min({weight(0, x, y), weight(1, x, y), weight(2, x, y)}) >= -kOnEdge * area;
    });
    const double first = depth[0] * weight(0, span.begin, y) + depth[1] * weight(1, span.begin, y) +
                         depth[2] * weight(2, span.begin, y);
    for (int x = span.begin; x < span.end; ++x) {
      const double offset = first + (x - span.begin) * rate;
      Sighting& own = out[grid.index(x, y)];
      const double known = own.face >= 0 ? std::abs(own.offset) : reach_;
      if (!(std::abs(offset) < known)) continue;
      if (is_hole) {
        const Vec3 place = chart_->lift(grid.at(x, y)) + offset * chart_->normal;
        if (is_hole(face, place)) continue;
      }
      own = {face, static_cast<float>(offset)};
    }
  }
}

}  // namespace colod::bake
