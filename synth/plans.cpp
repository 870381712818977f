// *Based on:* footprints of wings around corners and courts.
//
// *Differs:* no --rules here.
//
// *Notation:* W, D: width and depth of the whole.
#include "plans.h"

#include <algorithm>

namespace colod::synth {
namespace {

constexpr double kMostWidth = 34, kMostDepth = 26;  // m, what a plot of the street has room for

DrawnPlan finish(const std::string& name, std::vector<Vec2> outer, std::vector<Vec2> court,
                 double wing) {
  DrawnPlan drawn = {name, {std::move(outer), std::move(court)}, 0, 0, wing};
  for (const Vec2& p : drawn.plan.outer)
    drawn.width = std::max(drawn.width, p.x()), drawn.depth = std::max(drawn.depth, p.y());
  return drawn;
}

std::vector<Vec2> mirrored(std::vector<Vec2> ring, double width, double depth, bool is_x,
                           bool is_y) {
  for (Vec2& p : ring) {
    if (is_x) p.x() = width - p.x();
    if (is_y) p.y() = depth - p.y();
  }
  if (is_x != is_y) std::reverse(ring.begin(), ring.end());
  return ring;
}

struct Lengths {
  Random& random;
  double scale;

  /// To five centimetres, so that what is not equal is well apart.
  double draw(double low, double high) const {
    return std::round(20 * random.uniform(low, high)) / 20;
  }
  double wing() const { return draw(5.2, 5.2 + 7 * std::min(1.4, scale)); }
  /// What sticks out of a wing, or lies between two.
  double reach() const { return draw(4.5, 4.5 + 7 * scale); }
};

DrawnPlan draw_l(const Lengths& l) {
  const double d = l.wing(), w = l.wing(), W = w + l.reach(), D = d + l.reach();
  return finish("l", {{0, 0}, {W, 0}, {W, D}, {W - w, D}, {W - w, d}, {0, d}}, {}, std::min(d, w));
}

DrawnPlan draw_t(const Lengths& l) {
  const double d = l.wing(), w = l.wing(), x = l.draw(2, 8), W = x + w + l.draw(2, 8);
  const double D = d + l.draw(2.5, 10);
  return finish("t", {{0, 0}, {W, 0}, {W, d}, {x + w, d}, {x + w, D}, {x, D}, {x, d}, {0, d}}, {},
                std::min(d, w));
}

DrawnPlan draw_u(const Lengths& l) {
  const double d = l.wing(), a = l.wing(), b = l.wing(), W = a + b + std::max(5.0, l.reach());
  const double D1 = d + l.reach(), D2 = l.random.chance(0.4) ? D1 : d + l.reach();
  return finish("u", {{0, 0}, {W, 0}, {W, D2}, {W - b, D2}, {W - b, d}, {a, d}, {a, D1}, {0, D1}},
                {}, std::min({d, a, b}));
}

DrawnPlan draw_z(const Lengths& l) {
  const double d = l.wing() + 1.5, D = d + l.draw(2, 6), e = l.draw(1.5, d - 4.5);
  const double b = l.reach(), a = b + l.wing(), W = a + l.reach();
  return finish("z", {{0, 0}, {a, 0}, {a, e}, {W, e}, {W, D}, {b, D}, {b, d}, {0, d}}, {},
                std::min({d, D - e}) - 1);
}

DrawnPlan draw_court(const Lengths& l) {
  const auto wing = [&] { return l.draw(5.2, 8.5); };
  const double a = wing(), b = wing(), c = wing(), d = wing();
  const double x = a + l.draw(5, 12), y = c + l.draw(5, 8), W = x + b, D = y + d;
  return finish("court", rectangle(0, 0, W, D), {{a, c}, {a, y}, {x, y}, {x, c}},
                std::min({a, b, c, d}));
}

}  // namespace

DrawnPlan draw_rectangle(Random& random, double least_width, double most_width, double least_depth,
                         double most_depth) {
  const Lengths l = {random, 1};
  const double W = l.draw(least_width, most_width), D = l.draw(least_depth, most_depth);
  return finish("rectangle", rectangle(0, 0, W, D), {}, std::min(W, D));
}

DrawnPlan draw_plan(Random& random, double scale) {
  const Lengths l = {random, scale};
  using Draw = DrawnPlan (*)(const Lengths&);
  constexpr Draw kDraws[] = {draw_l, draw_t, draw_u, draw_z, draw_court};
  const int kind = random.pick(7);
  for (int attempt = 0; attempt < 20 && kind < 5; ++attempt) {
    DrawnPlan drawn = kDraws[kind](l);
    if (drawn.width > kMostWidth || drawn.depth > kMostDepth) continue;
    const bool is_x = random.chance(0.5), is_y = random.chance(0.5);
    drawn.plan.outer = mirrored(drawn.plan.outer, drawn.width, drawn.depth, is_x, is_y);
    if (drawn.plan.has_court())
      drawn.plan.court = mirrored(drawn.plan.court, drawn.width, drawn.depth, is_x, is_y);
    return drawn;
  }
  return draw_rectangle(random, 6, 6 + 14 * scale, 5.5, 13);
}

}  // namespace colod::synth
