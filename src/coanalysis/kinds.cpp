// Based on: Ng, Jordan, Weiss, "On spectral clustering", 2002 (rows of unit length); Wagstaff et
// al., "Constrained k-means clustering with background knowledge", 2001 (must-links).
// Differs: the paper's clusters are layers: as many eigenvectors as layers part segments by size
// alone (one extent gave 348 of 349 assignments of 40 made-up scans, November 2026). With more
// eigenvectors and kinds than layers, chimneys, windows and strips of roofs are kinds of their own,
// and a kind is ordered as a whole.
// Notation: –
#include "kinds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "clustering_spectrum.h"
#include "core/flat.h"
#include "k_means.h"
#include "parameters.h"

namespace colod {
namespace {

using namespace parameters::coanalysis;

constexpr double kLeastExtent = 1e-3;  // metres, for logarithms

/// Segments that must be of one kind: the group of each, numbered by first members.
std::vector<int> must_links(const std::vector<Descriptor>& segments) {
  std::vector<int> group;
  std::map<ElementKind, int> of_kind;
  int groups = 0;
  for (const Descriptor& d : segments) {
    if (!has_kind(d)) {
      group.push_back(groups++);
      continue;
    }
    const auto [at, is_new] = of_kind.try_emplace(d.kind, groups);
    groups += is_new;
    group.push_back(at->second);
  }
  return group;
}

/// How many segments differ pairwise by more than the noise of their samples, counted up to `most`.
int count_different(const std::vector<Descriptor>& segments, int most, double eta) {
  std::vector<const Descriptor*> leaders;
  for (const Descriptor& d : segments) {
    if (std::ssize(leaders) == most) break;
    if (std::none_of(leaders.begin(), leaders.end(),
                     [&](const Descriptor* l) { return kind_distance(d, *l, eta) <= kSameKind; }))
      leaders.push_back(&d);
  }
  return static_cast<int>(leaders.size());
}

/// Numbers without gaps, in the order of their first members.
void renumber(std::vector<int>& numbers) {
  std::map<int, int> rank;
  for (int& n : numbers) n = rank.try_emplace(n, static_cast<int>(rank.size())).first->second;
}

/// Median extents of the kinds, as logarithms.
std::vector<double> log_extents(const std::vector<Descriptor>& segments,
                                const std::vector<int>& kind) {
  std::vector<std::vector<double>> extents(*std::max_element(kind.begin(), kind.end()) + 1);
  for (std::size_t s = 0; s < segments.size(); ++s)
    extents[kind[s]].push_back(std::log(std::max(segments[s].extent, kLeastExtent)));
  std::vector<double> medians;
  for (std::vector<double>& values : extents) medians.push_back(median(std::move(values)));
  return medians;
}

/// The logarithms of the extents that bound all segments but the largest and the smallest tenth:
/// one large or small segment more hardly moves them.
std::array<double, 2> size_range(const std::vector<Descriptor>& segments) {
  std::vector<double> sizes;
  for (const Descriptor& d : segments) sizes.push_back(std::log(std::max(d.extent, kLeastExtent)));
  std::sort(sizes.begin(), sizes.end());
  const auto tail = static_cast<std::size_t>(kSizeTail * static_cast<double>(sizes.size()));
  return {sizes[tail], sizes[sizes.size() - 1 - tail]};
}

/// Per item of a falling list its class, 0..k−1: their borders part the range in equal steps, but
/// no class is without an item. Needs k items.
std::vector<int> part_in_steps(const std::vector<double>& falling,
                               const std::array<double, 2>& range, int k) {
  const int n = static_cast<int>(falling.size());
  std::vector<int> classes(n, k - 1);
  for (int c = 0, begin = 0; c + 1 < k; ++c) {
    const double border = range[1] - (range[1] - range[0]) * (c + 1) / k;
    const auto above =
        std::count_if(falling.begin(), falling.end(), [&](double size) { return size > border; });
    const int end = std::clamp(static_cast<int>(above), begin + 1, n - (k - 1 - c));
    std::fill(classes.begin() + begin, classes.begin() + end, c);
    begin = end;
  }
  return classes;
}

}  // namespace

Kinds find_kinds(const std::vector<Descriptor>& segments, int count, double eta,
                 std::uint64_t seed) {
  Kinds kinds;
  count = count_different(segments, count, eta);
  if (count < 2) return kinds;
  const Spectrum spectrum = smallest_spectrum(segments, count, eta, kind_similarity, seed);
  kinds.eigenvalues = spectrum.values;
  kinds.has_converged = std::ssize(spectrum.values) >= count;
  if (!kinds.has_converged) return kinds;
  const std::vector<int> group = must_links(segments);
  const Eigen::Index groups = *std::max_element(group.begin(), group.end()) + 1;
  Features rows = Features::Zero(groups, count);
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(groups);
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const auto row = spectrum.vectors.row(static_cast<Eigen::Index>(s));
    rows.row(group[s]) += row / std::max(row.norm(), std::numeric_limits<double>::min());
    weights[group[s]] += 1;
  }
  rows.array().colwise() /= weights.array();
  const std::vector<int> cluster = k_means(rows, weights, count, seed);
  for (const int g : group) kinds.kind.push_back(cluster[g]);
  renumber(kinds.kind);
  return kinds;
}

std::vector<int> classes_of_kinds(const std::vector<Descriptor>& segments,
                                  const std::vector<int>& kind, int k) {
  if (kind.empty()) return {};
  const std::vector<double> extent = log_extents(segments, kind);
  if (std::ssize(extent) < k) return {};
  std::vector<int> order(extent.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return extent[a] > extent[b]; });
  std::vector<double> falling;
  for (const int c : order) falling.push_back(extent[c]);
  const std::vector<int> parted = part_in_steps(falling, size_range(segments), k);
  std::vector<int> class_of_kind(extent.size());
  for (std::size_t i = 0; i < order.size(); ++i) class_of_kind[order[i]] = parted[i];
  std::vector<int> classes;
  for (const int c : kind) classes.push_back(class_of_kind[c]);
  return classes;
}

}  // namespace colod
