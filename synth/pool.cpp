// *Based on:* usual dimensions of buildings in Europe, with room on both sides.
//
// *Differs:* no --rules here.
//
// *Notation:* none.
#include "pool.h"

#include <algorithm>

namespace colod::synth {
namespace {

WindowModel draw_window(Random& r, const std::string& name) {
  WindowModel w = {name, r.size(0.5, 2.2), r.size(0.6, 1.75), r.size(0.05, 0.3), 0, false, false};
  w.panes = r.chance(0.2) ? 0 : 1 + static_cast<int>(w.width / r.uniform(0.55, 1.2));
  w.panes = std::min(w.panes, static_cast<int>((w.width - 0.07) / 0.3));
  w.rows = w.panes > 0 && w.height > 0.9 && r.chance(0.35) ? 2 + r.pick(2) : 1;
  w.has_sill = r.chance(0.5);
  if (r.chance(0.3)) w.surround = r.size(0.03, 0.1);
  return w;
}

ShapedDormer draw_dormer(Random& r, const std::string& name) {
  constexpr const char* kNames[] = {"_gabled", "_shed", "_hipped", "_flat", "_mansard"};
  const int shape = r.pick(5);
  ShapedDormer d;
  d.name = name + kNames[shape];
  d.shape = static_cast<DormerShape>(shape);
  d.width = r.size(1.0, d.shape == DormerShape::kGabled ? 2.6 : 4.2);
  d.height = r.size(0.8, 1.8);
  const bool has_rise = d.shape != DormerShape::kShed && d.shape != DormerShape::kFlat;
  d.rise = has_rise ? d.width * r.uniform(0.22, 0.6) : 0;
  d.window = draw_window(r, d.name + "_window");
  d.window.surround = 0, d.window.has_sill = false, d.window.rows = 1;
  d.window.panes = std::min(d.window.panes, 1);
  d.window.reveal = std::min(d.window.reveal, 0.12);
  return d;
}

BalconyModel draw_balcony(Random& r, const std::string& name) {
  BalconyModel b = {name, r.size(1.5, 5.0), r.size(0.7, 2.0), r.size(0.85, 1.15)};
  b.slab = r.size(0.12, 0.3), b.wall = r.size(0.05, 0.2);
  if (r.chance(0.4)) {
    b.name += "_on_pillars";
    b.pillars = 2 + r.pick(2), b.pillar = r.size(0.15, 0.4);
  }
  return b;
}

template <typename Model, typename Draw>
void fill(std::vector<Model>& models, int n, const std::string& name, const Draw& draw) {
  for (int i = 0; i < n; ++i) models.push_back(draw(name + "_" + std::to_string(i)));
}

using Name = const std::string&;

}  // namespace

Pool::Pool(std::uint64_t street) {
  Random r(street * 15485863 + 101);
  fill(windows_, 7, "window", [&](Name n) { return draw_window(r, n); });
  fill(ribbons_, 3, "window_ribbon", [&](Name n) {
    return WindowModel{
        n, r.size(1.6, 3.6), r.size(0.9, 2.1), r.size(0.05, 0.3), 2 + r.pick(3), false, false};
  });
  fill(arched_, 3, "window_arched", [&](Name n) {
    const double width = r.size(0.6, 1.6);
    return WindowModel{n,   width, width + r.size(0.4, 2.0), r.size(0.08, 0.3), 0, r.chance(0.3),
                       true};
  });
  fill(doors_, 4, "door", [&](Name n) {
    return DoorModel{n, r.size(0.85, 2.0), r.size(1.95, 2.5), r.size(0.05, 0.35)};
  });
  fill(french_, 3, "door_french", [&](Name n) {
    return DoorModel{n, r.size(0.75, 1.3), r.size(1.95, 2.1), r.size(0.05, 0.25)};
  });
  fill(gates_, 2, "door_gate", [&](Name n) {
    return DoorModel{n, r.size(2.4, 5.0), r.size(2.5, 4.5), r.size(0.08, 0.4)};
  });
  fill(balconies_, 4, "balcony", [&](Name n) { return draw_balcony(r, n); });
  fill(dormers_, 5, "dormer", [&](Name n) { return draw_dormer(r, n); });
  fill(chimneys_, 4, "chimney", [&](Name n) {
    return ChimneyModel{n, r.size(0.4, 1.8), r.size(0.4, 0.9), r.size(0.5, 2.2)};
  });
  fill(bays_, 3, "bay", [&](Name n) {
    const double width = r.size(1.6, 4.0);
    return BayModel{n, width, r.size(0.3, 1.3), r.chance(0.5) ? 0 : width * r.uniform(0.08, 0.25)};
  });
  fill(loggias_, 2, "loggia", [&](Name n) {
    return LoggiaModel{n, r.size(1.8, 4.5), r.size(2.15, 2.4), r.size(0.6, 1.8)};
  });
  fill(shops_, 3, "shopfront", [&](Name n) {
    return ShopFront{n, r.size(0.15, 1.6), r.size(2.3, 3.0), 1 + r.pick(4)};
  });
  fill(arcades_, 2, "arcade", [&](Name n) {
    return ArcadeModel{n, r.size(1.4, 2.8), r.size(2.4, 3.1), r.size(0.25, 0.6), r.size(2.2, 4.0)};
  });
  fill(cornices_, 3, "cornice", [&](Name n) {
    return CorniceModel{n, r.size(0.08, 0.3), r.size(0.04, 0.35)};
  });
}

Makes Pool::draw(Random& random) const {
  const auto one = [&](const auto& models) {
    return models[random.pick(static_cast<int>(models.size()))];
  };
  Makes m;
  m.window = one(windows_), m.side_window = random.chance(0.6) ? m.window : one(windows_);
  m.ground_window = random.chance(0.5) ? m.window : one(windows_);
  m.ribbon = one(ribbons_), m.arched = one(arched_);
  m.door = one(doors_), m.french = one(french_), m.gate = one(gates_);
  m.balcony = one(balconies_), m.dormer = one(dormers_), m.chimney = one(chimneys_);
  m.bay = one(bays_), m.loggia = one(loggias_), m.shop = one(shops_);
  m.arcade = one(arcades_), m.cornice = one(cornices_);
  return m;
}

}  // namespace colod::synth
