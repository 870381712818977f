// Based on: maximum-sum rectangles (Bentley, "Programming Pearls", column 8, in two dimensions) of
// the squares that a block explains, and the description length of patches.cpp. Differs: – .
// Notation: –
#include "blocks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "core/flat.h"
#include "parameters.h"

namespace colod::relief {
namespace {

using namespace parameters::relief;

/// Half-open: columns and rows of the grid.
struct Rectangle {
  int left = 0, right = 0, bottom = 0, top = 0;
  int columns() const { return right - left; }
  int rows() const { return top - bottom; }
};

/// Cells that stand off one roof to one side, connected.
struct Stand {
  int label = 0;
  double sign = 1;
  std::vector<int> cells;
};

class Blocks {
 public:
  Blocks(const Field& field, const Scales& scales, Labels& labels)
      : f_(field), s_(scales), labels_(labels), off_(field.size(), 0), is_done_(field.size(), 0) {
    for (int i = 0; i < f_.size(); ++i)
      if (labels_.of_cell[i] >= 0 && f_.has(i))
        off_[i] = f_.height[i] - height(labels_.patches[labels_.of_cell[i]], i);
  }

  void run() {
    const std::size_t most = labels_.patches.size() + kMostBlocks;
    for (int seed = 0; seed < f_.size() && labels_.patches.size() < most; ++seed)
      if (!is_done_[seed] && std::abs(off_[seed]) > least()) raise(stand_from(seed));
  }

 private:
  double height(const Patch& p, int i) const { return p.height(f_.center(i) - f_.origin); }
  double least() const { return std::max(kLeastStep, kBlockNoise * s_.noise); }

  Stand stand_from(int seed) {
    Stand stand{labels_.of_cell[seed], off_[seed] > 0 ? 1.0 : -1.0, {seed}};
    is_done_[seed] = 1;
    for (std::size_t k = 0; k < stand.cells.size(); ++k)
      for (const int j : f_.beside(stand.cells[k])) {
        if (j < 0 || is_done_[j] || labels_.of_cell[j] != stand.label) continue;
        if (stand.sign * off_[j] <= least()) continue;
        is_done_[j] = 1;
        stand.cells.push_back(j);
      }
    return stand;
  }

  Rectangle around(const Stand& stand) const {
    Rectangle box{f_.columns, 0, f_.rows, 0};
    for (const int i : stand.cells) {
      const int c = i % f_.columns, r = i / f_.columns;
      box.left = std::min(box.left, c), box.right = std::max(box.right, c + 1);
      box.bottom = std::min(box.bottom, r), box.top = std::max(box.top, r + 1);
    }
    return box;
  }

  /// Squares that a block of this height explains in a cell of the stand's roof; elsewhere none.
  double gain(const Stand& stand, double rise, int i) const {
    if (labels_.of_cell[i] != stand.label) return -1e6 * rise * rise;
    const double off = std::clamp(stand.sign * off_[i], -rise, rise);
    return off * off - (off - rise) * (off - rise);
  }

  /// Where a block of this height explains most.
  Rectangle best(const Stand& stand, double rise, const Rectangle& box, double& most) const {
    Rectangle found;
    most = 0;
    for (int bottom = box.bottom; bottom < box.top; ++bottom) {
      std::vector<double> sum(box.columns(), 0);
      for (int top = bottom; top < box.top; ++top) {
        double run = 0;
        int left = box.left;
        for (int c = box.left; c < box.right; ++c) {
          sum[c - box.left] += gain(stand, rise, top * f_.columns + c);
          if (run <= 0) run = 0, left = c;
          run += sum[c - box.left];
          if (run > most) most = run, found = {left, c + 1, bottom, top + 1};
        }
      }
    }
    return found;
  }

  /// The patch on top of the block: level, unless the roof's own slope is nearer.
  Patch top(const Stand& stand, const std::vector<int>& cells) const {
    const Patch& roof = labels_.patches[stand.label];
    std::optional<Patch> best;
    for (const double share : {0.0, 1.0}) {
      Patch patch = roof;
      patch.slope = share * roof.slope;
      std::vector<double> levels;
      for (const int i : cells)
        levels.push_back(f_.height[i] - patch.slope.dot(f_.center(i) - f_.origin));
      patch.level = median(levels);
      double sum = 0;
      for (const double level : levels) sum += (level - patch.level) * (level - patch.level);
      patch.area = static_cast<double>(cells.size()) * f_.cell * f_.cell;
      patch.residual = std::sqrt(sum / static_cast<double>(cells.size()));
      if (!best || patch.residual < kSloping * best->residual) best = patch;
    }
    return *best;
  }

  void raise(const Stand& stand) {
    std::vector<double> offs;
    for (const int i : stand.cells) offs.push_back(std::abs(off_[i]));
    const double rise = median(offs);
    double explained = 0;
    const Rectangle r = best(stand, rise, around(stand), explained);
    const int least_side = static_cast<int>(std::lround(2 * s_.tolerance / f_.cell));
    if (std::min(r.columns(), r.rows()) < least_side) return;
    const double price =
        kPatchPrice * s_.span * s_.span + kBorderPrice * 2 * (r.columns() + r.rows()) * f_.cell;
    if (explained * f_.cell * f_.cell < price * s_.noise * s_.noise) return;
    std::vector<int> cells, seen;
    for (int row = r.bottom; row < r.top; ++row)
      for (int c = r.left; c < r.right; ++c) {
        cells.push_back(row * f_.columns + c);
        if (f_.has(cells.back()) && !f_.is_steep[cells.back()]) seen.push_back(cells.back());
      }
    if (seen.size() < kSeenTop * cells.size()) return;  // a crest, or the side of a wall
    const Patch patch = top(stand, seen);
    if (patch.residual > kFlatTop * rise) return;
    for (const int i : cells) labels_.of_cell[i] = static_cast<int>(labels_.patches.size());
    labels_.patches.push_back(patch);
  }

  const Field& f_;
  const Scales& s_;
  Labels& labels_;
  std::vector<double> off_;  // metres of each cell over its roof
  std::vector<char> is_done_;
};

}  // namespace

void raise_blocks(const Field& field, const Scales& scales, Labels& labels) {
  Blocks(field, scales, labels).run();
}

}  // namespace colod::relief
