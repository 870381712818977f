// Based on: Co-LOD section 3.2, "Spectral Clustering": eigenvectors of the normalised Laplacian's
// l_n − 1 smallest eigenvalues as features, k-means, order by size. k-means++ seeding: Arthur,
// Vassilvitskii, "k-means++: the advantages of careful seeding", 2007.
//
// Differs. --rules paper: all segments into the spectrum, clusters by falling mean volume.
// --rules robust: flat segments are set aside (whitening makes them a class of their own, and the
// clusters would be "flat / not flat"); clusters by falling median extent (mean volume is fragile:
// leaving out one building of 15 swapped layers, measured in November 2026); flat ones then join
// the layer whose median log extent is nearest. Robust: segments that differ by no more than the
// noise of their samples are of one kind. Both: where there are no k kinds (fewer segments than
// clusters, no gap after the k-th eigenvalue, clusters that stay empty) size decides, as in
// Layering::kSize: thresholds on the extent, `size_threshold` · 2^(k/2 − i), i = 1..k−1: absolute,
// so that a scene's layers do not depend on what else stands in it.
//
// Notation: n segments, k = l_n − 1 clusters, S similarities, D their row sums,
// L = D^-1/2 (D − S) D^-1/2.
#include "clustering.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "clustering_spectrum.h"
#include "core/flat.h"
#include "core/parallel.h"
#include "parameters.h"

namespace colod {
namespace {

using namespace parameters::coanalysis;

constexpr int kRestarts = 20, kMaxIterations = 100;
constexpr double kSameEigenvalue = 1e-9;
constexpr int kVoters = 5;             // of a prior
constexpr double kLeastExtent = 1e-3;  // metres, for logarithms

using Features = Eigen::MatrixXd;  // a segment a row

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

// k-means++: the next centre with probability proportional to the squared distance to the nearest.
Features first_centres(const Features& x, int k, std::mt19937_64& random) {
  const Eigen::Index n = x.rows();
  Features centres(k, x.cols());
  Eigen::VectorXd nearest = Eigen::VectorXd::Constant(n, std::numeric_limits<double>::max());
  Eigen::Index pick =
      std::min(n - 1, static_cast<Eigen::Index>(unit(random) * static_cast<double>(n)));
  for (int c = 0; c < k; ++c) {
    centres.row(c) = x.row(pick);
    nearest = nearest.cwiseMin((x.rowwise() - x.row(pick)).rowwise().squaredNorm());
    double left = unit(random) * nearest.sum();
    for (pick = 0; pick < n - 1 && left >= nearest[pick]; ++pick) left -= nearest[pick];
  }
  return centres;
}

struct Partition {
  std::vector<int> cluster;
  double cost = std::numeric_limits<double>::infinity();
};

// Lloyd's iterations; ties go to the lower cluster; an emptied cluster keeps its centre.
Partition lloyd(const Features& x, Features centres) {
  Partition p;
  p.cluster.assign(x.rows(), -1);
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    bool is_changed = false;
    p.cost = 0;
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      Eigen::Index c = 0;
      p.cost += (centres.rowwise() - x.row(i)).rowwise().squaredNorm().minCoeff(&c);
      is_changed |= p.cluster[i] != static_cast<int>(c);
      p.cluster[i] = static_cast<int>(c);
    }
    if (!is_changed) break;
    Features sum = Features::Zero(centres.rows(), centres.cols());
    Eigen::VectorXd count = Eigen::VectorXd::Zero(centres.rows());
    for (Eigen::Index i = 0; i < x.rows(); ++i)
      sum.row(p.cluster[i]) += x.row(i), ++count[p.cluster[i]];
    for (Eigen::Index c = 0; c < centres.rows(); ++c)
      if (count[c] > 0) centres.row(c) = sum.row(c) / count[c];
  }
  return p;
}

// The cheapest of the restarts, the first of equals.
std::vector<int> k_means(const Features& x, int k, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Partition best;
  for (int r = 0; r < kRestarts; ++r) {
    Partition p = lloyd(x, first_centres(x, k, random));
    if (p.cost < best.cost * (1 - 1e-12)) best = std::move(p);
  }
  return best.cluster;
}

double log_extent(const Descriptor& d) { return std::log(std::max(d.extent, kLeastExtent)); }

// 0..k−1, coarse to fine.
int size_class(const Descriptor& d, int k, double threshold) {
  int c = 0;
  for (int i = 1; i < k; ++i) c += d.extent < threshold * std::exp2(0.5 * k - i);
  return c;
}

// Per cluster what it is ordered by: mean volume or median extent; −1 when empty.
std::vector<double> cluster_sizes(const std::vector<Descriptor>& segments,
                                  const std::vector<int>& ids, const std::vector<int>& cluster,
                                  int k, bool is_by_extent) {
  std::vector<double> size(k, -1.0);
  for (int c = 0; c < k; ++c) {
    std::vector<double> values;
    for (std::size_t i = 0; i < ids.size(); ++i)
      if (cluster[i] == c)
        values.push_back(is_by_extent ? segments[ids[i]].extent : segments[ids[i]].volume);
    if (values.empty()) continue;
    const double sum = std::accumulate(values.begin(), values.end(), 0.0);
    size[c] = is_by_extent ? median(values) : sum / static_cast<double>(values.size());
  }
  return size;
}

// Renumbers clusters by falling size; ties by the first segment. False when one is empty.
bool order_clusters(const std::vector<Descriptor>& segments, const std::vector<int>& ids, int k,
                    bool is_by_extent, std::vector<int>& cluster) {
  const std::vector<double> size = cluster_sizes(segments, ids, cluster, k, is_by_extent);
  std::vector<std::size_t> first(k, ids.size());
  for (std::size_t i = ids.size(); i-- > 0;) first[cluster[i]] = i;
  std::vector<int> order(k), rank(k);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return size[a] != size[b] ? size[a] > size[b] : first[a] < first[b];
  });
  for (int r = 0; r < k; ++r) rank[order[r]] = r;
  for (int& c : cluster) c = rank[c];
  return std::find(first.begin(), first.end(), ids.size()) == first.end();
}

// Whether some k segments differ pairwise by more than the noise of their samples.
bool has_kinds(const std::vector<Descriptor>& segments, const std::vector<int>& ids, int k,
               double eta) {
  std::vector<int> leaders;
  for (const int s : ids) {
    if (std::none_of(leaders.begin(), leaders.end(), [&](int l) {
          return segment_distance(segments[s], segments[l], eta) <= kSameKind;
        }))
      leaders.push_back(s);
    if (static_cast<int>(leaders.size()) >= k) return true;
  }
  return false;
}

// The spectrum's classes of `ids`, 0..k−1 coarse to fine; empty when it does not tell k apart.
std::vector<int> spectral_classes(const std::vector<Descriptor>& segments,
                                  const std::vector<int>& ids, int k,
                                  const ClusteringOptions& options, Clustering& result) {
  if (static_cast<int>(ids.size()) < k) return {};
  if (options.rules.has(Rule::kKinds) && !has_kinds(segments, ids, k, options.eta)) return {};
  const Spectrum spectrum = smallest_spectrum(segments, ids, k, options.eta, options.seed);
  result.eigenvalues = spectrum.values;
  if (spectrum.values.size() < static_cast<std::size_t>(k)) {
    result.warnings.push_back("layers: the eigenvectors did not converge");
    return {};
  }
  if (spectrum.values.size() > static_cast<std::size_t>(k) &&
      spectrum.values[k] - spectrum.values[k - 1] < kSameEigenvalue)
    return {};
  std::vector<int> cluster = k_means(spectrum.vectors, k, options.seed);
  if (!order_clusters(segments, ids, k, options.rules.has(Rule::kMedianExtent), cluster)) return {};
  return cluster;
}

// The class with the nearest median log extent; ties go to the coarser.
void place_flat(const std::vector<Descriptor>& segments, const std::vector<int>& flat,
                const std::vector<int>& ids, const std::vector<int>& classes, int k,
                std::vector<int>& layer) {
  std::vector<double> middle(k);
  for (int c = 0; c < k; ++c) {
    std::vector<double> values;
    for (std::size_t i = 0; i < ids.size(); ++i)
      if (classes[i] == c) values.push_back(log_extent(segments[ids[i]]));
    middle[c] = median(values);  // every class of the spectrum has a segment
  }
  for (const int s : flat) {
    const double own = log_extent(segments[s]);
    const auto nearest = std::min_element(middle.begin(), middle.end(), [&](double a, double b) {
      return std::abs(a - own) < std::abs(b - own);
    });
    layer[s] = 1 + static_cast<int>(nearest - middle.begin());
  }
}

// What is of a kind is so whatever its size: all balconies, all loggias, all bays, all dormers and
// all windows go to the layer on which most of them are, the coarsest of equals. The votes are
// those of the scene, or of a prior that knows the kind.
void settle_kinds(const std::vector<Descriptor>& segments, const std::vector<Descriptor>& voters,
                  const std::vector<int>& layer_of_voter, int layers, std::vector<int>& layer) {
  for (const ElementKind kind : {ElementKind::kBalcony, ElementKind::kLoggia, ElementKind::kDormer,
                                 ElementKind::kBay, ElementKind::kWindow}) {
    std::vector<int> votes(layers, 0);
    for (std::size_t v = 0; v < voters.size(); ++v)
      if (voters[v].kind == kind) ++votes[layer_of_voter[v]];
    const auto most = std::max_element(votes.begin(), votes.end());
    if (*most == 0) continue;
    for (std::size_t s = 0; s < segments.size(); ++s)
      if (segments[s].kind == kind) layer[s] = static_cast<int>(most - votes.begin());
  }
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
      const double similarity = segment_similarity(segments[s], *known[i].first, options.eta);
      if (std::isfinite(similarity)) nearest.push_back({-similarity, i});
    }
    const auto end = nearest.begin() + std::min<std::ptrdiff_t>(kVoters, std::ssize(nearest));
    std::partial_sort(nearest.begin(), end, nearest.end());
    std::vector<double> votes(options.layers, 0.0);
    for (auto n = nearest.begin(); n != end; ++n) votes[known[n->second].second] -= n->first;
    result.layer[s] =
        std::max(1, static_cast<int>(std::max_element(votes.begin(), votes.end()) - votes.begin()));
  });
  std::vector<Descriptor> voters;
  std::vector<int> layer_of_voter;
  for (const auto& [descriptor, layer] : known)
    voters.push_back(*descriptor), layer_of_voter.push_back(layer);
  if (options.rules.has(Rule::kElementLayers))
    settle_kinds(segments, voters, layer_of_voter, options.layers, result.layer);
  return result;
}

Clustering cluster_segments(const std::vector<Descriptor>& segments,
                            const ClusteringOptions& options) {
  Clustering result;
  const int k = options.layers - 1;
  result.layer.assign(segments.size(), std::max(0, std::min(1, k)));
  if (k < 1 || segments.empty()) return result;

  std::vector<int> ids, flat;  // in the spectrum, set aside
  for (std::size_t s = 0; s < segments.size(); ++s)
    (segments[s].is_flat && options.rules.has(Rule::kFlatSegments) ? flat : ids)
        .push_back(static_cast<int>(s));
  std::vector<int> classes;
  if (options.layering == Layering::kSpectral && k > 1)
    classes = spectral_classes(segments, ids, k, options, result);
  if (!classes.empty()) {
    for (std::size_t i = 0; i < ids.size(); ++i) result.layer[ids[i]] = 1 + classes[i];
    place_flat(segments, flat, ids, classes, k, result.layer);
    if (options.rules.has(Rule::kElementLayers))
      settle_kinds(segments, segments, std::vector<int>(result.layer), options.layers,
                   result.layer);
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
