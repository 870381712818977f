// Based on: Architectural Co-LOD Generation (ACM TOG 43(6), 2024), Algorithm 1, to the letter where
// no
//   rule is on; the others may be on without kAlcoves, which has another order of passes.
// Differs: nothing on purpose. What the paper leaves open: a voxel needs n_r/2 valid hits (the
//   party wall rule is off); pairs are checked in the order of their first voxels; a plane belongs
//   to S_a as soon as a valid voxel of the first pass sees it; a segment of S_a is called an alcove
//   when most of its hits are on reversed planes. The two passes have boxes of their own, since the
//   second has fewer planes: P(I) counts voxels of the first grid, and the second pass encloses
//   those whose centre lies in one of its enclosed voxels.
// Notation: S_a, S_c segments of the alcove and the closed pass; A_eps the area below which planes
//   are reversed.
#include <algorithm>
#include <map>

#include "ownership.h"
#include "rules.h"

namespace colod {
namespace {

/// The planes as a pass sees them: what lies behind a reversed one is in front of it.
Planes turned(const Planes& planes, const std::vector<char>& is_reversed) {
  Planes result = planes;
  for (std::size_t p = 0; p < is_reversed.size(); ++p)
    if (is_reversed[p]) result.planes[p].normal = -result.planes[p].normal;
  return result;
}

bool is_mostly_reversed(const VoxelGroup& group, const std::vector<char>& is_reversed) {
  std::uint64_t reversed = 0;
  for (const PlaneHits& h : group.hits)
    if (is_reversed[h.plane]) reversed += h.hits;
  return 2 * reversed > group.total;
}

}  // namespace

std::vector<Coverage> overlay_coverage(const HitGrid& a, const VoxelGroups& groups_a, int first_a,
                                       const HitGrid& c, const VoxelGroups& groups_c, int first_c) {
  std::map<std::vector<int>, double> count;  // by the segments around a voxel
  for (std::size_t v = 0; v < groups_a.group_of_voxel.size(); ++v) {
    std::vector<int> by;
    if (const int g = groups_a.group_of_voxel[v]; g >= 0) by.push_back(first_a + g);
    if (c.ns > 0)
      if (const std::int64_t w = voxel_around(c, a.center(v)); w >= 0)
        if (const int g = groups_c.group_of_voxel[w]; g >= 0) by.push_back(first_c + g);
    if (!by.empty()) ++count[by];
  }
  std::vector<Coverage> coverage;
  for (const auto& [segments, voxels] : count) coverage.push_back({segments, voxels});
  return coverage;
}

Segments paper_segments(const Planes& planes, const SegmentOptions& options) {
  const std::size_t n = planes.planes.size();
  std::vector<char> is_reversed(n), is_active(n);
  for (std::size_t p = 0; p < n; ++p) is_reversed[p] = planes.planes[p].area < options.alcove_area;

  const HitGrid grid_a = cast_visibility(planes, options.visibility, {}, is_reversed);
  const OwnedGroups a = drop_planeless(grid_a, own_groups(turned(planes, is_reversed), grid_a,
                                                          std::vector<char>(n, 1), options.rules));
  for (std::size_t p = 0; p < n; ++p) is_active[p] = a.group_of_plane[p] < 0;

  HitGrid grid_c;
  OwnedGroups c;
  if (std::find(is_active.begin(), is_active.end(), 1) != is_active.end()) {
    grid_c = cast_visibility(planes, options.visibility, is_active);
    c = drop_planeless(grid_c, own_groups(planes, grid_c, is_active, options.rules));
  }
  SegmentDraft draft;
  const int first_a = append_segments(grid_a, a, draft);
  for (std::size_t g = 0; g < a.groups.groups.size(); ++g)
    draft.segments[first_a + g].is_alcove = is_mostly_reversed(a.groups.groups[g], is_reversed);
  const int first_c = append_segments(grid_c, c, draft);
  draft.coverage = overlay_coverage(grid_a, a.groups, first_a, grid_c, c.groups, first_c);
  if (options.rules.has(Rule::kElementSegments)) {
    give_to_elements(planes, grid_a, options, draft);
    cover_plain(draft);
  }
  Segments out = finish_segments(planes, std::move(draft));
  out.rays = grid_a.rays + grid_c.rays;
  out.visibility_seconds = grid_a.seconds + grid_c.seconds;
  return out;
}

}  // namespace colod
