// Based on: labels of a height field by nearest heights and a Potts prior (Boykov, Veksler & Zabih,
// IEEE PAMI 23(11), 2001), by iterated conditional modes. Differs: – . Notation: –
#include "labels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <tuple>

#include "parameters.h"

namespace colod::relief {
namespace {

using namespace parameters::relief;

constexpr int kOpen = -2;  // no label yet

/// Cells of `is_in` that a square of `side` cells within it covers.
std::vector<char> opened(int columns, int rows, const std::vector<char>& is_in, int side) {
  const int wide = columns + 1;
  std::vector<int> sum(wide * (rows + 1), 0), cover(wide * (rows + 1), 0);
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c)
      sum[(r + 1) * wide + c + 1] = is_in[r * columns + c] + sum[r * wide + c + 1] +
                                    sum[(r + 1) * wide + c] - sum[r * wide + c];
  for (int r = 0; r + side <= rows; ++r)
    for (int c = 0; c + side <= columns; ++c) {
      const int a = r * wide + c, b = a + side * wide;
      if (sum[b + side] - sum[b] - sum[a + side] + sum[a] < side * side) continue;
      ++cover[a], --cover[a + side], --cover[b], ++cover[b + side];
    }
  std::vector<char> is_covered(is_in.size());
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      int& own = cover[r * wide + c];
      own += (c > 0 ? cover[r * wide + c - 1] : 0) + (r > 0 ? cover[(r - 1) * wide + c] : 0) -
             (c > 0 && r > 0 ? cover[(r - 1) * wide + c - 1] : 0);
      is_covered[r * columns + c] = own > 0;
    }
  return is_covered;
}

/// What a patch has around it.
struct Shape {
  double border = 0, at_ground = 0, at_nothing = 0;  // metres
  double half_width = 0;                             // metres, where it is widest, in whole cells
};

class Labeller {
 public:
  Labeller(const Field& field, const Ground& ground, Patches patches, const Scales& scales)
      : f_(field),
        ground_(ground),
        patches_(std::move(patches.patches)),
        label_(std::move(patches.patch_of_cell)),
        noise_(scales.noise),
        span_(scales.span),
        tolerance_(scales.tolerance),
        slide_(scales.raster > 0 ? kRasterSlide * scales.raster
                                 : std::max(kStrip, kSlideSpan * span_)) {}

  Labels squared() {
    square();
    return {std::move(label_), std::move(patches_)};
  }

  Labels run() {
    for (int i = 0; i < f_.size(); ++i)
      if (label_[i] < 0) label_[i] = ground_.is_ground[i] ? kOutside : kOpen;
    open_outside();
    drop_clutter();
    spread(true);
    for (int round = 0; round < kSmoothings; ++round) smooth();
    square();
    drop_islands();
    return {std::move(label_), std::move(patches_)};
  }

 private:
  double height(int label, int i) const {
    return label == kOutside ? ground_.height[i] : patches_[label].height(f_.center(i) - f_.origin);
  }

  /// What is not seen and reached from the grid's edge is outside; other holes stay open.
  void open_outside() {
    std::vector<int> open;
    const auto visit = [&](int i) {
      if (f_.has(i) || label_[i] == kOutside) return;
      label_[i] = kOutside;
      open.push_back(i);
    };
    for (int i = 0; i < f_.size(); ++i) {
      const auto around = f_.beside(i);
      if (std::any_of(around.begin(), around.end(), [](int j) { return j < 0; })) visit(i);
    }
    while (!open.empty()) {
      const int i = open.back();
      open.pop_back();
      for (const int j : f_.beside(i))
        if (j >= 0) visit(j);
    }
  }

  std::vector<Shape> shapes() const {
    std::vector<Shape> shapes(patches_.size());
    std::vector<double> depth(f_.size(), 0);
    for (const bool is_forward : {true, false})
      for (int k = 0; k < f_.size(); ++k) {
        const int i = is_forward ? k : f_.size() - 1 - k;
        if (label_[i] < 0) continue;
        const auto around = f_.beside(i);
        double least = is_forward ? 1e300 : depth[i];
        for (const int side : is_forward ? std::array{0, 2} : std::array{1, 3}) {
          const int j = around[side];
          least = std::min(least, j >= 0 && label_[j] == label_[i] ? depth[j] + f_.cell : f_.cell);
        }
        depth[i] = least;
        if (!is_forward)
          shapes[label_[i]].half_width = std::max(shapes[label_[i]].half_width, depth[i]);
      }
    for (int i = 0; i < f_.size(); ++i) {
      if (label_[i] < 0) continue;
      for (const int j : f_.beside(i)) {
        const int other = j < 0 ? kOutside : label_[j];
        if (other == label_[i]) continue;
        Shape& s = shapes[label_[i]];
        s.border += f_.cell;
        s.at_ground += j >= 0 && f_.has(j) && other < 0 ? f_.cell : 0;
        s.at_nothing += j < 0 || !f_.has(j) ? f_.cell : 0;
      }
    }
    return shapes;
  }

  /// Patches that are none: too small, or the side of a melted wall (their neighbours take them),
  /// crowns and cars beside the building, and strips of what stands next door (they are outside).
  void drop_clutter() {
    const std::vector<Shape> shape = shapes();
    double total = 0;
    for (const Patch& p : patches_) total += p.area;
    std::vector<int> becomes(patches_.size());
    for (std::size_t a = 0; a < patches_.size(); ++a) {
      const Patch& p = patches_[a];
      const Shape& s = shape[a];
      const bool is_rough = p.residual > std::max(kRough * noise_, kLeastRough);
      const double strip = std::max(kStrip, kStripCells * f_.cell);
      const bool is_strip = s.half_width < strip && s.at_nothing > kStripShare * s.border;
      const bool is_minor = p.area < kMinor * total;
      becomes[a] = static_cast<int>(a);
      if (is_strip && p.area < kStripArea * total) becomes[a] = kOutside;
      if (is_minor && is_rough) becomes[a] = s.at_ground > 0.5 * s.border ? kOutside : kOpen;
      const bool is_slide = p.slope.norm() > kSlide && s.half_width < slide_;
      const bool is_speck = p.area < kLeastPatch * span_ * span_ || s.half_width < kThin;
      if ((is_slide || is_speck) && becomes[a] >= 0) becomes[a] = kOpen;
    }
    if (std::none_of(becomes.begin(), becomes.end(), [](int b) { return b >= 0; })) return;
    for (int& l : label_)
      if (l >= 0) l = becomes[l];
  }

  /// Within so many cells of the grid's edge, beyond which all is outside.
  bool is_at_edge(int i, int cells) const {
    const int c = i % f_.columns, r = i / f_.columns;
    return std::min(std::min(c, f_.columns - 1 - c), std::min(r, f_.rows - 1 - r)) < cells;
  }

  /// Open cells are taken from their labelled neighbours, where that fits their height best first.
  void spread(bool is_outside_spread) {
    using Step = std::tuple<double, int, int>;  // cost, cell, label
    std::priority_queue<Step, std::vector<Step>, std::greater<>> steps;
    const auto reach = [&](double cost, int i, int label) {
      const double off = f_.has(i) ? std::abs(f_.height[i] - height(label, i)) : 0;
      steps.push({cost + f_.cell + off, i, label});
    };
    const auto go_on = [&](double cost, int i) {
      for (const int j : f_.beside(i))
        if (j >= 0 && label_[j] == kOpen) reach(cost, j, label_[i]);
    };
    for (int i = 0; i < f_.size(); ++i)
      if (label_[i] >= 0 || (label_[i] == kOutside && is_outside_spread)) go_on(0, i);
    while (!steps.empty()) {
      const auto [cost, i, label] = steps.top();
      steps.pop();
      if (label_[i] != kOpen) continue;
      label_[i] = label;
      go_on(cost, i);
    }
    for (int& l : label_)
      if (l == kOpen) l = kOutside;
  }

  /// Each cell takes the label that its height and its eight neighbours ask for.
  void smooth() {
    std::vector<int> next = label_;
    for (int r = 1; r + 1 < f_.rows; ++r)
      for (int c = 1; c + 1 < f_.columns; ++c) {
        const int i = r * f_.columns + c;
        std::array<int, 8> around;
        for (int k = 0, at = 0; k < 9; ++k)
          if (k != 4) around[at++] = label_[i + (k / 3 - 1) * f_.columns + k % 3 - 1];
        double least = 1e300;
        const auto weigh = [&](int label) {
          const double off = f_.has(i) ? (f_.height[i] - height(label, i)) / noise_ : 0;
          const double cost = std::min(off * off, kMostOff) +
                              static_cast<double>(std::count_if(around.begin(), around.end(),
                                                                [&](int l) { return l != label; }));
          if (cost < least - 1e-9) least = cost, next[i] = label;
        };
        weigh(label_[i]);
        for (const int l : around) weigh(l);
      }
    label_.swap(next);
  }

  /// What no square as wide as what borders may leave their lines fits into goes to its neighbours:
  /// spikes, slots, and roofs and wings too thin to be any.
  void square() {
    const int side = std::max(1, static_cast<int>(std::lround(2 * tolerance_ / f_.cell)));
    std::vector<char> is_in(f_.size());
    const auto mark = [&](const auto& is) {
      for (int i = 0; i < f_.size(); ++i) is_in[i] = is(label_[i]);
      return opened(f_.columns, f_.rows, is_in, side);
    };
    const std::vector<char> is_outside = mark([](int l) { return l == kOutside; });
    for (int i = 0; i < f_.size(); ++i)
      if (label_[i] == kOutside && !is_outside[i] && !is_at_edge(i, side)) label_[i] = kOpen;
    spread(false);
    const std::vector<char> is_inside = mark([](int l) { return l >= 0; });
    for (int i = 0; i < f_.size(); ++i)
      if (label_[i] >= 0 && !is_inside[i]) label_[i] = kOutside;
    for (int p = 0; p < static_cast<int>(patches_.size()); ++p) {
      const std::vector<char> is_own = mark([p](int l) { return l == p; });
      for (int i = 0; i < f_.size(); ++i)
        if (label_[i] == p && !is_own[i]) label_[i] = kOpen;
    }
    spread(false);
  }

  struct Island {
    int cells = 0;
    double rise = 0;  ///< metres: sum over its cells
    double mean_rise() const { return rise / cells; }
  };

  /// Which connected part of the building each cell is of; −1: none.
  std::vector<int> find_islands(std::vector<Island>& islands) const {
    std::vector<int> island(f_.size(), -1);
    for (int seed = 0; seed < f_.size(); ++seed) {
      if (label_[seed] < 0 || island[seed] >= 0) continue;
      const int id = static_cast<int>(islands.size());
      std::vector<int> open{seed};
      island[seed] = id;
      islands.emplace_back();
      while (!open.empty()) {
        const int i = open.back();
        open.pop_back();
        ++islands.back().cells;
        islands.back().rise += height(label_[i], i) - ground_.height[i];
        for (const int j : f_.beside(i))
          if (j >= 0 && label_[j] >= 0 && island[j] < 0) island[j] = id, open.push_back(j);
      }
    }
    return island;
  }

  /// Parts that stand apart and are small, or so low that they are no building, are not of it.
  void drop_islands() {
    std::vector<Island> islands;
    const std::vector<int> island = find_islands(islands);
    if (islands.empty()) return;
    const Island& main =
        *std::max_element(islands.begin(), islands.end(),
                          [](const Island& a, const Island& b) { return a.cells < b.cells; });
    const auto is_dropped = [&](const Island& i) {
      const bool is_low =
          i.mean_rise() < kLowIsland && i.mean_rise() < kLowIslandShare * main.mean_rise();
      return i.cells < kIsland * main.cells || (is_low && &i != &main);
    };
    for (int i = 0; i < f_.size(); ++i)
      if (island[i] >= 0 && is_dropped(islands[island[i]])) label_[i] = kOutside;
  }

  const Field& f_;
  const Ground& ground_;
  std::vector<Patch> patches_;
  std::vector<int> label_;
  double noise_, span_, tolerance_;
  double slide_;  // metres: half of the width of what may be the side of a wall
};

}  // namespace

Labels label_field(const Field& field, const Ground& ground, Patches patches,
                   const Scales& scales) {
  return Labeller(field, ground, std::move(patches), scales).run();
}

Labels square_labels(const Field& field, const Ground& ground, Labels labels,
                     const Scales& scales) {
  return Labeller(field, ground, {std::move(labels.patches), std::move(labels.of_cell)}, scales)
      .squared();
}

}  // namespace colod::relief
