// Inside room `segments`: the two orders of passes, each from hits to segments, and what both
// share.
#pragma once

#include "aggregation.h"
#include "segments.h"

namespace colod {

/// Segments before they are put in order: `planes`, `is_alcove`, `voxels` and `volume` are set.
struct SegmentDraft {
  std::vector<Segment> segments;
  std::vector<Coverage> coverage;  ///< indices into `segments`; shares may be counts
};

/// Groups of one grid with the planes that each owns.
struct OwnedGroups {
  VoxelGroups groups;
  std::vector<int> group_of_plane;  ///< −1: none
};

/// Voxels that take part by what they see; small groups are joined (Rule::kHistograms, kSpecks).
VoxelGroups aggregate(const HitGrid& grid, const HitFilter& filter, const RuleSet& rules);

/// The groups of all valid voxels, and which of the active planes each owns (Rule::kDetails,
/// kBehind).
OwnedGroups own_groups(const Planes& planes, const HitGrid& grid,
                       const std::vector<char>& is_active, const RuleSet& rules);

/// Groups that own no plane are joined to the best neighbour that does; nothing is left when no
/// group owns one.
OwnedGroups drop_planeless(const HitGrid& grid, OwnedGroups owned);

/// One segment a group, appended to the draft; returns the index of the first.
int append_segments(const HitGrid& grid, const OwnedGroups& owned, SegmentDraft& draft);

/// Orders, numbers and measures the segments, normalises the coverage. An empty draft becomes one
/// segment of all planes, with a warning.
Segments finish_segments(const Planes& planes, SegmentDraft draft);

/// The coverage by plain segments that share no voxel.
void cover_plain(SegmentDraft& draft);

/// What of the fidelity (eq. 3) is lost when segments are dropped together; shares sum to 1, the
/// empty set's cannot be lost.
std::vector<Coverage> fidelity_coverage(const HitGrid& grid, const Segments& segments);

/// The closed pass and its alcoves (Rule::kAlcoves) on hits as cast with all planes active and none
/// reversed.
Segments robust_segments(const Planes& planes, const HitGrid& grid, const SegmentOptions& options);

/// Algorithm 1, with the other rules that are on; casts by itself, twice.
Segments paper_segments(const Planes& planes, const SegmentOptions& options);

/// Voxels of the first grid by the segments that enclose them: its own, and that of the second
/// grid's voxel around the same centre. `first_*` are the segments of group 0 of each grid.
std::vector<Coverage> overlay_coverage(const HitGrid& a, const VoxelGroups& groups_a, int first_a,
                                       const HitGrid& c, const VoxelGroups& groups_c, int first_c);

}  // namespace colod
