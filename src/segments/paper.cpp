// Based on: Architectural Co-LOD Generation (ACM TOG 43(6), 2024), Algorithm 1, to the letter.
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

#include "assignment.h"
#include "rules.h"

namespace colod {
namespace {

OwnedGroups aggregate(const HitGrid& grid, std::size_t planes) {
  OwnedGroups owned;
  owned.groups = merge_groups(grid, group_voxels(grid), MergeRule::kMembership);
  owned.group_of_plane = assign_to_most_hits(planes, owned.groups);
  return drop_planeless(grid, std::move(owned));
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
  VisibilityOptions visibility = options.visibility;
  visibility.is_party_wall_rule = false;
  std::vector<char> is_reversed(n), is_active(n);
  for (std::size_t p = 0; p < n; ++p) is_reversed[p] = planes.planes[p].area < options.alcove_area;

  const HitGrid grid_a = cast_visibility(planes, visibility, {}, is_reversed);
  const OwnedGroups a = aggregate(grid_a, n);
  for (std::size_t p = 0; p < n; ++p) is_active[p] = a.group_of_plane[p] < 0;

  HitGrid grid_c;
  OwnedGroups c;
  if (std::find(is_active.begin(), is_active.end(), 1) != is_active.end()) {
    grid_c = cast_visibility(planes, visibility, is_active);
    c = aggregate(grid_c, n);
  }
  SegmentDraft draft;
  const int first_a = append_segments(grid_a, a, draft);
  for (std::size_t g = 0; g < a.groups.groups.size(); ++g)
    draft.segments[first_a + g].is_alcove = is_mostly_reversed(a.groups.groups[g], is_reversed);
  const int first_c = append_segments(grid_c, c, draft);
  draft.coverage = overlay_coverage(grid_a, a.groups, first_a, grid_c, c.groups, first_c);
  Segments out = finish_segments(planes, std::move(draft));
  out.rays = grid_a.rays + grid_c.rays;
  out.visibility_seconds = grid_a.seconds + grid_c.seconds;
  return out;
}

}  // namespace colod
