// Based on: own work.
#include "owners.h"

#include <algorithm>
#include <cmath>

#include "core/flat.h"

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
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& at = triangles[t].at;
    const std::array<Line, 3> sides = lines(triangles[t]);
    const Vec2 least = at[0].cwiseMin(at[1]).cwiseMin(at[2]);
    const Vec2 most = at[0].cwiseMax(at[1]).cwiseMax(at[2]);
    const auto from = [](double v, int begin, int n) {
      return std::clamp(static_cast<int>(std::floor(v)) - begin, 0, n);
    };
    const int x0 = from(least.x() - kBorder, w.x, w.width);
    const int x1 = from(most.x() + kBorder + 1, w.x, w.width);
    const int y0 = from(least.y() - kBorder, w.y, w.height);
    const int y1 = from(most.y() + kBorder + 1, w.y, w.height);
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) {
        Owner& own = out[static_cast<std::size_t>(y) * w.width + x];
        if (own.distance <= 0) continue;
        const Vec2 middle(w.x + x + 0.5, w.y + y + 0.5);
        if (is_beyond(sides, middle, own.distance)) continue;
        const double d = (triangles[t].nearest(middle) - middle).norm();
        if (d < own.distance) own = {static_cast<int>(t), d};
      }
  }
  return out;
}

}  // namespace colod::bake
