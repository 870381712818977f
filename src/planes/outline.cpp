// Based on: the paper's α-shape per plane (section 3.1). Differs: under robust rules a mesh's items
// are its faces, and the outline is the exact union of them, projected; the α-shape serves points.
// Robust besides: holes under 0.25 m² are filled and rings that end within a few growing distances
// of a neighbouring plane are drawn onto the common line, because horizontal rays leak through
// gaps. Notation: u, v axes in the plane; L the line where two planes meet.
#include "outline.h"

#include <algorithm>
#include <cmath>

#include "arrangement.h"
#include "core/flat.h"
#include "core/parallel.h"
#include "growing.h"
#include "parameters.h"

namespace colod::regions {
namespace {

using namespace parameters::planes;

constexpr double kAlphaSpacings = 2.5;  // circumradius in point spacings

/// Coordinates in a region's plane.
struct Chart {
  Vec3 origin, u, v;

  explicit Chart(const Region& r) : origin(r.offset * r.normal) {
    const auto basis = plane_basis(r.normal);
    u = basis[0], v = basis[1];
  }
  Vec2 flat(const Vec3& p) const { return {u.dot(p - origin), v.dot(p - origin)}; }
  Vec3 space(const Vec2& q) const { return origin + q.x() * u + q.y() * v; }
};

std::vector<Edge2> face_edges(const Items& items, const Region& region, const Chart& chart) {
  std::vector<Edge2> edges;
  for (const int i : region.items) {
    std::array<Vec3, 3> corner;
    items.corners(i, corner);
    std::array<Vec2, 3> q{chart.flat(corner[0]), chart.flat(corner[1]), chart.flat(corner[2])};
    if (signed_area({q[0], q[1], q[2]}) < 0) std::swap(q[1], q[2]);
    for (int k = 0; k < 3; ++k) edges.push_back({q[k], q[(k + 1) % 3]});
  }
  return edges;
}

std::vector<Edge2> region_edges(const Items& items, const Region& region, const Chart& chart) {
  if (items.is_mesh()) return face_edges(items, region, chart);
  std::vector<Vec2> points;
  for (const int i : region.items) points.push_back(chart.flat(items.center[i]));
  return alpha_shape(points, kAlphaSpacings * items.spacing);
}

std::vector<Edge2> ring_edges(const std::vector<std::vector<Vec2>>& rings) {
  std::vector<Edge2> edges;
  for (const auto& ring : rings)
    for (std::size_t i = 0; i < ring.size(); ++i)
      edges.push_back({ring[i], ring[(i + 1) % ring.size()]});
  return edges;
}

/// Rings without small holes and specks, with few vertices.
std::vector<std::vector<Vec2>> clean_rings(const Arrangement& a, double tolerance, bool is_filled) {
  std::vector<std::vector<Vec2>> rings;
  std::size_t largest = 0;
  double largest_area = 0;
  const double speck = is_filled ? std::min(kSpeck, kSpeck * a.area()) : 0;
  for (const auto& ids : a.rings) {
    std::vector<Vec2> ring;
    for (const int i : ids) ring.push_back(a.vertices[i]);
    const double area = signed_area(ring);
    if (area < 0 && is_filled && -area < kSmallHole) continue;
    std::vector<Vec2> simple = simplify_ring(ring, tolerance);
    // A sliver keeps its corners: simplified away it would leave its plane without an outline.
    if (simple.empty() || std::abs(signed_area(simple)) < 0.5 * std::abs(area)) simple = ring;
    if (area > largest_area) largest_area = area, largest = rings.size();
    rings.push_back(std::move(simple));
  }
  std::vector<std::vector<Vec2>> kept;
  for (std::size_t r = 0; r < rings.size(); ++r)
    if (r == largest || std::abs(signed_area(rings[r])) >= speck)
      kept.push_back(std::move(rings[r]));
  return kept;
}

/// A region's flat outline while outlines are drawn together.
struct Sheet {
  Chart chart;
  Arrangement flat;
};

double distance_to_segment(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 along = b - a;
  const double t = std::clamp((p - a).dot(along) / std::max(along.squaredNorm(), 1e-300), 0.0, 1.0);
  return (p - a - t * along).norm();
}

/// From a point of the sheet's plane to what the sheet covers; 0 on it. Gives up beyond `limit`.
bool is_near(const Sheet& sheet, const Vec3& point, double limit) {
  const Vec2 p = sheet.chart.flat(point);
  const auto& v = sheet.flat.vertices;
  for (const Face& t : sheet.flat.triangles) {
    const Vec2 &a = v[t[0]], &b = v[t[1]], &c = v[t[2]];
    if (cross(b - a, p - a) >= 0 && cross(c - b, p - b) >= 0 && cross(a - c, p - c) >= 0)
      return true;
  }
  for (const auto& ring : sheet.flat.rings)
    for (std::size_t i = 0; i < ring.size(); ++i)
      if (distance_to_segment(p, v[ring[i]], v[ring[(i + 1) % ring.size()]]) <= limit) return true;
  return false;
}

/// Where a vertex of region a goes: onto the line with its nearest neighbouring plane, or to the
/// corner of two, when they are within `limit`; otherwise it stays.
Vec3 drawn_vertex(const Vec3& p, int a, const std::vector<Region>& regions,
                  const std::vector<Sheet>& sheets, const std::vector<int>& neighbors,
                  double limit) {
  struct Line {
    double distance;
    int plane;
    Vec3 point;
  };
  std::vector<Line> lines;
  for (const int b : neighbors) {
    const Vec3& n = regions[b].normal;
    const Vec3 in_plane = n - n.dot(regions[a].normal) * regions[a].normal;
    const double sine = in_plane.norm();
    if (sine < kLeastSine) continue;
    const double d = (n.dot(p) - regions[b].offset) / sine;
    if (std::abs(d) > limit) continue;
    const Vec3 q = p - d / sine * in_plane;
    if (is_near(sheets[b], q, limit)) lines.push_back({std::abs(d), b, q});
  }
  if (lines.empty()) return p;
  std::sort(lines.begin(), lines.end(), [](const Line& x, const Line& y) {
    return std::tie(x.distance, x.plane) < std::tie(y.distance, y.plane);
  });
  const Region &ra = regions[a], &rb = regions[lines[0].plane];
  for (std::size_t k = 1; k < lines.size(); ++k) {
    const Region& rc = regions[lines[k].plane];
    Eigen::Matrix3d m;
    m.row(0) = ra.normal, m.row(1) = rb.normal, m.row(2) = rc.normal;
    if (std::abs(m.determinant()) < kLeastSine) continue;
    const Vec3 corner = m.inverse() * Vec3(ra.offset, rb.offset, rc.offset);
    if ((corner - p).norm() <= kCornerReach * limit) return corner;
  }
  return lines[0].point;
}

std::vector<std::vector<int>> neighbor_lists(const Items& items, const std::vector<Region>& regions,
                                             double gap) {
  std::vector<std::vector<int>> lists(regions.size());
  for (const auto& [a, b] : neighboring_regions(items, regions, gap))
    lists[a].push_back(b), lists[b].push_back(a);
  return lists;
}

Arrangement draw_to_neighbors(int a, const std::vector<Region>& regions,
                              const std::vector<Sheet>& sheets, const std::vector<int>& neighbors,
                              double limit) {
  const Sheet& sheet = sheets[a];
  std::vector<std::vector<Vec2>> rings;
  for (const auto& ids : sheet.flat.rings) {
    std::vector<Vec2> ring;
    for (const int i : ids)
      ring.push_back(sheet.chart.flat(drawn_vertex(sheet.chart.space(sheet.flat.vertices[i]), a,
                                                   regions, sheets, neighbors, limit)));
    std::vector<Vec2> simple = simplify_ring(ring, 1e-6);
    if (!simple.empty()) rings.push_back(std::move(simple));
  }
  Arrangement drawn = arrange(ring_edges(rings));
  const double before = sheet.flat.area(), after = drawn.area();
  const double slack = 0.1 * before + limit * limit + 0.25 * before;
  return std::abs(after - before) <= slack ? drawn : sheet.flat;
}

Outline to_outline(const Chart& chart, const Arrangement& flat) {
  Outline outline;
  for (const Vec2& q : flat.vertices) outline.vertices.push_back(chart.space(q));
  outline.rings = flat.rings;
  outline.triangles = flat.triangles;
  return outline;
}

}  // namespace

double outline_area(const Outline& outline) {
  double sum = 0;
  for (const Face& t : outline.triangles)
    sum += 0.5 * (outline.vertices[t[1]] - outline.vertices[t[0]])
                     .cross(outline.vertices[t[2]] - outline.vertices[t[0]])
                     .norm();
  return sum;
}

std::vector<Outline> make_outlines(const Items& items, const std::vector<Region>& regions,
                                   double distance, const RuleSet& rules) {
  std::vector<Sheet> sheets;
  for (const Region& r : regions) sheets.push_back({Chart(r), {}});
  parallel_for(regions.size(), [&](std::size_t r) {
    const Arrangement raw = arrange(region_edges(items, regions[r], sheets[r].chart));
    sheets[r].flat = arrange(ring_edges(clean_rings(raw, distance / 2, rules.has(Rule::kHoles))));
    if (sheets[r].flat.triangles.empty()) sheets[r].flat = raw;
  });
  std::vector<Outline> outlines(regions.size());
  const bool is_drawn = rules.has(Rule::kBorders);
  const double limit = is_drawn ? std::min(kMostBorderReach, std::max(kBorderReach * distance,
                                                                      kBorderReach * items.spacing))
                                : 0;
  const auto neighbors = is_drawn ? neighbor_lists(items, regions, limit)
                                  : std::vector<std::vector<int>>(regions.size());
  parallel_for(regions.size(), [&](std::size_t r) {
    outlines[r] = to_outline(
        sheets[r].chart,
        is_drawn ? draw_to_neighbors(static_cast<int>(r), regions, sheets, neighbors[r], limit)
                 : sheets[r].flat);
  });
  return outlines;
}

}  // namespace colod::regions
