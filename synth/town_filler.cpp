// *Based on:* quarters of one kind each: houses with gardens, rows, perimeter blocks, courts,
// works.
//
// *Differs:* no --rules here.
//
// *Notation:* none.
#include "town_filler.h"

#include <algorithm>
#include <cmath>

namespace colod::synth {
namespace {

/// A side of a block that a building looks to.
enum class Side { kFront, kBack, kLeft, kRight };

class Filler {
 public:
  Filler(Random& random, int most) : r_(random), most_(most) {}

  BlockFill fill(BlockKind kind) {
    if (most_ <= 0) {
      plant(40, 2, 4.5);
      return out_;
    }
    switch (kind) {
      case BlockKind::kGardens:
        fill_gardens();
        break;
      case BlockKind::kRows:
        fill_rows();
        break;
      case BlockKind::kPerimeter:
        fill_perimeter();
        break;
      case BlockKind::kCourts:
        fill_courts();
        break;
      case BlockKind::kWorks:
        fill_works();
        break;
    }
    park(5 + r_.pick(5));
    return out_;
  }

 private:
  bool is_full() const { return static_cast<int>(out_.plots.size()) >= most_; }

  /// `along` and `back`: metres of its corner along the side, from its left end as one looks at it
  /// from the road, and from the road.
  void build(PlotKind kind, const DrawnPlan& drawn, Side side, double along, double back,
             std::uint64_t row = 0, double turn = 0) {
    if (is_full()) return;
    Plot plot;
    plot.kind = kind, plot.drawn = drawn, plot.row = row;
    plot.seed = static_cast<std::uint64_t>(r_.uniform(1, 1e15));
    switch (side) {
      case Side::kFront:
        plot.origin = {along, back}, plot.yaw = 0;
        break;
      case Side::kBack:
        plot.origin = {kBlockWidth - along, kBlockDepth - back}, plot.yaw = M_PI;
        break;
      case Side::kLeft:
        plot.origin = {back, kBlockDepth - along}, plot.yaw = -M_PI / 2;
        break;
      case Side::kRight:
        plot.origin = {kBlockWidth - back, along}, plot.yaw = M_PI / 2;
        break;
    }
    plot.yaw += turn;
    out_.plots.push_back(plot);
  }

  Vec2 place(Side side, double along, double back) const {
    return side == Side::kFront ? Vec2(along, back) : Vec2(kBlockWidth - along, kBlockDepth - back);
  }

  bool is_free(const Vec2& p, double around) const {
    return std::none_of(out_.plots.begin(), out_.plots.end(), [&](const Plot& plot) {
      const Vec2 q = plot.to_own(p);
      return q.x() > -around && q.y() > -around && q.x() < plot.drawn.width + around &&
             q.y() < plot.drawn.depth + around;
    });
  }

  void put(PropKind kind, const Vec2& at, double yaw, const Vec2& half, double height) {
    out_.props.push_back({kind, at, yaw, half, 0, height, static_cast<long>(r_.pick(1000000))});
  }

  /// A tree; some reach over roofs.
  void plant(int count, double least, double most) {
    for (int i = 0; i < count; ++i) {
      const double radius = r_.uniform(least, most);
      const Vec2 at(r_.uniform(1, kBlockWidth - 1), r_.uniform(1, kBlockDepth - 1));
      if (!is_free(at, r_.uniform(0.55, 1.1) * radius + 0.4)) continue;
      put(PropKind::kTree, at, 0, {radius, radius}, radius * r_.uniform(1.6, 3));
    }
  }

  /// A line of hedge or fence in pieces that follow the ground.
  void enclose(const Vec2& from, const Vec2& to) {
    constexpr double kPiece = 3;  // m
    const bool is_hedge = r_.chance(0.55);
    const double height = is_hedge ? r_.uniform(0.9, 2.1) : r_.uniform(1.0, 1.7);
    const double thick = is_hedge ? r_.uniform(0.35, 0.6) : r_.uniform(0.06, 0.13);
    const int pieces = std::max(1, static_cast<int>((to - from).norm() / kPiece));
    const Vec2 step = (to - from) / pieces;
    for (int i = 0; i < pieces; ++i) {
      const Vec2 at = from + (i + 0.5) * step;
      if (is_free(at, 1))
        put(is_hedge ? PropKind::kHedge : PropKind::kFence, at, std::atan2(step.y(), step.x()),
            {step.norm() / 2 + 0.05, thick}, height);
    }
  }

  /// Cars along the kerbs before and beside the block.
  void park(int cars) {
    for (int i = 0; i < cars; ++i) {
      const bool is_x = r_.chance(0.6);
      const double along = r_.uniform(3, (is_x ? kBlockWidth : kBlockDepth) - 3), kerb = 2.7;
      const Vec2 at = is_x ? Vec2(along, -kerb) : Vec2(-kerb, along);
      const bool is_near = std::any_of(out_.props.begin(), out_.props.end(), [&](const Prop& p) {
        return p.kind == PropKind::kCar && (p.at - at).norm() < 5.5;
      });
      if (!is_near) add_car(at, is_x ? 0 : M_PI / 2);
    }
  }

  void add_car(const Vec2& at, double yaw) {
    const bool is_van = r_.chance(0.15);
    put(PropKind::kCar, at, yaw + (r_.chance(0.5) ? M_PI : 0) + r_.uniform(-0.05, 0.05),
        {is_van ? 2.7 : r_.uniform(1.95, 2.3), is_van ? 1.0 : 0.9}, is_van ? 2.3 : 1.5);
  }

  void fill_gardens() {
    if (r_.chance(0.5)) out_.terrace = r_.uniform(1.1, 1.9);
    for (const Side side : {Side::kFront, Side::kBack}) {
      double along = r_.uniform(3, 5);
      while (!is_full()) {
        DrawnPlan drawn = draw_plan(r_, r_.uniform(0.1, 0.6));
        if (drawn.depth > 15) drawn = draw_rectangle(r_, 8, 14, 7, 12);
        if (along + drawn.width > kBlockWidth - 3) break;
        const double back = r_.uniform(4, 6.5);
        build(PlotKind::kDetached, drawn, side, along, back, 0, r_.uniform(-0.03, 0.03));
        if (r_.chance(0.4) && back + drawn.depth < kBlockDepth / 2 - 7) {
          const DrawnPlan shed = draw_rectangle(r_, 3, 6, 2.6, 3.6);
          build(PlotKind::kShed, shed, side, along + r_.uniform(0, 3),
                kBlockDepth / 2 - 1.5 - shed.depth, 0, r_.uniform(-0.1, 0.1));
        }
        const double gap = r_.chance(0.2) ? r_.uniform(2.2, 2.8) : r_.uniform(4, 9);
        along += drawn.width + gap;
        if (gap > 3.5)
          enclose(place(side, along - gap / 2, 0.6),
                  place(side, along - gap / 2, kBlockDepth / 2 - 1));
      }
      if (r_.chance(0.7)) enclose(place(side, 1, 0.5), place(side, kBlockWidth - 1, 0.5));
    }
    enclose({1, kBlockDepth / 2}, {kBlockWidth - 1, kBlockDepth / 2});
    plant(16 + r_.pick(18), 1.0, 4.2);
  }

  /// Houses that share walls, from one place along a side to another.
  void add_row(Side side, double from, double to, double back, double least_depth,
               double most_depth, bool fills) {
    const auto row = static_cast<std::uint64_t>(r_.uniform(1, 1e12));
    const double depth = r_.size(least_depth, most_depth);
    const double least = 5.2, most = 9;
    double along = from;
    while (to - along >= least && !is_full()) {
      double width = r_.size(least, most);
      if (fills && to - along - width < least) width = to - along;
      if (width > 1.6 * most || along + width > to + 1e-6) break;
      DrawnPlan drawn = {"rectangle", {rectangle(0, 0, width, depth), {}}, width, depth, 5};
      drawn.wing = std::min(width, depth);
      build(PlotKind::kRow, drawn, side, along, back, row);
      along += width;
    }
  }

  void fill_rows() {
    for (const Side side : {Side::kFront, Side::kBack}) {
      const double back = r_.uniform(3, 5), middle = r_.uniform(0.4, 0.6) * kBlockWidth;
      const bool is_parted = r_.chance(0.6);
      add_row(side, 3, is_parted ? middle - 1.6 : kBlockWidth - 3, back, 9, 11.5, false);
      if (is_parted) add_row(side, middle + 1.6, kBlockWidth - 3, back, 9, 11.5, false);
      for (double along = 9; along < kBlockWidth - 8; along += r_.uniform(6, 14))
        enclose(place(side, along, back + 13), place(side, along, kBlockDepth / 2 - 1));
    }
    enclose({2, kBlockDepth / 2}, {kBlockWidth - 2, kBlockDepth / 2});
    plant(12 + r_.pick(12), 0.9, 2.8);
  }

  void fill_perimeter() {
    constexpr double kDepth = 11;
    const double left = r_.uniform(4, 9), right = kBlockWidth - r_.uniform(4, 9);
    add_row(Side::kFront, left, right, 1.5, kDepth, kDepth, true);
    add_row(Side::kBack, kBlockWidth - right, kBlockWidth - left, 1.5, kDepth, kDepth, true);
    const double foot = 1.5 + kDepth;
    if (r_.chance(0.8)) add_row(Side::kLeft, foot, kBlockDepth - foot, left, 9, kDepth, true);
    if (r_.chance(0.6))
      add_row(Side::kRight, foot, kBlockDepth - foot, kBlockWidth - right, 9, kDepth, true);
    const DrawnPlan shed = draw_rectangle(r_, 4, 7, 3, 5);
    build(PlotKind::kShed, shed, Side::kFront, kBlockWidth / 2 - 8 + r_.uniform(0, 10),
          kBlockDepth / 2 - 3, 0, 0.05);
    plant(14, 1.2, 3.6);
  }

  void fill_courts() {
    double along = 4;
    for (int i = 0; i < 2 && !is_full(); ++i) {
      DrawnPlan drawn = draw_plan(r_, 1);
      for (int attempt = 0; attempt < 60 && drawn.name != "court"; ++attempt)
        drawn = draw_plan(r_, 1);
      if (along + drawn.width > kBlockWidth - 4) break;
      build(PlotKind::kCourt, drawn, Side::kFront, along, 3);
      along += drawn.width + r_.uniform(4, 7);
    }
    along = 4;
    while (!is_full()) {
      DrawnPlan drawn = draw_plan(r_, 0.6);
      if (drawn.name == "court" || drawn.depth > 20) drawn = draw_rectangle(r_, 10, 18, 9, 13);
      if (along + drawn.width > kBlockWidth - 4) break;
      build(PlotKind::kDetached, drawn, Side::kBack, along, 2.5);
      along += drawn.width + r_.uniform(3.5, 8);
    }
    plant(14 + r_.pick(8), 1.2, 3.6);
  }

  void fill_works() {
    out_.is_paved = true;
    const DrawnPlan hall = draw_rectangle(r_, 34, 56, 16, 25);
    build(PlotKind::kHall, hall, Side::kFront, r_.uniform(3, kBlockWidth - 6 - hall.width),
          r_.uniform(3, 5));
    const DrawnPlan office = draw_rectangle(r_, 14, 22, 10, 13);
    build(PlotKind::kOffice, office, Side::kBack, 4, 3);
    const DrawnPlan small = draw_rectangle(r_, 12, 20, 9, 14);
    build(PlotKind::kHall, small, Side::kBack, kBlockWidth - 5 - small.width, 3);
    const DrawnPlan shed = draw_rectangle(r_, 3, 7, 3, 4);
    build(PlotKind::kShed, shed, Side::kBack, 28, 4);
    for (double x = 8; x < kBlockWidth - 8; x += 2.7)
      if (r_.chance(0.45) && is_free({x, kBlockDepth - 20}, 2.8))
        add_car({x, kBlockDepth - 20}, M_PI / 2);
    plant(6, 1.2, 2.6);
  }

  Random& r_;
  int most_;
  BlockFill out_;
};

}  // namespace

BlockFill fill_block(Random& random, BlockKind kind, int most) {
  return Filler(random, most).fill(kind);
}

}  // namespace colod::synth
