// Based on: Architectural Co-LOD Generation (ACM TOG 43(6), 2024), section 3.1, Segments
//   Aggregation.
// Differs: the paper's condition counts a plane as common from its first shared hit on, so one
//   stray ray joins what has nothing in common and a building collapses into "walls" and "roofs";
//   which ones depends on the order. --rules paper keeps it (kMembership) with its queue; robust
//   takes the intersection of the normalised histograms (kHistogram), best pair first. Neighbours
//   are those with face-adjacent voxels. Both keep what a group sees as a sparse list, since a
//   voxel sees 3 to 10 planes of hundreds.
// Notation: g plane-group, V its voxels, h[p] hits of V on plane p, H = Σ h[p].
#include "aggregation.h"

#include <algorithm>
#include <cassert>
#include <map>
#include <numeric>
#include <queue>
#include <unordered_map>

#include "core/parallel.h"

namespace colod {
namespace {

std::uint64_t mix(std::uint64_t h, std::uint64_t x) {
  h ^= x + 0x9e3779b97f4a7c15ULL + (h << 12) + (h >> 4);
  h *= 0xff51afd7ed558ccdULL;
  return h ^ (h >> 32);
}

bool sees_same_planes(const VoxelGroup& g, const std::vector<PlaneHits>& seen) {
  return std::equal(g.hits.begin(), g.hits.end(), seen.begin(), seen.end(),
                    [](const PlaneHits& a, const PlaneHits& b) { return a.plane == b.plane; });
}

/// Finds a group by its plane set.
class GroupIndex {
 public:
  explicit GroupIndex(std::vector<VoxelGroup>& groups) : groups_(groups) {}

  int find_or_add(const std::vector<PlaneHits>& seen) {
    std::uint64_t key = seen.size();
    for (const PlaneHits& s : seen) key = mix(key, s.plane);
    const auto [slot, is_new] = first_.try_emplace(key, static_cast<int>(groups_.size()));
    int last = -1;
    for (int g = is_new ? -1 : slot->second; g >= 0; last = g, g = next_[g])
      if (sees_same_planes(groups_[g], seen)) return g;
    const int added = static_cast<int>(groups_.size());
    if (last >= 0) next_[last] = added;
    next_.push_back(-1);
    groups_.emplace_back();
    groups_.back().hits.reserve(seen.size());  // of a million groups: every spare byte counts
    for (const PlaneHits& s : seen) groups_.back().hits.push_back({s.plane, 0});
    return added;
  }

 private:
  std::vector<VoxelGroup>& groups_;
  std::unordered_map<std::uint64_t, int> first_;  // by hash; only looked up
  std::vector<int> next_;                         // groups of equal hash
};

void sort_unique(std::vector<GroupPair>& pairs) {
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

/// Union-find over groups; the root is the lowest id, the longer list takes up the shorter one.
class GroupForest {
 public:
  explicit GroupForest(std::vector<VoxelGroup>& groups)
      : groups_(groups), parent_(groups.size()), version_(groups.size(), 0) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  int find(int g) {
    while (parent_[g] != g) g = parent_[g] = parent_[parent_[g]];
    return g;
  }
  bool is_root(int g) const { return parent_[g] == g; }
  const VoxelGroup& group(int root) const { return groups_[root]; }
  /// Rises whenever one of the two roots takes another group up.
  std::uint64_t stamp(int a, int b) const { return version_[a] + version_[b]; }

  void unite(int a, int b) {
    assert(a != b && is_root(a) && is_root(b));
    if (b < a) std::swap(a, b);
    VoxelGroup &to = groups_[a], &from = groups_[b];
    if (to.hits.size() < from.hits.size()) std::swap(to.hits, from.hits);
    add_hits(to.hits, from.hits);
    to.total += from.total, to.voxels += from.voxels;
    from = {};
    parent_[b] = a;
    ++version_[a];
  }

  /// Pairs of roots instead of pairs of their former parts.
  void update(std::vector<GroupPair>& pairs) {
    for (auto& [a, b] : pairs) {
      a = find(a), b = find(b);
      if (b < a) std::swap(a, b);
    }
    std::erase_if(pairs, [](const GroupPair& p) { return p.first == p.second; });
    sort_unique(pairs);
  }

 private:
  static void add_hits(std::vector<PlaneHits>& to, const std::vector<PlaneHits>& from) {
    const auto by_plane = [](const PlaneHits& a, const PlaneHits& b) { return a.plane < b.plane; };
    const std::size_t old = to.size();
    auto at = to.begin();
    std::vector<PlaneHits> added;
    for (const PlaneHits& h : from) {
      at = std::lower_bound(at, to.end(), h, by_plane);
      if (at != to.end() && at->plane == h.plane)
        at->hits += h.hits;
      else
        added.push_back(h);
    }
    if (added.empty()) return;
    to.insert(to.end(), added.begin(), added.end());
    std::inplace_merge(to.begin(), to.begin() + static_cast<std::ptrdiff_t>(old), to.end(),
                       by_plane);
  }

  std::vector<VoxelGroup>& groups_;
  std::vector<int> parent_;
  std::vector<std::uint64_t> version_;
};

/// What is left, numbered by lowest former id (which is the order of first voxels).
VoxelGroups compact(VoxelGroups groups, GroupForest& forest, std::vector<int>* target) {
  std::vector<int> number(groups.groups.size(), -1);
  VoxelGroups out;
  for (std::size_t g = 0; g < number.size(); ++g) {
    const int root = forest.find(static_cast<int>(g));
    if (root == static_cast<int>(g)) {
      number[g] = static_cast<int>(out.groups.size());
      out.groups.push_back(std::move(groups.groups[g]));
    } else {
      number[g] = number[root];
    }
  }
  out.group_of_voxel = std::move(groups.group_of_voxel);
  for (int& g : out.group_of_voxel)
    if (g >= 0) g = number[g];
  if (target) *target = std::move(number);
  return out;
}

/// The paper's queue: pairs in order of ids, again with what they became, until nothing merges.
void merge_in_queue_order(GroupForest& forest, std::vector<GroupPair> pairs, double threshold) {
  for (bool is_changed = true; is_changed;) {  // every round but the last leaves fewer groups
    is_changed = false;
    for (const auto& [first, second] : pairs) {
      const int a = forest.find(first), b = forest.find(second);
      if (a == b ||
          group_overlap(forest.group(a), forest.group(b), MergeRule::kMembership) <= threshold)
        continue;
      forest.unite(a, b);
      is_changed = true;
    }
    forest.update(pairs);
  }
}

struct Candidate {
  double overlap;
  int a, b;
  std::uint64_t stamp;

  bool operator<(const Candidate& o) const {  // the heap's top is the greatest
    if (overlap != o.overlap) return overlap < o.overlap;
    return std::pair(a, b) > std::pair(o.a, o.b);
  }
};

/// Greatest first. Most candidates are there from the start: these are sorted once, which is kinder
/// to the caches than a heap of millions.
class CandidateQueue {
 public:
  explicit CandidateQueue(std::vector<Candidate> start) : start_(std::move(start)) {
    std::sort(start_.begin(), start_.end());
  }
  bool is_empty() const { return start_.empty() && later_.empty(); }
  Candidate pop() {
    Candidate top;
    if (later_.empty() || (!start_.empty() && later_.top() < start_.back()))
      top = start_.back(), start_.pop_back();
    else
      top = later_.top(), later_.pop();
    return top;
  }
  void push(const Candidate& c) { later_.push(c); }

 private:
  std::vector<Candidate> start_;  ///< rising
  std::priority_queue<Candidate> later_;
};

/// The pairs above the threshold.
std::vector<Candidate> score(const GroupForest& forest, const std::vector<GroupPair>& pairs,
                             double threshold) {
  std::vector<double> overlaps(pairs.size());
  parallel_ranges(pairs.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      overlaps[i] = group_overlap(forest.group(pairs[i].first), forest.group(pairs[i].second),
                                  MergeRule::kHistogram);
  });
  const auto is_above = [&](double overlap) { return overlap > threshold; };
  std::vector<Candidate> above;
  above.reserve(
      static_cast<std::size_t>(std::count_if(overlaps.begin(), overlaps.end(), is_above)));
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (is_above(overlaps[i])) {
      const auto [a, b] = pairs[i];
      above.push_back({overlaps[i], a, b, forest.stamp(a, b)});
    }
  return above;
}

/// One round: all pairs scored, best first; a pair whose groups have grown is scored again.
bool merge_best_first(GroupForest& forest, const std::vector<GroupPair>& pairs, double threshold) {
  CandidateQueue queue(score(forest, pairs, threshold));
  std::unordered_map<std::uint64_t, std::uint64_t> scored;  // pair → stamp; only looked up
  bool is_changed = false;
  while (!queue.is_empty()) {
    const Candidate top = queue.pop();
    int a = forest.find(top.a), b = forest.find(top.b);
    if (a == b) continue;
    if (b < a) std::swap(a, b);
    const std::uint64_t stamp = forest.stamp(a, b);
    if (a == top.a && b == top.b && stamp == top.stamp) {
      forest.unite(a, b);
      is_changed = true;
      continue;
    }
    const std::uint64_t pair = static_cast<std::uint64_t>(a) << 32 | static_cast<std::uint32_t>(b);
    const auto [last, is_new] = scored.try_emplace(pair, stamp);
    if (!is_new && last->second == stamp) continue;  // another of its parts brought it here
    last->second = stamp;
    const double overlap = group_overlap(forest.group(a), forest.group(b), MergeRule::kHistogram);
    if (overlap > threshold) queue.push({overlap, a, b, stamp});
  }
  return is_changed;
}

struct Contact {
  int a, b;  // a > b; b −1: nothing
  std::int64_t faces;
};

/// Voxel faces between groups, and between a group and nothing.
std::vector<Contact> group_contacts(const HitGrid& grid, const VoxelGroups& groups) {
  if (groups.groups.empty()) return {};
  const std::ptrdiff_t n = grid.ns;
  const std::vector<int>& of = groups.group_of_voxel;
  std::map<GroupPair, std::int64_t> faces;
  const auto add = [&](int a, int b) {
    if (a != b) ++faces[{std::max(a, b), std::min(a, b)}];
  };
  const std::ptrdiff_t steps[] = {1, n, n * n};
  for (std::ptrdiff_t v = 0; v < n * n * n; ++v)
    for (int axis = 0; axis < 3; ++axis) {
      const std::ptrdiff_t at = v / steps[axis] % n;
      if (at == 0) add(of[v], -1);
      add(of[v], at + 1 < n ? of[v + steps[axis]] : -1);
    }
  std::vector<Contact> out;
  for (const auto& [pair, count] : faces) out.push_back({pair.first, pair.second, count});
  return out;
}

}  // namespace

std::int64_t voxel_around(const HitGrid& grid, const Vec3& x) {
  if (grid.box.is_empty()) return -1;
  const Vec3 size = grid.voxel_size();
  std::int64_t voxel = 0;
  for (int k = 2; k >= 0; --k) {
    const double at = size[k] > 0 ? (x[k] - grid.box.min[k]) / size[k] : 0;
    if (!(at >= 0 && at < grid.ns)) return -1;
    voxel = voxel * grid.ns + static_cast<std::int64_t>(at);
  }
  return voxel;
}

VoxelGroups group_voxels(const HitGrid& grid, const HitFilter& filter) {
  VoxelGroups out;
  const std::size_t voxels = grid.is_valid.size();
  out.group_of_voxel.assign(voxels, -1);
  GroupIndex index(out.groups);
  std::vector<PlaneHits> seen;
  int previous = -1;  // neighbours along a row mostly see the same planes
  for (std::size_t v = 0; v < voxels; ++v) {
    if (!filter.takes_part(grid, v)) continue;
    seen.clear();
    for (const Hit& hit : grid.at(v))
      if (const std::uint32_t count = filter.count(hit)) seen.push_back({hit.plane, count});
    if (seen.empty()) continue;
    if (previous < 0 || !sees_same_planes(out.groups[previous], seen))
      previous = index.find_or_add(seen);
    VoxelGroup& g = out.groups[previous];
    for (std::size_t i = 0; i < seen.size(); ++i)
      g.hits[i].hits += seen[i].hits, g.total += seen[i].hits;
    ++g.voxels;
    out.group_of_voxel[v] = previous;
  }
  return out;
}

std::vector<GroupPair> adjacent_groups(const HitGrid& grid, const VoxelGroups& groups) {
  if (groups.groups.empty()) return {};
  const std::size_t n = static_cast<std::size_t>(grid.ns);
  const std::vector<int>& of = groups.group_of_voxel;
  std::vector<std::vector<GroupPair>> of_slice(n);
  parallel_for(n, [&](std::size_t z) {
    std::vector<GroupPair>& pairs = of_slice[z];
    const auto add = [&](int a, std::size_t w) {
      const int b = of[w];
      if (b >= 0 && b != a) pairs.emplace_back(std::min(a, b), std::max(a, b));
    };
    for (std::size_t y = 0; y < n; ++y)
      for (std::size_t x = 0; x < n; ++x) {
        const std::size_t v = x + n * (y + n * z);
        if (of[v] < 0) continue;
        if (x + 1 < n) add(of[v], v + 1);
        if (y + 1 < n) add(of[v], v + n);
        if (z + 1 < n) add(of[v], v + n * n);
      }
    sort_unique(pairs);
  });
  std::vector<GroupPair> all;
  for (const auto& pairs : of_slice) all.insert(all.end(), pairs.begin(), pairs.end());
  sort_unique(all);
  return all;
}

double group_overlap(const VoxelGroup& a, const VoxelGroup& b, MergeRule rule) {
  if (a.hits.size() > b.hits.size()) return group_overlap(b, a, rule);
  if (a.total == 0 || b.total == 0) return 0;
  const double total_a = static_cast<double>(a.total), total_b = static_cast<double>(b.total);
  double sum = 0, common_a = 0, common_b = 0;
  auto at = b.hits.begin();
  for (const PlaneHits& h : a.hits) {
    at = std::lower_bound(at, b.hits.end(), h.plane,
                          [](const PlaneHits& x, std::uint32_t plane) { return x.plane < plane; });
    if (at == b.hits.end()) break;
    if (at->plane != h.plane) continue;
    const double share_a = static_cast<double>(h.hits) / total_a,
                 share_b = static_cast<double>(at->hits) / total_b;
    sum += std::min(share_a, share_b), common_a += share_a, common_b += share_b;
  }
  return rule == MergeRule::kHistogram ? sum : std::min(common_a, common_b);
}

VoxelGroups merge_groups(const HitGrid& grid, VoxelGroups groups, MergeRule rule,
                         double threshold) {
  std::vector<GroupPair> pairs = adjacent_groups(grid, groups);
  GroupForest forest(groups.groups);
  if (rule == MergeRule::kMembership)
    merge_in_queue_order(forest, std::move(pairs), threshold);
  else
    while (merge_best_first(forest, pairs, threshold)) forest.update(pairs);
  return compact(std::move(groups), forest, nullptr);
}

VoxelGroups join_groups(const HitGrid& grid, VoxelGroups groups, const std::vector<char>& is_kept,
                        bool is_anywhere, std::vector<int>* target) {
  const int n = static_cast<int>(groups.groups.size());
  assert(static_cast<int>(is_kept.size()) == n);
  GroupForest forest(groups.groups);
  std::vector<int> waiting, goal(n, -1);
  std::vector<std::vector<int>> neighbours(n);
  for (const auto& [a, b] : adjacent_groups(grid, groups))
    neighbours[a].push_back(b), neighbours[b].push_back(a);
  for (int g = 0; g < n; ++g) {
    if (is_kept[g])
      goal[g] = g;
    else
      waiting.push_back(g);
  }
  const bool has_goal = waiting.size() < static_cast<std::size_t>(n);

  // Against the groups as they came, so that the order of joining has no say.
  const auto best_of = [&](int g, const std::vector<int>& among) {
    int best = -1;
    double best_overlap = -1;
    for (int other : among) {
      if (goal[other] < 0) continue;
      const double overlap =
          group_overlap(groups.groups[g], groups.groups[goal[other]], MergeRule::kHistogram);
      if (overlap > best_overlap || (overlap == best_overlap && goal[other] < best))
        best = goal[other], best_overlap = overlap;
    }
    return best;
  };
  while (has_goal && !waiting.empty()) {  // each round settles a ring of groups, or is the last
    std::vector<GroupPair> settled;
    for (int g : waiting)
      if (const int best = best_of(g, neighbours[g]); best >= 0) settled.emplace_back(g, best);
    if (settled.empty()) {
      if (!is_anywhere) break;
      std::vector<int> all(n);
      std::iota(all.begin(), all.end(), 0);
      for (int g : waiting) settled.emplace_back(g, best_of(g, all));
    }
    for (const auto& [g, best] : settled) goal[g] = best;
    std::erase_if(waiting, [&](int g) { return goal[g] >= 0; });
  }
  for (int g = 0; g < n; ++g)
    if (goal[g] >= 0 && goal[g] != g) forest.unite(forest.find(g), forest.find(goal[g]));
  return compact(std::move(groups), forest, target);
}

VoxelGroups join_details(const HitGrid& grid, VoxelGroups groups, std::int64_t most_voxels,
                         double least_contact) {
  const std::vector<Contact> contacts = group_contacts(grid, groups);
  std::vector<std::int64_t> surface(groups.groups.size(), 0);
  for (const Contact& c : contacts) {
    surface[c.a] += c.faces;
    if (c.b >= 0) surface[c.b] += c.faces;
  }
  std::vector<Candidate> candidates;
  for (const Contact& c : contacts) {
    if (c.b < 0) continue;
    const double share =
        static_cast<double>(c.faces) / static_cast<double>(std::min(surface[c.a], surface[c.b]));
    if (share >= least_contact) candidates.push_back({share, c.a, c.b, 0});
  }
  std::sort(candidates.rbegin(), candidates.rend());
  GroupForest forest(groups.groups);
  for (const Candidate& c : candidates) {
    const int a = forest.find(c.a), b = forest.find(c.b);
    if (a != b && forest.group(a).voxels + forest.group(b).voxels <= most_voxels)
      forest.unite(a, b);
  }
  return compact(std::move(groups), forest, nullptr);
}

}  // namespace colod
