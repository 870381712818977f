// Based on: – . Differs: – . Notation: a and b are two roofs that touch, a the smaller one.
#include "joins.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "parameters.h"

namespace colod::relief {
namespace {

using namespace parameters::relief;

/// Of a border between two roofs, in sides of cells.
struct Seam {
  int all = 0, parted = 0;
};

class Joiner {
 public:
  Joiner(const Field& field, const Scales& scales, Labels& labels)
      : f_(field), s_(scales), labels_(labels), cells_(labels.patches.size(), 0) {
    for (const int l : labels_.of_cell)
      if (l >= 0) ++cells_[l];
  }

  /// The smallest first; each join changes the others' borders.
  void run() {
    while (const auto pair = next()) {
      const auto [a, b] = *pair;
      for (int& l : labels_.of_cell)
        if (l == a) l = b;
      cells_[b] += cells_[a], cells_[a] = 0;
    }
  }

 private:
  double height(int label, int i) const {
    return labels_.patches[label].height(f_.center(i) - f_.origin);
  }

  bool is_parted(int a, int b, int i, int j) const {
    const double step = std::abs(height(a, i) + height(a, j) - height(b, i) - height(b, j)) / 2;
    const double tilt = (labels_.patches[a].slope - labels_.patches[b].slope).norm();
    return step >= least_step(s_.noise) ||
           (tilt >= kLeastCrease && step < kCreaseReach * s_.tolerance * tilt);
  }

  std::map<std::pair<int, int>, Seam> seams() const {
    std::map<std::pair<int, int>, Seam> seams;
    const std::vector<int>& label = labels_.of_cell;
    for (int i = 0; i < f_.size(); ++i)
      for (const int j : {f_.beside(i)[1], f_.beside(i)[3]}) {
        if (j < 0 || label[i] < 0 || label[j] < 0 || label[i] == label[j]) continue;
        Seam& seam = seams[std::minmax(label[i], label[j])];
        ++seam.all, seam.parted += is_parted(label[i], label[j], i, j);
      }
    return seams;
  }

  /// Root mean square metres between the planes, over a's cells.
  double distance(int a, int b) const {
    double sum = 0;
    for (int i = 0; i < f_.size(); ++i)
      if (labels_.of_cell[i] == a) sum += std::pow(height(a, i) - height(b, i), 2);
    return std::sqrt(sum / cells_[a]);
  }

  std::optional<std::pair<int, int>> next() const {
    std::optional<std::pair<int, int>> best;
    for (const auto& [pair, seam] : seams()) {
      if (seam.parted > kParted * seam.all) continue;
      auto [a, b] = pair;
      if (cells_[a] > cells_[b]) std::swap(a, b);
      if (best && cells_[best->first] <= cells_[a]) continue;
      if (distance(a, b) <= least_step(s_.noise)) best = {a, b};
    }
    return best;
  }

  const Field& f_;
  const Scales& s_;
  Labels& labels_;
  std::vector<int> cells_;  // per patch
};

}  // namespace

double least_step(double noise) { return std::max(kLeastStep, kStepNoise * noise); }

void join_borderless(const Field& field, const Scales& scales, Labels& labels) {
  Joiner(field, scales, labels).run();
}

}  // namespace colod::relief
