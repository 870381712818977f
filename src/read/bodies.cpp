// Based on: nothing published.
// Differs: --rules does not matter here.
// Notation: a body's cells are the cells of a raster over the plan within kNear / 2 of it, so that
// two bodies nearer than kNear share the cell of the point midway.
#include "bodies.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include "core/flat.h"

namespace colod::mesh_io {

namespace {

constexpr double kReach = kNear / 2;
constexpr std::size_t kLargest = 8;     // bodies of a cell that all others of it meet
constexpr int kWallBins = 36;           // of 10° each, of the walls' directions
constexpr double kWallShare = 0.15;     // of the area: a box ten times as wide as high has 0.17
constexpr double kStraightShare = 0.5;  // of the walls in two of nine bins; a tree has 0.22
constexpr double kSideShare = 0.05;     // of the walls on each of four sides

/// The raster cells of one body's box.
struct Raster {
  std::int64_t x, y;  // lowest cell
  int columns, rows;
  std::vector<char> is_covered;

  explicit Raster(const Box& box)
      : x(cell(box.min.x() - kReach)),
        y(cell(box.min.y() - kReach)),
        columns(static_cast<int>(cell(box.max.x() + kReach) - x) + 1),
        rows(static_cast<int>(cell(box.max.y() + kReach) - y) + 1),
        is_covered(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows)) {}

  static std::int64_t cell(double v) { return static_cast<std::int64_t>(std::floor(v / kCell)); }
};

/// From where to where in x the triangle reaches between two heights y; false: nowhere.
bool span_of(const std::array<Vec3, 3>& t, double low, double high, double& from, double& to) {
  from = INFINITY, to = -INFINITY;
  const auto take = [&](double x) { from = std::min(from, x), to = std::max(to, x); };
  for (int i = 0; i < 3; ++i) {
    const Vec3 &a = t[i], &b = t[(i + 1) % 3];
    if (a.y() >= low && a.y() <= high) take(a.x());
    for (const double y : {low, high})
      if ((a.y() < y) != (b.y() < y)) take(a.x() + (b.x() - a.x()) * (y - a.y()) / (b.y() - a.y()));
  }
  return from <= to;
}

void cover(Raster& raster, const std::array<Vec3, 3>& t) {
  const auto [low, high] = std::minmax({t[0].y(), t[1].y(), t[2].y()});
  const auto [left, right] = std::minmax({t[0].x(), t[1].x(), t[2].x()});
  const std::int64_t first = Raster::cell(low - kReach), last = Raster::cell(high + kReach);
  for (std::int64_t row = first; row <= last; ++row) {
    const double y = static_cast<double>(row) * kCell;
    double from, to;
    if (!span_of(t, y - kReach, y + kCell + kReach, from, to)) continue;
    from = std::max(from, left), to = std::min(to, right);  // whatever the division rounded
    const auto begin = static_cast<std::size_t>(Raster::cell(from - kReach) - raster.x);
    const auto end = static_cast<std::size_t>(Raster::cell(to + kReach) - raster.x);
    const std::size_t line =
        static_cast<std::size_t>(row - raster.y) * static_cast<std::size_t>(raster.columns);
    std::fill(raster.is_covered.begin() + static_cast<std::ptrdiff_t>(line + begin),
              raster.is_covered.begin() + static_cast<std::ptrdiff_t>(line + end + 1), 1);
  }
}

/// One number a cell, the same for all bodies.
std::vector<std::uint64_t> covered_cells(const Raster& raster) {
  std::vector<std::uint64_t> cells;
  for (int r = 0; r < raster.rows; ++r)
    for (int c = 0; c < raster.columns; ++c)
      if (raster.is_covered[static_cast<std::size_t>(r) * static_cast<std::size_t>(raster.columns) +
                            static_cast<std::size_t>(c)])
        cells.push_back((static_cast<std::uint64_t>(raster.y + r) << 32) ^
                        (static_cast<std::uint64_t>(raster.x + c) & 0xffffffff));
  std::sort(cells.begin(), cells.end());
  return cells;
}

bool is_closed(const std::vector<int>& welded, const std::vector<Face>& faces,
               const std::vector<int>& chosen) {
  std::vector<std::pair<int, int>> edges;
  for (const int t : chosen)
    for (int c = 0; c < 3; ++c) {
      const int a = welded[faces[t][c]], b = welded[faces[t][(c + 1) % 3]];
      if (a != b) edges.emplace_back(std::min(a, b), std::max(a, b));
    }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i;
    while (end < edges.size() && edges[end] == edges[i]) ++end;
    if ((end - i) % 2 != 0) return false;
    i = end;
  }
  return !edges.empty();
}

/// Walls mostly along two directions at right angles, some on each of the four sides.
bool has_four_walls(const std::array<double, kWallBins>& walls, double area) {
  double all = 0, best = -1;
  for (const double w : walls) all += w;
  if (all < kWallShare * area) return false;
  int at = 0;
  const auto bin = [&](int i) {
    return walls[static_cast<std::size_t>((i + kWallBins) % kWallBins)];
  };
  for (int i = 0; i < kWallBins / 4; ++i) {
    double both = 0;
    for (int side = 0; side < 4; ++side) both += bin(9 * side + i) + bin(9 * side + i + 1);
    if (both > best) best = both, at = i;
  }
  if (best < kStraightShare * all) return false;
  for (int side = 0; side < 4; ++side)
    if (bin(9 * side + at) + bin(9 * side + at + 1) < kSideShare * all) return false;
  return true;
}

/// The corners of the convex hull in plan, counter-clockwise.
std::vector<Vec2> plan_hull(const std::vector<Vec3>& points, const std::vector<Face>& faces,
                            const std::vector<int>& chosen) {
  std::vector<Vec2> all;
  for (const int t : chosen)
    for (const int v : faces[t]) all.push_back(points[v].head<2>());
  return convex_hull(std::move(all));
}

/// Metres between the nearest two upright planes that hold the body: rotating calipers (Shamos,
/// 1978), so that round bodies of many corners take no longer. The corner farthest from an edge
/// never lies before the one of the edge before.
double least_width(const std::vector<Vec2>& hull) {
  const std::size_t n = hull.size();
  double least = INFINITY;
  for (std::size_t i = 0, far = 1; i < n; ++i) {
    const Vec2 along = (hull[(i + 1) % n] - hull[i]).normalized();
    const auto width = [&](std::size_t corner) {
      const Vec2 to = hull[corner % n] - hull[i];
      return std::abs(along.x() * to.y() - along.y() * to.x());
    };
    far = std::max(far, i + 1);
    while (far < i + n && width(far + 1) >= width(far)) ++far;
    least = std::min(least, std::max(width(far), width(far + n - 1)));
  }
  return std::isfinite(least) ? least : 0;
}

}  // namespace

Body describe_body(const std::vector<Vec3>& points, const std::vector<int>& welded,
                   const std::vector<Face>& faces, const std::vector<int>& chosen) {
  Body body;
  std::array<double, kWallBins> walls{};
  for (const int t : chosen) {
    const Face& f = faces[t];
    for (const int v : f) body.box.extend(points[v]);
    const Vec3 n = 0.5 * (points[f[1]] - points[f[0]]).cross(points[f[2]] - points[f[0]]);
    const double area = n.norm();
    body.area += area;
    if (!(std::abs(n.z()) < 0.5 * area)) continue;
    const double turn = std::atan2(n.y(), n.x()) / (2 * std::numbers::pi) + 1;
    walls[static_cast<std::size_t>(turn * kWallBins) % kWallBins] += area;
  }
  const Vec3 size = body.box.size();
  body.is_wide = std::max(size.x(), size.y()) > kWide;
  if (body.box.is_empty() || body.is_wide) return body;
  Raster raster(body.box);
  for (const int t : chosen) {
    const Face& f = faces[t];
    cover(raster, {points[f[0]], points[f[1]], points[f[2]]});
  }
  body.cells = covered_cells(raster);
  body.has_building_shape = size.z() >= kLeast &&
                            least_width(plan_hull(points, faces, chosen)) >= kLeast &&
                            (has_four_walls(walls, body.area) || is_closed(welded, faces, chosen));
  return body;
}

std::vector<Contact> find_contacts(const std::vector<Body>& bodies) {
  std::vector<std::pair<std::uint64_t, int>> all;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    for (const std::uint64_t cell : bodies[b].cells) all.emplace_back(cell, static_cast<int>(b));
  std::sort(all.begin(), all.end());
  std::unordered_map<std::uint64_t, int> cells_of_pair;  // many cells, few pairs
  std::vector<int> here;
  for (std::size_t i = 0; i < all.size();) {
    here.clear();
    const std::uint64_t cell = all[i].first;
    for (; i < all.size() && all[i].first == cell; ++i) here.push_back(all[i].second);
    std::stable_sort(here.begin(), here.end(),
                     [&](int a, int b) { return bodies[a].cells.size() > bodies[b].cells.size(); });
    for (std::size_t j = 0; j < std::min(here.size(), kLargest); ++j)
      for (std::size_t k = j + 1; k < here.size(); ++k)
        ++cells_of_pair[static_cast<std::uint64_t>(std::min(here[j], here[k])) << 32 |
                        static_cast<std::uint64_t>(std::max(here[j], here[k]))];
  }
  std::vector<Contact> contacts;
  for (const auto& [pair, cells] : cells_of_pair)
    contacts.push_back({static_cast<int>(pair >> 32), static_cast<int>(pair & 0xffffffff), cells});
  std::sort(contacts.begin(), contacts.end(), [](const Contact& x, const Contact& y) {
    return std::pair(x.a, x.b) < std::pair(y.a, y.b);
  });
  return contacts;
}

}  // namespace colod::mesh_io
