// Based on: own work.
#include "corners.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "components.h"
#include "core/flat.h"
#include "parameters.h"

namespace colod {
namespace {

using namespace parameters::extraction::corners;

/// Per cell: whether only mending has put it inside; and what was inside before.
struct Mended {
  std::vector<char> is_inside, is_added;
};

Mended mended_cells(const Draft& draft, const RuleSet& rules) {
  Mended m;
  m.is_inside = draft.labels.is_inside;
  if (rules.has(Rule::kCavities)) fill_cavities(draft.partition, m.is_inside);
  m.is_added = m.is_inside;
  mend_pinches(draft.partition, m.is_added);
  for (std::size_t c = 0; c < m.is_added.size(); ++c) m.is_added[c] &= !m.is_inside[c];
  return m;
}

/// Added cells by neighbours that were inside.
std::multimap<int, int> added_beside(const Partition& partition, const Mended& mended) {
  std::multimap<int, int> out;
  for (const Partition::Piece& piece : partition.pieces)
    for (const int k : {0, 1}) {
      const int added = piece.cells[k], beside = piece.cells[1 - k];
      if (added >= 0 && beside >= 0 && mended.is_added[added] && mended.is_inside[beside])
        out.emplace(beside, added);
    }
  return out;
}

/// Corners of a cell.
std::map<int, std::vector<Vec3>> corners_of(const Partition& partition, const Mended& mended) {
  std::map<int, std::vector<Vec3>> out;
  for (const Partition::Piece& piece : partition.pieces)
    for (const int cell : piece.cells)
      if (cell >= 0 && mended.is_added[cell])
        for (const int v : piece.polygon) out[cell].push_back(partition.points[v]);
  return out;
}

/// Whether a plane that is no wall parts a cell.
bool is_parted(const Partition::IntPlane& plane, const Partition& partition,
               const std::vector<Vec3>& corners) {
  const Vec3 normal(plane.normal[0], plane.normal[1], plane.normal[2]);
  if (std::abs(normal.z()) < kLeastLevel * normal.norm()) return false;
  const double offset = -static_cast<double>(plane.d) * partition.grid / normal.norm();
  double low = INFINITY, high = -INFINITY;
  for (const Vec3& p : corners) {
    const double d = normal.normalized().dot(p - partition.origin) - offset;
    low = std::min(low, d), high = std::max(high, d);
  }
  return low < -kStandsOut && high > kStandsOut;
}

/// Metres from a place to a hull's border.
double distance_to(const std::vector<Vec3>& hull, const Vec3& p) {
  double least = INFINITY;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vec3 along = hull[(i + 1) % hull.size()] - hull[i];
    const double t = std::clamp(along.dot(p - hull[i]) / along.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (hull[i] + t * along - p).norm());
  }
  return least;
}

/// Of the planes that became one in the partition, that of which an outline is nearest; −1: each
/// of them cuts everything.
int nearest_cut(const CuttingPlan& plan, const Partition& partition, int plane, const Vec3& p) {
  int best = -1;
  double least = INFINITY;
  for (std::size_t i = 0; i < plan.planes.size(); ++i) {
    if (partition.cuts[i].plane != plane || plan.planes[i].hull.empty()) continue;
    const double d = distance_to(plan.planes[i].hull, p);
    if (d < least) least = d, best = static_cast<int>(i);
  }
  return best;
}

/// A hull that holds these places, too, as they lie on its plane.
void widen(CutPlane& plane, const std::vector<Vec3>& places) {
  const auto [u, v] = plane_basis(plane.normal);
  std::vector<Vec2> flat;
  for (const auto* points : {&std::as_const(plane.hull), &places})
    for (const Vec3& p : *points) flat.emplace_back(u.dot(p), v.dot(p));
  plane.hull.clear();
  for (const Vec2& q : convex_hull(std::move(flat)))
    plane.hull.push_back(q.x() * u + q.y() * v + plane.offset * plane.normal);
}

}  // namespace

std::optional<CuttingPlan> plan_corners(const CuttingPlan& plan, const Draft& draft,
                                        const RuleSet& rules) {
  if (draft.shell.mended <= 0 || !rules.has(Rule::kReach)) return {};
  const Partition& partition = draft.partition;
  const Mended mended = mended_cells(draft, rules);
  const std::multimap<int, int> beside = added_beside(partition, mended);
  const std::map<int, std::vector<Vec3>> corners = corners_of(partition, mended);
  std::set<std::pair<int, int>> wanted;  // a plane of the partition and a cell that it parts
  for (const Partition::Piece& piece : partition.pieces)
    for (const int k : {0, 1}) {
      const int inside = piece.cells[k], outside = piece.cells[1 - k];
      if (inside < 0 || !mended.is_inside[inside]) continue;
      if (outside >= 0 && (mended.is_inside[outside] || mended.is_added[outside])) continue;
      for (auto [at, end] = beside.equal_range(inside); at != end; ++at)
        if (is_parted(partition.planes[piece.plane], partition, corners.at(at->second)))
          wanted.emplace(piece.plane, at->second);
    }
  CuttingPlan out = plan;
  bool is_any = false;
  for (const auto& [plane, cell] : wanted) {
    const int cut = nearest_cut(plan, partition, plane, partition.cells[cell].centroid);
    if (cut < 0) continue;
    widen(out.planes[static_cast<std::size_t>(cut)], corners.at(cell));
    is_any = true;
  }
  return is_any ? std::optional(std::move(out)) : std::nullopt;
}

}  // namespace colod
