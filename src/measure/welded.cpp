// *Based on:* own work.
//
// *Differs:* no --rules here.
//
// *Notation:* none.
#include "welded.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace colod {
namespace {

constexpr double kCoplanarDistance = 1e-4;  // m
constexpr double kCoplanarAngleDeg = 0.1;
constexpr double kReliableHeight = 5e-3;  // m; a thinner face's normal says little

bool is_less(const Vec3& a, const Vec3& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

}  // namespace

Welded weld(const Mesh& mesh) {
  std::vector<int> order;
  for (int i = 0; i < static_cast<int>(mesh.vertices.size()); ++i)
    if (mesh.vertices[i].allFinite()) order.push_back(i);
  std::sort(order.begin(), order.end(),
            [&](int i, int j) { return is_less(mesh.vertices[i], mesh.vertices[j]); });
  Welded welded;
  std::vector<int> point_of_vertex(mesh.vertices.size(), -1);
  for (int i : order) {
    if (welded.points.empty() || welded.points.back() != mesh.vertices[i])
      welded.points.push_back(mesh.vertices[i]);
    point_of_vertex[i] = static_cast<int>(welded.points.size()) - 1;
  }
  for (const Face& f : mesh.faces) {
    const Face g = {point_of_vertex[f[0]], point_of_vertex[f[1]], point_of_vertex[f[2]]};
    const bool is_face =
        std::min({g[0], g[1], g[2]}) >= 0 && g[0] != g[1] && g[1] != g[2] && g[2] != g[0];
    if (is_face) welded.faces.push_back(g);
    welded.collapsed += !is_face;
  }
  return welded;
}

std::vector<EdgeUse> sorted_edge_uses(const std::vector<Face>& faces) {
  std::vector<EdgeUse> uses;
  uses.reserve(3 * faces.size());
  for (int f = 0; f < static_cast<int>(faces.size()); ++f)
    for (int s = 0; s < 3; ++s) {
      const int a = faces[f][s], b = faces[f][(s + 1) % 3];
      uses.push_back({std::min(a, b), std::max(a, b), f, s, a < b});
    }
  std::sort(uses.begin(), uses.end());
  return uses;
}

std::vector<std::array<int, 3>> face_neighbours(const Welded& m, const std::vector<EdgeUse>& uses) {
  std::vector<std::array<int, 3>> neighbours(m.faces.size(), {-1, -1, -1});
  for_each_edge(uses, [&](std::size_t first, std::size_t last) {
    if (last - first != 2) return;
    const EdgeUse &a = uses[first], &b = uses[first + 1];
    neighbours[a.face][a.side] = b.face;
    neighbours[b.face][b.side] = a.face;
  });
  return neighbours;
}

FaceShape face_shape(const Welded& m, const Face& f) {
  const Vec3 a = m.points[f[0]], ab = m.points[f[1]] - a, ac = m.points[f[2]] - a;
  const Vec3 cross = ab.cross(ac);
  const double twice = cross.norm();
  FaceShape shape;
  if (!(twice > 0)) return shape;
  shape.normal = cross / twice;
  shape.area = 0.5 * twice;
  shape.height = twice / std::max({ab.norm(), ac.norm(), (ac - ab).norm()});
  return shape;
}

std::vector<int> find_polygons(const Welded& m, const std::vector<std::array<int, 3>>& neighbours,
                               const std::vector<FaceShape>& shapes) {
  const double min_cos = std::cos(kCoplanarAngleDeg * M_PI / 180);
  std::vector<int> order(m.faces.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int i, int j) { return shapes[i].area > shapes[j].area; });
  std::vector<int> polygon(m.faces.size(), -1);
  const auto is_coplanar = [&](int seed, int face) {
    const double cos = shapes[seed].normal.dot(shapes[face].normal);
    if (cos < (shapes[face].height < kReliableHeight ? 0.0 : min_cos)) return false;
    const Vec3 base = m.points[m.faces[seed][0]];
    for (int v : m.faces[face])
      if (!(std::abs(shapes[seed].normal.dot(m.points[v] - base)) <= kCoplanarDistance))
        return false;
    return true;
  };
  int polygons = 0;
  for (int seed : order) {
    if (polygon[seed] >= 0 || shapes[seed].area == 0) continue;  // a degenerate face is no polygon
    std::vector<int> stack = {seed};
    polygon[seed] = polygons;
    while (!stack.empty()) {
      const int face = stack.back();
      stack.pop_back();
      for (int next : neighbours[face])
        if (next >= 0 && polygon[next] < 0 && is_coplanar(seed, next)) {
          polygon[next] = polygons;
          stack.push_back(next);
        }
    }
    ++polygons;
  }
  return polygon;
}

}  // namespace colod
