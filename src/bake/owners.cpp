// Based on: own work.
#include "owners.h"

#include <algorithm>
#include <cmath>

#include "core/flat.h"
#include "spans.h"

namespace colod::bake {

using namespace parameters::bake;

namespace {

/// Through a side of a triangle; its normal is a unit one and points inward.
struct Line {
  Vec2 normal;
  double offset;
};

std::array<Line, 3> lines(const Corners& c) {
  std::array<Line, 3> out;
  for (int k = 0; k < 3; ++k) {
    const Vec2 along = c.at[(k + 1) % 3] - c.at[k];
    const double length = along.norm();
    const Vec2 normal = length > 0 ? Vec2(-along.y() / length, along.x() / length) : Vec2(0, 0);
    out[k] = {normal, normal.dot(c.at[k])};
  }
  return out;
}

/// Whether a place is at least so far out of a triangle, by one of its sides; most places are.
bool is_beyond(const std::array<Line, 3>& sides, const Vec2& q, double distance) {
  return std::any_of(sides.begin(), sides.end(), [&](const Line& side) {
    return side.normal.dot(q) - side.offset < -distance;
  });
}

/// The rows of a window that a triangle comes to within the border.
Span rows_of(const Window& w, const Corners& c) {
  const auto from = [&](double v) {
    return std::clamp(static_cast<int>(std::floor(v)) - w.y, 0, w.height);
  };
  const auto [least, most] = std::minmax({c.at[0].y(), c.at[1].y(), c.at[2].y()});
  return {from(least - kBorder), from(most + kBorder + 1)};
}

Vec2 middle_of(const Window& w, int x, int y) { return {w.x + x + 0.5, w.y + y + 0.5}; }

/// Gives a triangle the texels that it holds the middle of, and no earlier one does.
void fill_inside(const Window& w, const Corners& c, std::size_t t, std::vector<Owner>& out) {
  const Span rows = rows_of(w, c);
  for (int y = rows.begin; y < rows.end; ++y) {
    Span span{0, w.width};
    for (int k = 0; k < 3; ++k) {
      const Vec2 along = c.at[(k + 1) % 3] - c.at[k];
      span.narrow(cross(along, middle_of(w, 0, y) - c.at[k]), -along.y());
    }
    span.shrink([&](int x) { return c.holds(middle_of(w, x, y)); });
    for (int x = span.begin; x < span.end; ++x) {
      Owner& own = out[static_cast<std::size_t>(y) * w.width + x];
      if (own.triangle < 0) own = {static_cast<int>(t), 0};
    }
  }
}

/// Gives it the texels of no triangle that it is the nearest to.
void fill_border(const Window& w, const Corners& c, std::size_t t, std::vector<Owner>& out) {
  const std::array<Line, 3> sides = lines(c);
  const Span rows = rows_of(w, c);
  for (int y = rows.begin; y < rows.end; ++y) {
    Span span{0, w.width};
    for (const Line& side : sides)
      span.narrow(side.normal.dot(middle_of(w, 0, y)) - side.offset + kBorder, side.normal.x());
    for (int x = span.begin; x < span.end; ++x) {
      Owner& own = out[static_cast<std::size_t>(y) * w.width + x];
      const Vec2 middle = middle_of(w, x, y);
      if (own.distance <= 0 || is_beyond(sides, middle, own.distance)) continue;
      const double d = (c.nearest(middle) - middle).norm();
      if (d < own.distance) own = {static_cast<int>(t), d};
    }
  }
}

}  // namespace

bool Corners::holds(const Vec2& q) const {
  for (int k = 0; k < 3; ++k)
    if (cross(at[(k + 1) % 3] - at[k], q - at[k]) < 0) return false;
  return true;
}

Vec2 Corners::nearest(const Vec2& q) const {
  if (holds(q)) return q;
  Vec2 best = at[0];
  double least = kInfinity;
  for (int k = 0; k < 3; ++k) {
    const Vec2 along = at[(k + 1) % 3] - at[k];
    const double square = along.squaredNorm();
    const double t = square > 0 ? std::clamp((q - at[k]).dot(along) / square, 0.0, 1.0) : 0;
    const Vec2 p = at[k] + t * along;
    if ((p - q).squaredNorm() < least) least = (p - q).squaredNorm(), best = p;
  }
  return best;
}

std::vector<Owner> owners(const Window& w, const std::vector<Corners>& triangles) {
  std::vector<Owner> out(static_cast<std::size_t>(w.width) * w.height);
  for (std::size_t t = 0; t < triangles.size(); ++t) fill_inside(w, triangles[t], t, out);
  for (std::size_t t = 0; t < triangles.size(); ++t) fill_border(w, triangles[t], t, out);
  return out;
}

}  // namespace colod::bake
