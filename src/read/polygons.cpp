// Based on: ear clipping (Meisters, Polygons have ears, 1975) in the plane of Newell's normal.
// Differs: a loop without an ear (crossing itself, or degenerate) loses its most convex corner, so
// that the loop always ends with n - 2 triangles.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "formats.h"

namespace colod::mesh_io {

namespace {

double turn(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// The loop seen along its Newell normal, counter-clockwise, about its first point.
std::vector<Vec2> project(const std::vector<Vec3>& ring) {
  Vec3 normal = Vec3::Zero();
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vec3 a = ring[i] - ring[0], b = ring[(i + 1) % ring.size()] - ring[0];
    normal += a.cross(b);
  }
  if (!(normal.norm() > 0)) normal = Vec3::UnitZ();
  const auto [u, v] = plane_basis(normal.normalized());
  std::vector<Vec2> flat;
  for (const Vec3& p : ring) flat.emplace_back((p - ring[0]).dot(u), (p - ring[0]).dot(v));
  return flat;
}

bool holds_a_corner(const std::vector<Vec2>& p, const std::vector<int>& loop, int i, int j, int k) {
  for (const int q : loop) {
    if (p[q] == p[i] || p[q] == p[j] || p[q] == p[k]) continue;
    if (turn(p[i], p[j], p[q]) >= 0 && turn(p[j], p[k], p[q]) >= 0 && turn(p[k], p[i], p[q]) >= 0)
      return true;
  }
  return false;
}

bool is_convex(const std::vector<Vec2>& p) {
  for (std::size_t i = 0; i < p.size(); ++i)
    if (turn(p[i], p[(i + 1) % p.size()], p[(i + 2) % p.size()]) <= 0) return false;
  double angle = 0;  // a star turns left everywhere but more than once around
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Vec2 a = p[(i + 1) % p.size()] - p[i], b = p[(i + 2) % p.size()] - p[(i + 1) % p.size()];
    angle += std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
  }
  return angle < 7;
}

}  // namespace

std::vector<Face> triangulate_ring(const std::vector<Vec3>& ring) {
  const int n = static_cast<int>(ring.size());
  std::vector<Face> triangles;
  if (n == 3) return {{0, 1, 2}};
  const std::vector<Vec2> p = project(ring);
  if (is_convex(p)) {
    for (int i = 1; i + 1 < n; ++i) triangles.push_back({0, i, i + 1});
    return triangles;
  }
  std::vector<int> loop(n);
  std::iota(loop.begin(), loop.end(), 0);
  std::size_t at = 0;
  while (loop.size() > 3) {
    const std::size_t m = loop.size();
    std::size_t best = 0, tried = 0;
    double best_turn = -1;
    for (; tried < m; ++tried) {
      const std::size_t j = (at + tried) % m;
      const int a = loop[(j + m - 1) % m], b = loop[j], c = loop[(j + 1) % m];
      const double t = turn(p[a], p[b], p[c]);
      if (t > best_turn) best_turn = t, best = j;
      if (t <= 0 || holds_a_corner(p, loop, a, b, c)) continue;
      best = j;
      break;
    }
    triangles.push_back({loop[(best + m - 1) % m], loop[best], loop[(best + 1) % m]});
    loop.erase(loop.begin() + static_cast<long>(best));
    at = best;
  }
  triangles.push_back({loop[0], loop[1], loop[2]});
  return triangles;
}

}  // namespace colod::mesh_io
