// Based on: own work.
#include "border.h"

#include <algorithm>
#include <cmath>

#include "parameters.h"

namespace colod {

using namespace parameters::whole_place;

std::vector<Edge> open_edges(const Mesh& mesh) {
  std::vector<Edge> edges, open;
  for (const Face& f : mesh.faces)
    for (std::size_t k = 0; k < 3; ++k)
      edges.push_back({std::min(f[k], f[(k + 1) % 3]), std::max(f[k], f[(k + 1) % 3])});
  std::sort(edges.begin(), edges.end());
  for (std::size_t e = 0, end = 0; e < edges.size(); e = end) {
    while (end < edges.size() && edges[end] == edges[e]) ++end;
    if (end - e == 1) open.push_back(edges[e]);
  }
  return open;
}

int straight_sides(const Mesh& mesh, const std::vector<Edge>& open, const Box& box) {
  const double in_plane = std::max(kStraight, kStraightShare * box.size().head<2>().maxCoeff());
  std::array<double, 4> spanned{};
  for (const Edge& e : open)
    for (int side = 0; side < 4; ++side) {
      const Vec3 &a = mesh.vertices[e[0]], &b = mesh.vertices[e[1]];
      const int across = side / 2;
      const double at = side % 2 ? box.max[across] : box.min[across];
      if (std::max(std::abs(a[across] - at), std::abs(b[across] - at)) <= in_plane)
        spanned[static_cast<std::size_t>(side)] += std::abs(a[1 - across] - b[1 - across]);
    }
  int count = 0;
  for (int side = 0; side < 4; ++side)
    count += spanned[static_cast<std::size_t>(side)] >= kSpanned * box.size()[side < 2 ? 1 : 0];
  return count;
}

std::vector<char> ends_at_top(const Mesh& mesh, const std::vector<Edge>& open,
                              const HeightMap& map) {
  std::vector<char> ends(map.size(), 0);
  const auto mark = [&](const Vec3& p) {
    const Vec2 at = (p.head<2>() - map.origin) / map.cell;
    const int x = static_cast<int>(at.x()), y = static_cast<int>(at.y());
    for (int v = std::max(0, y - 1); v <= std::min(map.height - 1, y + 1); ++v)
      for (int u = std::max(0, x - 1); u <= std::min(map.width - 1, x + 1); ++u)
        if (std::abs(map.top[map.at(u, v)] - p.z()) <= kAtTop) ends[map.at(u, v)] = 1;
  };
  for (const Edge& e : open) {
    const Vec3 &a = mesh.vertices[e[0]], &b = mesh.vertices[e[1]];
    const int steps = static_cast<int>((b - a).head<2>().norm() / map.cell) + 1;
    for (int i = 0; i <= steps; ++i) mark(a + (b - a) * (static_cast<double>(i) / steps));
  }
  return ends;
}

}  // namespace colod
