// Based on: Toussaint, Solving geometric problems with the rotating calipers, 1983 (the smallest
// rectangle has a side on the hull).
#include "charts.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/flat.h"
#include "core/union_find.h"
#include "parameters.h"

namespace colod::bake {

namespace {

using namespace parameters::bake;

constexpr double kSamePlane = 1e-4;     // metres
constexpr double kSameNormal = 1e-7;    // 1 − cosine: 0.03 degrees
constexpr double kStep = 1.0905077327;  // 2^(1/8): texels grow by it until the atlas fits
constexpr int kMostSteps = 400;

Vec3 normal_of(const PolygonMesh& mesh, int facet, const Face& f) {
  const Vec3& given = mesh.facets[static_cast<std::size_t>(facet)].normal;
  if (std::abs(given.norm() - 1) < 1e-3) return given.normalized();
  const Vec3 turn =
      (mesh.vertices[f[1]] - mesh.vertices[f[0]]).cross(mesh.vertices[f[2]] - mesh.vertices[f[0]]);
  return turn.norm() > 0 ? Vec3(turn.normalized()) : Vec3(Vec3::UnitZ());
}

double area_of(const PolygonMesh& mesh, const Face& f) {
  const Vec3& a = mesh.vertices[f[0]];
  return (mesh.vertices[f[1]] - a).cross(mesh.vertices[f[2]] - a).norm() / 2;
}

bool is_coplanar(const PolygonMesh& mesh, int t, int u) {
  const Face &a = mesh.triangles[t], &b = mesh.triangles[u];
  const Vec3 na = normal_of(mesh, mesh.facet_of_triangle[t], a);
  const Vec3 nb = normal_of(mesh, mesh.facet_of_triangle[u], b);
  if (na.dot(nb) < 1 - kSameNormal) return false;
  return std::all_of(b.begin(), b.end(), [&](int v) {
    return std::abs(na.dot(mesh.vertices[v] - mesh.vertices[a[0]])) < kSamePlane;
  });
}

/// Triangles of one facet, or of neighbours in its plane.
UnionFind join_triangles(const PolygonMesh& mesh) {
  UnionFind sets(mesh.triangles.size());
  std::vector<int> first(mesh.facets.size(), -1);
  std::map<std::pair<int, int>, int> over_edge;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    int& own = first[static_cast<std::size_t>(mesh.facet_of_triangle[t])];
    if (own < 0) own = t;
    sets.unite(own, t);
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      const auto [it, is_new] = over_edge.emplace(std::minmax(a, b), t);
      if (!is_new && is_coplanar(mesh, it->second, t)) sets.unite(it->second, t);
    }
  }
  return sets;
}

/// The extent of points along a direction and across it.
struct Extent {
  Vec2 along, least, most;
  double area() const { return (most - least).prod(); }
};

Extent extent_along(const std::vector<Vec2>& points, const Vec2& along) {
  Extent e{along, Vec2::Constant(INFINITY), Vec2::Constant(-INFINITY)};
  for (const Vec2& p : points) {
    const Vec2 q(along.dot(p), cross(along, p));
    e.least = e.least.cwiseMin(q), e.most = e.most.cwiseMax(q);
  }
  return e;
}

void turn_to_smallest(const PolygonMesh& mesh, Chart& chart) {
  const Face& first = mesh.triangles[static_cast<std::size_t>(chart.triangles[0])];
  chart.normal = normal_of(mesh, mesh.facet_of_triangle[chart.triangles[0]], first);
  const auto [u, v] = plane_basis(chart.normal);
  const Vec3 base = mesh.vertices[first[0]];
  std::vector<Vec2> points;
  for (const int t : chart.triangles)
    for (const int i : mesh.triangles[t])
      points.emplace_back((mesh.vertices[i] - base).dot(u), (mesh.vertices[i] - base).dot(v));
  const std::vector<Vec2> hull = convex_hull(points);
  Extent best = extent_along(points, Vec2::UnitX());
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vec2 side = hull[(i + 1) % hull.size()] - hull[i];
    if (!(side.norm() > 0)) continue;
    const Extent e = extent_along(points, side.normalized());
    if (e.area() < (1 - 1e-9) * best.area()) best = e;
  }
  Vec2 size = best.most - best.least;
  if (size.y() > size.x()) best = extent_along(points, Vec2(-best.along.y(), best.along.x()));
  size = best.most - best.least;
  const Vec2 across(-best.along.y(), best.along.x());
  chart.right = best.along.x() * u + best.along.y() * v;
  chart.down = -(across.x() * u + across.y() * v);
  const Vec2 corner = best.least.x() * best.along + best.most.y() * across;
  chart.origin = base + corner.x() * u + corner.y() * v;
  chart.width = size.x(), chart.height = size.y();
}

int round_up(double texels) {
  return (static_cast<int>(std::ceil(texels)) + kBlock - 1) / kBlock * kBlock;
}

std::vector<PackedRect> rects_of(const std::vector<Chart>& charts, double texel) {
  std::vector<PackedRect> rects;
  for (const Chart& c : charts) {
    if (c.is_blank) {
      rects.push_back({kBlock + 2 * kGutter, kBlock + 2 * kGutter});
      continue;
    }
    rects.push_back({round_up(std::max(1.0, c.width / texel - 1e-6) + 2 * kGutter),
                     round_up(std::max(1.0, c.height / texel - 1e-6) + 2 * kGutter)});
  }
  return rects;
}

}  // namespace

std::vector<Chart> find_charts(const PolygonMesh& mesh) {
  UnionFind sets = join_triangles(mesh);
  std::vector<Chart> charts;
  std::vector<int> number(mesh.triangles.size(), -1);
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    int& n = number[static_cast<std::size_t>(sets.find(t))];
    if (n < 0) n = static_cast<int>(charts.size()), charts.emplace_back();
    Chart& chart = charts[static_cast<std::size_t>(n)];
    chart.triangles.push_back(t);
    chart.area += area_of(mesh, mesh.triangles[t]);
  }
  for (Chart& chart : charts) turn_to_smallest(mesh, chart);
  return charts;
}

Vec2 Atlas::place(const Chart& chart, std::size_t index, const Vec2& q) const {
  const double own = chart.is_blank ? chart.width / kBlock : texel;
  return q / own + Vec2(rects[index].x + kGutter, rects[index].y + kGutter);
}

Atlas pack_charts(const std::vector<Chart>& charts, double texel, int largest) {
  double area = 0, longest = 0;
  for (const Chart& c : charts)
    if (!c.is_blank) area += c.width * c.height, longest = std::max(longest, c.width);
  texel = std::max({texel, std::sqrt(area) / largest, longest / largest});
  largest = largest / kBlock * kBlock;
  for (int step = 0; step < kMostSteps; ++step, texel *= kStep) {
    std::vector<PackedRect> rects = rects_of(charts, texel);
    const auto [width, height] = pack_rects(rects, largest);
    if (width > 0) return {width, height, texel, std::move(rects)};
  }
  return {};  // more charts than it has blocks
}

}  // namespace colod::bake
