// Based on: Co-LOD eq. 3. P(M) are the voxels that M encloses, and a voxel is enclosed when at
// least half of what its rays met is of M: the rule of section 3.1, asked of M's planes alone.
// Differs: robust rules only; to the letter a voxel is its segment's, and a pane that a few voxels
//   see most of would be worth 2 % of a house. Three tenths of the fidelity are outline (seen
//   along the three axes), since a spire has little volume for what it shows. Where an alcove is
//   dropped the building closes over it, so that its walls are nobody's.
// Notation: a voxel's sets: the segments that it sees most of, as many as have to be dropped
//   together before it is open.
#include <algorithm>
#include <array>
#include <map>

#include "parameters.h"
#include "rules.h"

namespace colod {
namespace {

using namespace parameters::segments;

/// Sets of segments, numbered; 0 is the empty one: nobody can open the voxel.
class Sets {
 public:
  int number(const std::vector<int>& set) {
    if (set.empty() || std::ssize(set) > kMostTogether) return 0;
    const auto [at, is_new] = numbers_.try_emplace(set, static_cast<int>(sets_.size()));
    if (is_new) sets_.push_back(set);
    return at->second;
  }
  const std::vector<int>& operator[](int number) const { return sets_[number]; }
  std::size_t size() const { return sets_.size(); }

 private:
  std::map<std::vector<int>, int> numbers_;
  std::vector<std::vector<int>> sets_ = {{}};
};

/// The segments whose loss opens the voxel, by number.
int opening_set(const HitGrid& grid, std::size_t voxel, const std::vector<int>& owner_of_plane,
                std::vector<std::pair<std::uint32_t, int>>& of_segment, Sets& sets) {
  of_segment.clear();
  std::uint32_t total = 0;
  for (const Hit& hit : grid.at(voxel)) {
    total += hit.inside;
    const int s = owner_of_plane[hit.plane];
    if (hit.inside == 0 || s < 0) continue;
    const auto known = std::find_if(of_segment.begin(), of_segment.end(),
                                    [s](const auto& x) { return x.second == s; });
    if (known == of_segment.end())
      of_segment.emplace_back(hit.inside, s);
    else
      known->first += hit.inside;
  }
  std::sort(of_segment.begin(), of_segment.end(), [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first > b.first : a.second < b.second;
  });
  std::vector<int> set;
  std::uint32_t left = total;
  for (const auto& [hits, s] : of_segment) {
    if (2 * left < total) break;
    set.push_back(s), left -= hits;
  }
  if (2 * left >= total) return 0;
  std::sort(set.begin(), set.end());
  return sets.number(set);
}

/// How often each set is all that a column of voxels along one axis shows.
std::vector<double> outline_counts(const HitGrid& grid, const std::vector<int>& set_of_voxel,
                                   int axis, Sets& sets) {
  const std::size_t n = grid.ns;
  const std::array<std::size_t, 3> step = {1, n, n * n};
  std::vector<double> counts;
  std::vector<int> together;
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = 0; b < n; ++b) {
      together.clear();
      bool is_shown = false, is_kept = false;
      int last = -1;
      const std::size_t begin = a * step[(axis + 1) % 3] + b * step[(axis + 2) % 3];
      for (std::size_t i = 0; i < n && !is_kept; ++i) {
        const int set = set_of_voxel[begin + i * step[axis]];
        if (set < 0 || set == last) continue;
        last = set, is_shown = true;
        is_kept = set == 0;
        for (const int s : sets[set])
          if (std::find(together.begin(), together.end(), s) == together.end())
            together.push_back(s);
        is_kept |= std::ssize(together) > kMostTogether;
      }
      if (!is_shown) continue;
      std::sort(together.begin(), together.end());
      const int set = is_kept ? 0 : sets.number(together);
      counts.resize(std::max(counts.size(), sets.size()), 0);
      ++counts[set];
    }
  return counts;
}

void add_share(const std::vector<double>& counts, double weight, std::vector<double>& shares) {
  double sum = 0;
  for (const double c : counts) sum += c;
  shares.resize(std::max(shares.size(), counts.size()), 0);
  for (std::size_t i = 0; i < counts.size() && sum > 0; ++i) shares[i] += weight * counts[i] / sum;
}

}  // namespace

std::vector<Coverage> fidelity_coverage(const HitGrid& grid, const Segments& segments) {
  std::vector<int> owner_of_plane = segments.segment_of_plane;
  for (int& s : owner_of_plane)
    if (s >= 0 && segments.segments[s].is_alcove) s = -1;
  Sets sets;
  std::vector<int> set_of_voxel(grid.is_valid.size(), -1);
  std::vector<std::pair<std::uint32_t, int>> of_segment;
  std::vector<double> counts(1, 0);
  for (std::size_t v = 0; v < set_of_voxel.size(); ++v) {
    if (!grid.is_valid[v]) continue;
    const int set = opening_set(grid, v, owner_of_plane, of_segment, sets);
    set_of_voxel[v] = set;
    counts.resize(std::max(counts.size(), sets.size()), 0);
    ++counts[set];
  }
  for (std::size_t s = 0; s < segments.segments.size(); ++s)
    if (const Segment& alcove = segments.segments[s];
        alcove.is_alcove && alcove.kind == ElementKind::kPlain) {
      const int set = sets.number({static_cast<int>(s)});
      counts.resize(std::max(counts.size(), sets.size()), 0);
      counts[set] += static_cast<double>(alcove.voxels);
    }
  std::vector<double> shares;
  add_share(counts, 1 - kOutlineShare, shares);
  for (int axis = 0; axis < 3; ++axis)
    add_share(outline_counts(grid, set_of_voxel, axis, sets), kOutlineShare / 3, shares);
  std::vector<Coverage> coverage;
  for (std::size_t i = 0; i < shares.size(); ++i)
    if (shares[i] > 0) coverage.push_back({sets[static_cast<int>(i)], shares[i]});
  std::sort(coverage.begin(), coverage.end(),
            [](const Coverage& a, const Coverage& b) { return a.segments < b.segments; });
  return coverage;
}

}  // namespace colod
