// Based on: region merging for piecewise smooth functions (Koepfler, Lopez & Morel, SIAM J. Numer.
// Anal. 31(1), 1994) with the description length of planes (Verdie, Lafarge & Alliez, ACM TOG
// 34(3), 2015). Differs: the price of a patch is in square metres of noise: bumps that are metres
// wide count once, however many cells they cover. Notation: SSE, the sum of squared errors.
#include "patches.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>
#include <tuple>

#include "parameters.h"

namespace colod::relief {
namespace {

using namespace parameters::relief;

/// Sums from which a patch's plane and its SSE follow.
struct Sums {
  double n = 0, z = 0, zz = 0;
  Vec2 p = Vec2::Zero(), pz = Vec2::Zero();
  Eigen::Matrix2d pp = Eigen::Matrix2d::Zero();

  void add(const Vec2& q, double height) {
    n += 1, z += height, zz += height * height;
    p += q, pz += height * q, pp += q * q.transpose();
  }
  void add(const Sums& o) {
    n += o.n, z += o.z, zz += o.zz;
    p += o.p, pz += o.pz, pp += o.pp;
  }
  Patch fit(double cell) const {
    const Vec2 mean = p / n;
    const Eigen::Matrix2d c =
        pp - n * mean * mean.transpose() + 0.02 * n * cell * cell * Eigen::Matrix2d::Identity();
    const Vec2 b = pz - z * mean;
    Patch out;
    out.slope = c.inverse() * b;
    out.level = z / n - out.slope.dot(mean);
    out.area = n * cell * cell;
    out.residual = std::sqrt(std::max(0.0, zz - z * z / n - out.slope.dot(b)) / n);
    return out;
  }
  double sse(double cell) const {
    const double r = fit(cell).residual;
    return n * r * r;
  }
};

struct Offer {
  double price;
  int a, b, stamp_a, stamp_b;
  friend bool operator>(const Offer& x, const Offer& y) {
    return std::tie(x.price, x.a, x.b) > std::tie(y.price, y.a, y.b);
  }
};

class Merger {
 public:
  Merger(const Field& field, const std::vector<char>& is_roof, double noise, double span)
      : f_(field), variance_(noise * noise), price_(kPatchPrice * span * span) {
    start(is_roof);
    for (int a = 0; a < static_cast<int>(sums_.size()); ++a)
      for (const auto& [b, length] : beside_[a])
        if (a < b) offer(a, b, length);
  }

  void run() {
    while (!offers_.empty()) {
      const Offer o = offers_.top();
      offers_.pop();
      if (stamp_[o.a] != o.stamp_a || stamp_[o.b] != o.stamp_b) continue;
      if (o.price > 1) break;
      join(o.a, o.b);
    }
  }

  Patches result() const {
    Patches out;
    std::vector<int> id(sums_.size(), -1);
    for (std::size_t a = 0; a < sums_.size(); ++a)
      if (stamp_[a] >= 0) {
        id[a] = static_cast<int>(out.patches.size());
        out.patches.push_back(sums_[a].fit(f_.cell));
      }
    for (const int seed : seed_of_cell_)
      out.patch_of_cell.push_back(seed < 0 ? -1 : id[root(seed)]);
    return out;
  }

 private:
  /// Cells that show one face are one from the start.
  void start(const std::vector<char>& is_roof) {
    std::map<int, int> seed_of_face;
    seed_of_cell_.assign(f_.size(), -1);
    for (int i = 0; i < f_.size(); ++i) {
      if (!is_roof[i]) continue;
      const auto [at, is_new] =
          seed_of_face.try_emplace(f_.face[i], static_cast<int>(sums_.size()));
      if (is_new) sums_.emplace_back();
      seed_of_cell_[i] = at->second;
      sums_[at->second].add(f_.center(i) - f_.origin, f_.height[i]);
    }
    beside_.resize(sums_.size());
    stamp_.assign(sums_.size(), 0);
    parent_.assign(sums_.size(), -1);
    for (int i = 0; i < f_.size(); ++i)
      for (const int j : {f_.beside(i)[1], f_.beside(i)[3]})
        if (j >= 0 && seed_of_cell_[i] >= 0 && seed_of_cell_[j] >= 0 &&
            seed_of_cell_[i] != seed_of_cell_[j]) {
          const int a = seed_of_cell_[i], b = seed_of_cell_[j];
          beside_[a][b] += f_.cell, beside_[b][a] += f_.cell;
        }
  }

  int root(int a) const {
    while (parent_[a] >= 0) a = parent_[a];
    return a;
  }

  /// Errors that joining adds, in units of what the patch and its border cost.
  void offer(int a, int b, double length) {
    Sums both = sums_[a];
    both.add(sums_[b]);
    const double errors = (both.sse(f_.cell) - sums_[a].sse(f_.cell) - sums_[b].sse(f_.cell)) *
                          f_.cell * f_.cell / variance_;
    offers_.push({errors / (price_ + kBorderPrice * length), a, b, stamp_[a], stamp_[b]});
  }

  void join(int a, int b) {
    if (beside_[a].size() < beside_[b].size()) std::swap(a, b);
    sums_[a].add(sums_[b]);
    parent_[b] = a;
    ++stamp_[a], stamp_[b] = -1;
    beside_[a].erase(b);
    for (const auto& [c, length] : beside_[b]) {
      if (c == a) continue;
      beside_[a][c] += length;
      beside_[c].erase(b);
      beside_[c][a] = beside_[a][c];
    }
    beside_[b].clear();
    for (const auto& [c, length] : beside_[a]) offer(std::min(a, c), std::max(a, c), length);
  }

  const Field& f_;
  double variance_, price_;
  std::vector<int> seed_of_cell_;
  std::vector<Sums> sums_;
  std::vector<std::map<int, double>> beside_;
  std::vector<int> stamp_, parent_;  // stamp −1: joined to its parent
  std::priority_queue<Offer, std::vector<Offer>, std::greater<>> offers_;
};

}  // namespace

Patches find_patches(const Field& field, const std::vector<char>& is_roof, double noise,
                     double span) {
  Merger merger(field, is_roof, noise, span);
  merger.run();
  return merger.result();
}

}  // namespace colod::relief
