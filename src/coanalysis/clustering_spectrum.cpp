// Based on: von Luxburg, "A tutorial on spectral clustering", 2007; implicitly restarted Lanczos by
// Spectra (Lehoucq, Sorensen, "Deflation techniques for an implicitly restarted Arnoldi iteration",
// 1996).
//
// L = I − A with A = D^-1/2 S D^-1/2: the smallest eigenvalues of L are the largest of A, which is
// what Lanczos finds fast. Up to 400 segments all eigenvalues by Householder; up to 3,000 Lanczos
// on the dense A; beyond, S keeps the 50 most similar segments of each (made symmetric) and is
// sparse.
//
// Differs: the paper has the dense form only.
//
// Notation: clustering.cpp.
#include "clustering_spectrum.h"

#include <Spectra/MatOp/DenseSymMatProd.h>
#include <Spectra/MatOp/SparseSymMatProd.h>
#include <Spectra/SymEigsSolver.h>

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "clustering_neighbours.h"
#include "core/parallel.h"

namespace colod {
namespace {

constexpr int kAllEigenvalues = 400, kDense = 3000, kNeighbours = 50;
constexpr int kReported = 10, kSolverRestarts = 300;
constexpr double kConverged = 1e-11;

using Sparse = Eigen::SparseMatrix<double>;

Eigen::MatrixXd dense_affinity(const std::vector<Descriptor>& segments, double eta,
                               Similarity similarity) {
  const auto n = static_cast<Eigen::Index>(segments.size());
  Eigen::MatrixXd a(n, n);
  parallel_for(segments.size(), [&](std::size_t j) {
    for (std::size_t i = 0; i < segments.size(); ++i) {
      const double s = similarity(segments[std::min(i, j)], segments[std::max(i, j)], eta);
      a(i, j) = i == j ? 1 : std::isfinite(s) ? s : 0;
    }
  });
  const Eigen::VectorXd scale = a.colwise().sum().cwiseSqrt().cwiseInverse();  // sums are ≥ 1
  for (Eigen::Index j = 0; j < n; ++j) a.col(j) = scale.cwiseProduct(a.col(j)) * scale[j];
  return a;  // in place: a second one would be as large
}

/// Per segment those behind it that it names or that name it, rising: an edge counts when either
/// end names the other, and stands with the first of both.
std::vector<std::vector<int>> edges_of(std::vector<std::vector<int>> near) {
  std::vector<std::vector<int>> edges(near.size());
  const auto names = [&](std::size_t i, std::size_t j) {
    return std::binary_search(near[i].begin(), near[i].end(), static_cast<int>(j));
  };
  for (std::size_t i = 0; i < near.size(); ++i)
    for (const int named : near[i]) {
      const auto j = static_cast<std::size_t>(named);
      if (i < j)
        edges[i].push_back(named);
      else if (!names(j, i))
        edges[j].push_back(static_cast<int>(i));
    }
  near = {};
  for (std::vector<int>& own : edges) std::sort(own.begin(), own.end());
  return edges;
}

/// S → D^-1/2 S D^-1/2 in its place; of both the lower half.
void normalise(Sparse& s) {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(s.cols());
  for (Eigen::Index i = 0; i < s.cols(); ++i)
    for (Sparse::InnerIterator e(s, i); e; ++e) {
      sums[e.row()] += e.value();
      if (e.row() != i) sums[i] += e.value();
    }
  const Eigen::VectorXd scale = sums.cwiseSqrt().cwiseInverse();
  for (Eigen::Index i = 0; i < s.cols(); ++i)
    for (Sparse::InnerIterator e(s, i); e; ++e)
      e.valueRef() = scale[e.row()] * e.value() * scale[i];
}

/// The lower half with the diagonal, which is all that the product asks for.
Sparse sparse_affinity(const std::vector<Descriptor>& segments, double eta, Similarity similarity) {
  const auto n = static_cast<Eigen::Index>(segments.size());
  std::vector<std::vector<int>> edges =
      edges_of(nearest_neighbours(segments, kNeighbours, eta, similarity));
  Eigen::Index entries = n;
  for (const std::vector<int>& own : edges) entries += std::ssize(own);
  Sparse s(n, n);
  s.reserve(entries);
  for (Eigen::Index i = 0; i < n; ++i) {
    s.startVec(i);
    s.insertBack(i, i) = 1;
    for (const int j : std::exchange(edges[static_cast<std::size_t>(i)], {})) s.insertBack(j, i);
  }
  s.finalize();
  parallel_for(
      segments.size(),
      [&](std::size_t i) {
        for (Sparse::InnerIterator e(s, static_cast<Eigen::Index>(i)); e; ++e)
          if (e.row() != e.col())
            e.valueRef() =
                similarity(segments[i], segments[static_cast<std::size_t>(e.row())], eta);
      },
      32);
  normalise(s);
  return s;
}

// From A's eigenpairs, falling.
Spectrum spectrum_of(const Eigen::VectorXd& falling, const Eigen::MatrixXd& vectors, int k) {
  Spectrum spectrum;
  if (falling.size() < k) return spectrum;
  for (Eigen::Index i = 0; i < std::min<Eigen::Index>(falling.size(), std::max(k, kReported)); ++i)
    spectrum.values.push_back(std::max(0.0, 1 - falling[i]));
  spectrum.vectors = vectors.leftCols(k);
  for (int c = 0; c < k; ++c) {
    // The sign is free: of the entries about as large as the largest the first is positive.
    const double most = spectrum.vectors.col(c).cwiseAbs().maxCoeff();
    Eigen::Index first = 0;
    while (std::abs(spectrum.vectors(first, c)) < most * (1 - 1e-6)) ++first;
    if (spectrum.vectors(first, c) < 0) spectrum.vectors.col(c) *= -1;
  }
  return spectrum;
}

template <class Product>
Spectrum lanczos(Product product, Eigen::Index n, int k, std::uint64_t seed) {
  const auto wanted = std::min<Eigen::Index>(n - 1, std::max(k + 1, kReported));
  const auto basis = std::min<Eigen::Index>(n, 4 * wanted + 20);
  Spectra::SymEigsSolver<Product> solver(product, wanted, basis);
  std::mt19937_64 random(seed);
  Eigen::VectorXd first(n);
  for (double& x : first) x = static_cast<double>(random() >> 11) * 0x1p-53 - 0.5;
  solver.init(first.data());
  solver.compute(Spectra::SortRule::LargestAlge, kSolverRestarts, kConverged);
  if (solver.info() != Spectra::CompInfo::Successful) return {};
  return spectrum_of(solver.eigenvalues(), solver.eigenvectors(), k);
}

}  // namespace

Spectrum smallest_spectrum(const std::vector<Descriptor>& segments, int k, double eta,
                           Similarity similarity, std::uint64_t seed) {
  const auto n = static_cast<Eigen::Index>(segments.size());
  if (n > kDense && n > 4 * k) {
    const Sparse a = sparse_affinity(segments, eta, similarity);
    return lanczos(Spectra::SparseSymMatProd<double>(a), n, k, seed);
  }
  const Eigen::MatrixXd a = dense_affinity(segments, eta, similarity);
  if (n > kAllEigenvalues && n > 4 * k)
    return lanczos(Spectra::DenseSymMatProd<double>(a), n, k, seed);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(a);
  if (solver.info() != Eigen::Success) return {};
  return spectrum_of(solver.eigenvalues().reverse(), solver.eigenvectors().rowwise().reverse(), k);
}

}  // namespace colod
