// Based on: Blanco, Rai, "nanoflann: a C++ header-only fork of FLANN, a library for nearest
// neighbor search with kd-trees", 2014.
//
// dis = η ‖h − h'‖₂ + ‖v − v'‖₁ / (‖v‖₁ + ‖v'‖₁) is not a norm of differences, so a kd-tree cannot
// search it. Near each other, the second term is tanh(½ |ln ‖v‖₁ − ln ‖v'‖₁|) for equal proportions
// and half the difference of the proportions for equal sums. The tree therefore holds η times the
// histogram's first principal components, ½ ln ‖v‖₁ and the halved proportions of v, and for kinds
// the context and which element it is; it returns
// three times as many as are wanted, which are sorted by dis itself.
//
// Differs: the paper compares all pairs.
//
// Notation: h histogram, v eigenvalues.
#include "clustering_neighbours.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <nanoflann.hpp>
#include <utility>

#include "core/parallel.h"

namespace colod {
namespace {

constexpr int kComponents = 6;  // of the histogram
constexpr int kDimensions = kComponents + 8;
constexpr int kCandidates = 3;  // times what is wanted
constexpr int kLeaf = 20;
constexpr double kApart = 3;        // between elements of different kinds
constexpr double kLeastSum = 1e-6;  // m², for logarithms

using Histogram = Eigen::Matrix<double, 64, 1>;
using Point = std::array<double, kDimensions>;

double sane(double x) { return std::isfinite(x) ? x : 0; }

Histogram histogram_of(const Descriptor& d) {
  Histogram h;
  for (int b = 0; b < 64; ++b) h[b] = sane(d.d2[b]);
  return h;
}

// The directions in which the histograms differ most, a column each.
Eigen::Matrix<double, 64, kComponents> principal_components(
    const std::vector<Descriptor>& segments) {
  Histogram mean = Histogram::Zero();
  for (const Descriptor& d : segments) mean += histogram_of(d);
  mean /= static_cast<double>(segments.size());
  Eigen::Matrix<double, 64, 64> covariance = Eigen::Matrix<double, 64, 64>::Zero();
  for (const Descriptor& d : segments) {
    const Histogram h = histogram_of(d) - mean;
    covariance.selfadjointView<Eigen::Lower>().rankUpdate(h);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);
  return solver.eigenvectors().rightCols<kComponents>();
}

struct Cloud {
  std::vector<Point> points;

  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t d) const { return points[i][d]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

Cloud embed(const std::vector<Descriptor>& segments, double eta, bool is_by_kind) {
  const auto components = principal_components(segments);
  Cloud cloud;
  cloud.points.resize(segments.size());
  parallel_for(
      segments.size(),
      [&](std::size_t i) {
        const Descriptor& d = segments[i];
        const Eigen::Matrix<double, kComponents, 1> shape =
            components.transpose() * histogram_of(d);
        Point& p = cloud.points[i];
        for (int c = 0; c < kComponents; ++c) p[c] = eta * kDensity * shape[c];
        const double sum = std::max(kLeastSum, sane(d.eigenvalues.lpNorm<1>()));
        p[kComponents] = 0.5 * std::log(sum);
        for (int a = 0; a < 3; ++a) {
          p[kComponents + 1 + a] = 0.5 * sane(d.eigenvalues[a]) / sum;
          p[kComponents + 4 + a] = is_by_kind ? sane(d.context[a]) : 0;
        }
        p[kComponents + 7] = is_by_kind && has_kind(d) ? kApart * static_cast<int>(d.kind) : 0;
      },
      64);
  return cloud;
}

/// Of candidates the `count` most similar to i, ties by index; in rising order.
std::vector<int> most_similar(const std::vector<Descriptor>& segments, std::size_t i,
                              const std::vector<std::uint32_t>& candidates, int count, double eta,
                              Similarity similarity) {
  std::vector<std::pair<double, int>> near;  // −similarity, which
  for (const std::uint32_t j : candidates) {
    if (j == i) continue;
    const std::size_t a = std::min<std::size_t>(i, j), b = std::max<std::size_t>(i, j);
    const double s = similarity(segments[a], segments[b], eta);
    if (std::isfinite(s)) near.emplace_back(-s, static_cast<int>(j));
  }
  std::sort(near.begin(), near.end());
  if (std::ssize(near) > count) near.resize(count);
  std::vector<int> which;
  which.reserve(near.size());
  for (const auto& [distance, j] : near) which.push_back(j);
  std::sort(which.begin(), which.end());
  return which;
}

}  // namespace

std::vector<std::vector<int>> nearest_neighbours(const std::vector<Descriptor>& segments, int count,
                                                 double eta, Similarity similarity) {
  std::vector<std::vector<int>> result(segments.size());
  if (segments.size() < 2) return result;
  const Cloud cloud = embed(segments, eta, similarity == kind_similarity);
  using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud>,
                                                   Cloud, kDimensions, std::uint32_t>;
  Tree tree(kDimensions, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(kLeaf));
  tree.buildIndex();
  const std::size_t wanted = std::min<std::size_t>(segments.size(), kCandidates * count + 1);
  parallel_for(
      segments.size(),
      [&](std::size_t i) {
        std::vector<std::uint32_t> found(wanted);
        std::vector<double> squared(wanted);
        found.resize(tree.knnSearch(cloud.points[i].data(), wanted, found.data(), squared.data()));
        result[i] = most_similar(segments, i, found, count, eta, similarity);
      },
      32);
  return result;
}

}  // namespace colod
