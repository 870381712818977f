// Based on: Architectural Co-LOD Generation (ACM TOG 43(6), 2024), section 3.1 and Algorithm 1.
// Differs: the default rules, each measured in November 2026 on 15 simulated scans of one street.
//   The closed pass comes first, with all planes: reversing every plane under A_eps before it
//   takes the main body away wherever walls are small. Groups merge by histogram intersection,
//   planes go to what lies right behind them (aggregation.cpp, assignment.cpp).
//   Segments under 20 voxels join the neighbour that sees most alike. Horizontal rays part a
//   dormer's or a chimney's box from its roof: details that share a fifth of a surface are one.
//   An alcove voxel is one outside the building of whose rays at least n_r/2 meet small planes
//   from outside: the closed pass's own hits tell, so nothing is cast twice. An alcove takes
//   planes mostly in front of its voxels and keeps them only as a real recess; otherwise they
//   stay with what is behind them. Details give none away: two chimneys side by side are no
//   recess. No voxel has two segments here. Alcove voxels, though outside the building, count in
//   P(I): they are enclosed by the alcove's segment.
// Notation: A_eps, n_r as in the paper.
#include <algorithm>

#include "assignment.h"
#include "ownership.h"
#include "parameters.h"
#include "rules.h"

namespace colod {
namespace {

using namespace parameters::segments;

std::vector<char> small_planes(const Planes& planes, double alcove_area) {
  double largest = 0;
  for (const Plane& p : planes.planes) largest = std::max(largest, p.area);
  std::vector<char> is_small;
  for (const Plane& p : planes.planes)
    is_small.push_back(p.area < std::min(alcove_area, kSmallRatio * largest));
  return is_small;
}

/// Voxels outside the building in front of small planes, and what they see of those.
HitFilter alcove_filter(const HitGrid& grid, std::vector<char> is_small) {
  HitFilter filter;
  filter.is_outside = true;
  filter.is_counted = std::move(is_small);
  filter.voxels.assign(grid.is_valid.size(), 0);
  for (std::size_t v = 0; v < filter.voxels.size(); ++v) {
    if (grid.is_valid[v]) continue;
    std::uint32_t outside = 0;
    for (const Hit& hit : grid.at(v)) outside += filter.count(hit);
    filter.voxels[v] = 2 * outside >= static_cast<std::uint32_t>(grid.nr);
  }
  return filter;
}

/// Planes that an alcove may take: small ones, and of segments that have larger ones too. What has
/// small planes only is a detail, and two chimneys side by side are no recess.
std::vector<char> planes_for_alcoves(const std::vector<char>& is_small, const OwnedGroups& closed) {
  std::vector<char> has_large(closed.groups.groups.size(), 0), out = is_small;
  for (std::size_t p = 0; p < is_small.size(); ++p)
    if (const int g = closed.group_of_plane[p]; g >= 0 && !is_small[p]) has_large[g] = 1;
  for (std::size_t p = 0; p < is_small.size(); ++p)
    if (const int g = closed.group_of_plane[p]; g >= 0 && !has_large[g]) out[p] = 0;
  return out;
}

OwnedGroups alcove_groups(const Planes& planes, const HitGrid& grid, const OwnedGroups& closed,
                          const SegmentOptions& options) {
  const HitFilter filter = alcove_filter(grid, small_planes(planes, options.alcove_area));
  OwnedGroups alcoves;
  alcoves.groups = aggregate(grid, filter, options.rules);
  const std::vector<PlaneSide> front =
      look_beside_planes(planes, grid, alcoves.groups.group_of_voxel, Side::kFront);
  const std::vector<char> may_take = planes_for_alcoves(filter.is_counted, closed);
  alcoves.group_of_plane.assign(front.size(), -1);
  for (std::size_t p = 0; p < front.size(); ++p)
    if (may_take[p] && front[p].share >= kFrontShare) alcoves.group_of_plane[p] = front[p].group;
  if (options.rules.has(Rule::kAlcoveGuard))
    alcoves.group_of_plane = guard_alcoves(planes, std::move(alcoves.group_of_plane),
                                           static_cast<int>(alcoves.groups.groups.size()));
  return alcoves;
}

/// Alcoves that own planes, without those that do not: outside the building nobody inherits.
void append_alcoves(const HitGrid& grid, const OwnedGroups& alcoves, SegmentDraft& draft) {
  const int first = append_segments(grid, alcoves, draft);
  for (std::size_t s = first; s < draft.segments.size(); ++s) draft.segments[s].is_alcove = true;
  std::erase_if(draft.segments, [](const Segment& s) { return s.planes.empty(); });
}

}  // namespace

Segments robust_segments(const Planes& planes, const HitGrid& grid, const SegmentOptions& options) {
  const std::vector<char> is_active(planes.planes.size(), 1);
  OwnedGroups closed = own_groups(planes, grid, is_active, options.rules);
  const OwnedGroups alcoves = alcove_groups(planes, grid, closed, options);
  for (std::size_t p = 0; p < planes.planes.size(); ++p)
    if (alcoves.group_of_plane[p] >= 0) closed.group_of_plane[p] = -1;
  closed = drop_planeless(grid, std::move(closed));

  SegmentDraft draft;
  append_segments(grid, closed, draft);
  append_alcoves(grid, alcoves, draft);
  give_to_elements(planes, grid, options, draft);
  const bool has_fidelity = options.rules.has(Rule::kFidelity);
  if (!has_fidelity) cover_plain(draft);
  Segments result = finish_segments(planes, std::move(draft));
  if (!has_fidelity) return result;
  if (std::vector<Coverage> coverage = fidelity_coverage(grid, result); !coverage.empty())
    result.coverage = std::move(coverage);
  return result;
}

}  // namespace colod
