// Inside room `segments`: voxels → groups of voxels that see the same planes. Works on a HitGrid
// alone.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "visibility/visibility.h"

namespace colod {

/// Which voxels take part in a pass and which of their hits count.
struct HitFilter {
  bool is_outside = false;           ///< hits on outer sides (alcoves) instead of inner ones
  std::vector<char> is_counted;      ///< per plane; empty: every plane counts
  std::vector<std::uint8_t> voxels;  ///< ns³; empty: the grid's valid voxels

  bool takes_part(const HitGrid& grid, std::size_t voxel) const {
    return (voxels.empty() ? grid.is_valid : voxels)[voxel] != 0;
  }
  std::uint32_t count(const Hit& hit) const {
    if (!is_counted.empty() && !is_counted[hit.plane]) return 0;
    return is_outside ? hit.outside : hit.inside;
  }
};

struct PlaneHits {
  std::uint32_t plane;
  std::uint64_t hits;
};

/// A plane-group g with its voxels V.
struct VoxelGroup {
  std::vector<PlaneHits> hits;  ///< Σ over V of Hitlist_v[p], by rising plane, all positive
  std::uint64_t total = 0;      ///< hSum(g, V)
  std::int64_t voxels = 0;
};

struct VoxelGroups {
  std::vector<VoxelGroup> groups;   ///< in the order of their first voxel
  std::vector<int> group_of_voxel;  ///< ns³; −1: none
};

/// Index of the voxel around x; −1 outside the box.
std::int64_t voxel_around(const HitGrid& grid, const Vec3& x);

using GroupPair = std::pair<int, int>;  ///< first < second

/// Voxels that take part and see the same set of planes form one group, wherever they lie.
VoxelGroups group_voxels(const HitGrid& grid, const HitFilter& filter = {});

/// Pairs of groups with face-adjacent voxels: rising, no doubles.
std::vector<GroupPair> adjacent_groups(const HitGrid& grid, const VoxelGroups& groups);

enum class MergeRule {
  kMembership,  ///< the paper: the least share, of both sides, of the hits on common planes
  kHistogram    ///< Σ_p min(h_a[p]/H_a, h_b[p]/H_b)
};

/// How much a and b see the same planes, in [0, 1].
double group_overlap(const VoxelGroup& a, const VoxelGroup& b, MergeRule rule);

/// Merges adjacent groups with an overlap above `threshold` until none is left.
/// kMembership takes pairs in the order of a queue, kHistogram the best pair first (ties: by ids).
VoxelGroups merge_groups(const HitGrid& grid, VoxelGroups groups, MergeRule rule,
                         double threshold = 0.5);

/// Joins each group with is_kept false to a neighbour: the one of best overlap (histogram) among
/// the kept ones it touches, or reaches over others that are not kept; touching none, the best
/// anywhere; nothing is joined when no group is kept. `target`, when asked for, receives the new
/// index of each old group.
VoxelGroups join_groups(const HitGrid& grid, VoxelGroups groups, const std::vector<char>& is_kept,
                        bool is_anywhere, std::vector<int>* target = nullptr);

/// Joins groups of at most `most_voxels` (together, too) that touch each other with at least
/// `least_contact` of the surface (voxel faces) of one of them; the closest contact first.
VoxelGroups join_details(const HitGrid& grid, VoxelGroups groups, std::int64_t most_voxels,
                         double least_contact);

}  // namespace colod
