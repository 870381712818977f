// Based on: Architectural Co-LOD Generation (ACM TOG 43(6), 2024), section 3.1 and Algorithm 1.
// Differs: see paper.cpp (to the letter) and robust.cpp (default); this file
//   holds what both share. A group that owns no plane after the assignment is no segment: its
//   voxels go to the neighbour that sees most alike, so that the coverage still sums to 1.
// Notation: n_p planes.
#include "segments.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <limits>
#include <numeric>

#include "assignment.h"
#include "parameters.h"
#include "rules.h"

namespace colod {
namespace {

using namespace parameters::segments;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void put_in_order(SegmentDraft& draft) {
  std::vector<int> order(draft.segments.size()), rank(draft.segments.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    const Segment &s = draft.segments[a], &t = draft.segments[b];
    if (s.volume != t.volume) return s.volume > t.volume;
    return s.planes.front() < t.planes.front();
  });
  std::vector<Segment> sorted;
  for (std::size_t i = 0; i < order.size(); ++i) {
    rank[order[i]] = static_cast<int>(i);
    sorted.push_back(std::move(draft.segments[order[i]]));
  }
  draft.segments = std::move(sorted);
  for (Coverage& c : draft.coverage) {
    for (int& s : c.segments) s = rank[s];
    std::sort(c.segments.begin(), c.segments.end());
  }
  std::sort(draft.coverage.begin(), draft.coverage.end(),
            [](const Coverage& a, const Coverage& b) { return a.segments < b.segments; });
}

}  // namespace

VoxelGroups aggregate(const HitGrid& grid, const HitFilter& filter, const RuleSet& rules) {
  const MergeRule rule =
      rules.has(Rule::kHistograms) ? MergeRule::kHistogram : MergeRule::kMembership;
  VoxelGroups groups = merge_groups(grid, group_voxels(grid, filter), rule, kMergeOverlap);
  if (!rules.has(Rule::kSpecks)) return groups;
  std::vector<char> is_kept;
  for (const VoxelGroup& g : groups.groups) is_kept.push_back(g.voxels >= kLeastVoxels);
  return join_groups(grid, std::move(groups), is_kept, false);
}

OwnedGroups own_groups(const Planes& planes, const HitGrid& grid,
                       const std::vector<char>& is_active, const RuleSet& rules) {
  OwnedGroups own;
  own.groups = aggregate(grid, {}, rules);
  std::int64_t voxels = 0;  // enclosed ones
  for (const VoxelGroup& g : own.groups.groups) voxels += g.voxels;
  if (rules.has(Rule::kDetails))
    own.groups = join_details(grid, std::move(own.groups),
                              static_cast<std::int64_t>(kDetailShare * static_cast<double>(voxels)),
                              kDetailContact);
  own.group_of_plane = assign_to_most_hits(planes.planes.size(), own.groups);
  if (!rules.has(Rule::kBehind)) return own;
  const std::vector<PlaneSide> behind =
      look_beside_planes(planes, grid, own.groups.group_of_voxel, Side::kBehind);
  for (std::size_t p = 0; p < behind.size(); ++p)
    if (is_active[p] && behind[p].group >= 0) own.group_of_plane[p] = behind[p].group;
  return own;
}

void cover_plain(SegmentDraft& draft) {
  draft.coverage.clear();
  for (std::size_t s = 0; s < draft.segments.size(); ++s)
    if (draft.segments[s].kind == ElementKind::kPlain)
      draft.coverage.push_back(
          {{static_cast<int>(s)}, static_cast<double>(draft.segments[s].voxels)});
}

OwnedGroups drop_planeless(const HitGrid& grid, OwnedGroups owned) {
  std::vector<char> is_kept(owned.groups.groups.size(), 0);
  for (int g : owned.group_of_plane)
    if (g >= 0) is_kept[g] = 1;
  if (std::find(is_kept.begin(), is_kept.end(), 1) == is_kept.end()) {
    owned.groups.groups.clear();
    std::fill(owned.groups.group_of_voxel.begin(), owned.groups.group_of_voxel.end(), -1);
    return owned;
  }
  std::vector<int> target;
  owned.groups = join_groups(grid, std::move(owned.groups), is_kept, true, &target);
  for (int& g : owned.group_of_plane)
    if (g >= 0) g = target[g];
  return owned;
}

int append_segments(const HitGrid& grid, const OwnedGroups& owned, SegmentDraft& draft) {
  const int first = static_cast<int>(draft.segments.size());
  for (const VoxelGroup& g : owned.groups.groups) {
    Segment segment;
    segment.voxels = g.voxels;
    segment.volume = static_cast<double>(g.voxels) * grid.voxel_volume();
    draft.segments.push_back(segment);
  }
  for (std::size_t p = 0; p < owned.group_of_plane.size(); ++p)
    if (owned.group_of_plane[p] >= 0)
      draft.segments[first + owned.group_of_plane[p]].planes.push_back(static_cast<int>(p));
  return first;
}

Segments finish_segments(const Planes& planes, SegmentDraft draft) {
  Segments out;
  if (draft.segments.empty()) {
    Segment all;
    all.planes.resize(planes.planes.size());
    std::iota(all.planes.begin(), all.planes.end(), 0);
    draft.segments = {all};
    draft.coverage = {{{0}, 1}};
    out.warnings.push_back("no voxel is enclosed by planes: the whole building is one segment");
  }
  put_in_order(draft);
  out.segments = std::move(draft.segments);
  out.coverage = std::move(draft.coverage);
  out.segment_of_plane.assign(planes.planes.size(), -1);
  for (std::size_t s = 0; s < out.segments.size(); ++s)
    for (int p : out.segments[s].planes) {
      assert(out.segment_of_plane[p] < 0);
      out.segment_of_plane[p] = static_cast<int>(s);
      out.segments[s].area += planes.planes[p].area;
    }
  if (out.coverage.empty())  // --rules paper: nothing enclosed in the grid that P(I) is counted in
    for (std::size_t s = 0; s < out.segments.size(); ++s)
      out.coverage.push_back({{static_cast<int>(s)}, static_cast<double>(out.segments[s].voxels)});
  double total = 0;
  for (const Coverage& c : out.coverage) total += c.share;
  if (!(total > 0)) {  // nothing but elements
    for (Coverage& c : out.coverage) c.share = 1;
    total = static_cast<double>(out.coverage.size());
  }
  for (Coverage& c : out.coverage) c.share /= total;
  return out;
}

Segments build_segments(const Planes& planes, const SegmentOptions& options) {
  assert(!planes.planes.empty());
  const auto start = std::chrono::steady_clock::now();
  Segments out;
  SegmentOptions ruled = options;
  ruled.visibility.is_party_wall_rule = options.rules.has(Rule::kPartyWalls);
  if (!options.rules.has(Rule::kWideOutlines)) ruled.visibility.border_ratio = 0;
  if (options.rules.has(Rule::kAlcoves)) {
    const HitGrid grid = cast_visibility(planes, ruled.visibility);
    out = robust_segments(planes, grid, ruled);
    out.rays = grid.rays, out.visibility_seconds = grid.seconds;
  } else {
    out = paper_segments(planes, ruled);
  }
  out.aggregation_seconds = std::max(0.0, seconds_since(start) - out.visibility_seconds);
  return out;
}

}  // namespace colod
