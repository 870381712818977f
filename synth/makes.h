// Inside the synth room: parts of more kinds than the catalogue's, for varied streets.
#pragma once

#include "parts.h"

namespace colod::synth {

enum class DormerShape { kGabled, kShed, kHipped, kFlat, kMansard };

struct ShapedDormer {
  std::string name;
  DormerShape shape;
  double width, height;
  double rise;  ///< of its roof above its walls [m]; none with shed and flat
  WindowModel window;
};
bool add_shaped_dormer(House& house, int facet, double u, double v, const ShapedDormer& model);

struct ShopFront {
  std::string name;
  double depth, height;
  int windows;
};
/// A recess with a door and windows, from u0 to u1, its foot at v.
bool add_shop_front(House& house, int facet, const Vec2& u, double v, const ShopFront& model,
                    const DoorModel& door);

struct ArcadeModel {
  std::string name;
  double depth, height, pillar, spacing;  ///< metres
};
/// A walk behind pillars, from u0 to u1, its foot at v. Doors and windows may go on the facet that
/// it returns; −1: it does not fit.
int add_arcade(House& house, int facet, const Vec2& u, double v, const ArcadeModel& model);

/// Straight through the house to the facet behind, u its middle and v its foot.
bool add_passage(House& house, int facet, int behind, double u, double v, double width,
                 double height);

struct CorniceModel {
  std::string name;
  double height, depth;
};
/// Along the whole facet, from `from` to `to` in its u.
bool add_cornice(House& house, int facet, double from, double to, double v,
                 const CorniceModel& model);

/// A room on a flat roof.
bool add_penthouse(House& house, int facet, const Rect& rect, double height,
                   const WindowModel& window);

}  // namespace colod::synth
