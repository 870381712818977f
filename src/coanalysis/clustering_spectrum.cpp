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
  return scale.asDiagonal() * a * scale.asDiagonal();
}

using Columns = std::vector<std::vector<Neighbour>>;

bool is_before(const Neighbour& a, const Neighbour& b) { return a.index < b.index; }

// An edge counts when either end names the other: each column gets those that name it and that it
// does not name, behind its own. Columns are sorted by index.
void add_reverse_edges(Columns& columns) {
  std::vector<std::size_t> own(columns.size());
  for (std::size_t i = 0; i < columns.size(); ++i) {
    std::sort(columns[i].begin(), columns[i].end(), is_before);
    own[i] = columns[i].size();
  }
  for (std::size_t i = 0; i < columns.size(); ++i)
    for (std::size_t e = 0; e < own[i]; ++e) {
      const Neighbour edge = columns[i][e], back{static_cast<int>(i), edge.similarity};
      std::vector<Neighbour>& other = columns[edge.index];
      const auto end = other.begin() + static_cast<std::ptrdiff_t>(own[edge.index]);
      if (!std::binary_search(other.begin(), end, back, is_before)) other.push_back(back);
    }
  for (std::vector<Neighbour>& column : columns) std::sort(column.begin(), column.end(), is_before);
}

// Column by column, each let go of when it is in: at no time is all there twice.
Sparse sparse_affinity(const std::vector<Descriptor>& segments, double eta, Similarity similarity) {
  const auto n = static_cast<Eigen::Index>(segments.size());
  Columns columns = nearest_neighbours(segments, kNeighbours, eta, similarity);
  add_reverse_edges(columns);
  Eigen::Index entries = n;
  for (const std::vector<Neighbour>& column : columns) entries += std::ssize(column);
  Sparse s(n, n);
  s.reserve(entries);
  for (Eigen::Index i = 0; i < n; ++i) {
    std::vector<Neighbour> column = std::exchange(columns[static_cast<std::size_t>(i)], {});
    const Neighbour self{static_cast<int>(i), 1.0};
    column.insert(std::lower_bound(column.begin(), column.end(), self, is_before), self);
    s.startVec(i);
    for (const Neighbour& near : column) s.insertBack(near.index, i) = near.similarity;
  }
  s.finalize();
  const Eigen::VectorXd scale = (s * Eigen::VectorXd::Ones(n)).cwiseSqrt().cwiseInverse();
  for (Eigen::Index i = 0; i < n; ++i)
    for (Sparse::InnerIterator entry(s, i); entry; ++entry)
      entry.valueRef() = scale[entry.row()] * entry.value() * scale[i];
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
