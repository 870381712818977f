// Based on: Co-LOD section 3.2, "Spectral Clustering": eigenvectors of the normalised Laplacian's
// l_n − 1 smallest eigenvalues as features, k-means, order by size.
//
// Differs. --rules paper: k eigenvectors, clusters are layers, by falling mean volume.
// --rules robust: kinds are found first (kinds.h), and a kind is on one layer. Both: where there
// are no k kinds (fewer segments than clusters, no gap after the k-th eigenvalue, clusters that
// stay empty) size decides, as in Layering::kSize: thresholds on the extent, `size_threshold` ·
// 2^(k/2 − i), i = 1..k−1: absolute, so that a scene's layers do not depend on what else stands in
// it.
//
// Notation: n segments, k = l_n − 1 clusters, S similarities, D their row sums,
// L = D^-1/2 (D − S) D^-1/2.
#include "clustering.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "clustering_spectrum.h"
#include "core/flat.h"
#include "core/parallel.h"
#include "k_means.h"
#include "kinds.h"
#include "parameters.h"

namespace colod {
namespace {

using namespace parameters::coanalysis;

constexpr double kSameEigenvalue = 1e-9;
constexpr int kVoters = 5;  // of a prior
const char* const kNotConverged = "layers: the eigenvectors did not converge";

// 0..k−1, coarse to fine.
int size_class(const Descriptor& d, int k, double threshold) {
  int c = 0;
  for (int i = 1; i < k; ++i) c += d.extent < threshold * std::exp2(0.5 * k - i);
  return c;
}

// Renumbers clusters by falling mean volume; ties by the first segment. False when one is empty.
bool order_clusters(const std::vector<Descriptor>& segments, int k, std::vector<int>& cluster) {
  std::vector<double> sum(k, 0), count(k, 0);
  std::vector<std::size_t> first(k, segments.size());
  for (std::size_t i = segments.size(); i-- > 0;) {
    sum[cluster[i]] += segments[i].volume, ++count[cluster[i]];
    first[cluster[i]] = i;
  }
  std::vector<int> order(k), rank(k);
  std::iota(order.begin(), order.end(), 0);
  const auto size = [&](int c) { return count[c] > 0 ? sum[c] / count[c] : -1; };
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return size(a) != size(b) ? size(a) > size(b) : first[a] < first[b];
  });
  for (int r = 0; r < k; ++r) rank[order[r]] = r;
  for (int& c : cluster) c = rank[c];
  return std::find(count.begin(), count.end(), 0) == count.end();
}

// The paper's classes: 0..k−1, coarse to fine; empty when the spectrum does not tell k apart.
std::vector<int> paper_classes(const std::vector<Descriptor>& segments, int k,
                               const ClusteringOptions& options, Clustering& result) {
  if (static_cast<int>(segments.size()) < k) return {};
  const Spectrum spectrum =
      smallest_spectrum(segments, k, options.eta, segment_similarity, options.seed);
  result.eigenvalues = spectrum.values;
  if (spectrum.values.size() < static_cast<std::size_t>(k)) {
    result.warnings.push_back(kNotConverged);
    return {};
  }
  if (spectrum.values.size() > static_cast<std::size_t>(k) &&
      spectrum.values[k] - spectrum.values[k - 1] < kSameEigenvalue)
    return {};
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(spectrum.vectors.rows());
  std::vector<int> cluster = k_means(spectrum.vectors, ones, k, options.seed);
  if (!order_clusters(segments, k, cluster)) return {};
  return cluster;
}

std::vector<KindFacts> describe_kinds(const std::vector<Descriptor>& segments,
                                      const std::vector<int>& kind,
                                      const std::vector<int>& classes) {
  std::map<int, std::pair<int, std::vector<double>>> members;  // class and extents
  for (std::size_t s = 0; s < segments.size(); ++s) {
    members[kind[s]].first = classes[s];
    members[kind[s]].second.push_back(segments[s].extent);
  }
  std::vector<KindFacts> facts;
  for (auto& [k, its] : members)
    facts.push_back({1 + its.first, its.second.size(), median(its.second)});
  std::stable_sort(facts.begin(), facts.end(),
                   [](const KindFacts& a, const KindFacts& b) { return a.extent > b.extent; });
  return facts;
}

// Kinds first, then layers of whole kinds; empty when there are fewer than k kinds.
std::vector<int> robust_classes(const std::vector<Descriptor>& segments, int k,
                                const ClusteringOptions& options, Clustering& result) {
  Kinds kinds = find_kinds(segments, kKindsALayer * k, options.eta, options.seed);
  result.eigenvalues = std::move(kinds.eigenvalues);
  if (!kinds.has_converged) result.warnings.push_back(kNotConverged);
  std::vector<int> classes = classes_of_kinds(segments, kinds.kind, k);
  if (!classes.empty()) result.kinds = describe_kinds(segments, kinds.kind, classes);
  return classes;
}

}  // namespace

Clustering classify_segments(const std::vector<Descriptor>& segments, const Prior& prior,
                             const ClusteringOptions& options) {
  std::vector<std::pair<const Descriptor*, int>> known;
  for (const Prior::PriorBuilding& b : prior.buildings)
    for (std::size_t s = 0; s < b.segments.size(); ++s)
      if (b.layer[s] > 0 && b.layer[s] < options.layers)
        known.push_back({&b.segments[s], b.layer[s]});
  if (known.empty() || options.layers < 2) {
    ClusteringOptions by_size = options;
    by_size.layering = Layering::kSize;
    return cluster_segments(segments, by_size);
  }
  Clustering result;
  result.layer.assign(segments.size(), 1);
  parallel_for(segments.size(), [&](std::size_t s) {
    std::vector<std::pair<double, std::size_t>> nearest;  // −similarity, which
    for (std::size_t i = 0; i < known.size(); ++i) {
      const double similarity = kind_similarity(segments[s], *known[i].first, options.eta);
      if (std::isfinite(similarity)) nearest.push_back({-similarity, i});
    }
    const auto end = nearest.begin() + std::min<std::ptrdiff_t>(kVoters, std::ssize(nearest));
    std::partial_sort(nearest.begin(), end, nearest.end());
    std::vector<double> votes(options.layers, 0.0);
    for (auto n = nearest.begin(); n != end; ++n) votes[known[n->second].second] -= n->first;
    result.layer[s] =
        std::max(1, static_cast<int>(std::max_element(votes.begin(), votes.end()) - votes.begin()));
  });
  return result;
}

Clustering cluster_segments(const std::vector<Descriptor>& segments,
                            const ClusteringOptions& options) {
  Clustering result;
  const int k = options.layers - 1;
  result.layer.assign(segments.size(), std::max(0, std::min(1, k)));
  if (k < 1 || segments.empty()) return result;

  std::vector<int> classes;
  if (options.layering == Layering::kSpectral && k > 1)
    classes = options.rules.has(Rule::kKinds) ? robust_classes(segments, k, options, result)
                                              : paper_classes(segments, k, options, result);
  if (!classes.empty()) {
    for (std::size_t s = 0; s < segments.size(); ++s) result.layer[s] = 1 + classes[s];
    return result;
  }
  if (options.layering == Layering::kSpectral && k > 1)
    result.warnings.push_back(
        "layers: too few kinds of segments for the spectrum; size alone decides");
  for (std::size_t s = 0; s < segments.size(); ++s)
    result.layer[s] = 1 + size_class(segments[s], k, options.size_threshold);
  return result;
}

}  // namespace colod
