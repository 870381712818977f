// Based on: own work.
#include "border.h"

#include <algorithm>
#include <cmath>

#include "core/flat.h"
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

namespace {

/// An upright plane along a side of the plan's hull.
struct Side {
  Vec2 from, along;    ///< a unit vector
  double in_plane;     ///< metres that still count
  double length = 0;   ///< of the hull in the plane
  double spanned = 0;  ///< metres of open edges in it

  bool has(const Vec2& p) const { return std::abs(cross(along, p - from)) <= in_plane; }
  double at(const Vec2& p) const { return along.dot(p - from); }
};

using PlanLine = std::array<Vec2, 2>;

/// Those of the hull that are nearly as long as it is, each once.
std::vector<Side> long_sides(const std::vector<Vec2>& hull, double in_plane) {
  std::vector<PlanLine> lines;
  for (std::size_t i = 0; i < hull.size(); ++i)
    lines.push_back({hull[i], hull[(i + 1) % hull.size()]});
  std::stable_sort(lines.begin(), lines.end(), [](const PlanLine& a, const PlanLine& b) {
    return (a[1] - a[0]).squaredNorm() > (b[1] - b[0]).squaredNorm();
  });
  std::vector<Side> sides;
  for (const auto& [a, b] : lines) {
    Side side{a, (b - a).normalized(), in_plane};
    const auto is_it = [a = a, b = b](const Side& s) { return s.has(a) && s.has(b); };
    if (std::any_of(sides.begin(), sides.end(), is_it)) continue;
    std::array<double, 2> own = {0, 0}, whole = {0, 0};
    for (const Vec2& p : hull) {
      const double at = side.at(p);
      whole = {std::min(whole[0], at), std::max(whole[1], at)};
      if (side.has(p)) own = {std::min(own[0], at), std::max(own[1], at)};
    }
    side.length = own[1] - own[0];
    if (side.length >= kLongSide * (whole[1] - whole[0])) sides.push_back(side);
  }
  return sides;
}

Vec2 plan_of(const Mesh& mesh, int vertex) {
  return mesh.vertices[static_cast<std::size_t>(vertex)].head<2>();
}

}  // namespace

int straight_sides(const Mesh& mesh, const std::vector<Edge>& open) {
  std::vector<Vec2> plan;
  for (const Vec3& v : mesh.vertices)
    if (v.allFinite()) plan.push_back(v.head<2>());
  const double width = bounding_box(mesh.vertices).size().head<2>().maxCoeff();
  std::vector<Side> sides =
      long_sides(convex_hull(std::move(plan)), std::max(kStraightSide, kStraightShare * width));
  for (const Edge& e : open)
    for (Side& side : sides) {
      const Vec2 a = plan_of(mesh, e[0]), b = plan_of(mesh, e[1]);
      if (side.has(a) && side.has(b)) side.spanned += std::abs(side.at(b) - side.at(a));
    }
  return static_cast<int>(std::count_if(
      sides.begin(), sides.end(), [](const Side& s) { return s.spanned >= kSpanned * s.length; }));
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
