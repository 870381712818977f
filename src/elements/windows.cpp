// Based on: elements.cpp.
// Differs: a window's or a door's recess is about as deep as a voxel is wide. Rays give its pane
//   and each of its reveals to the body or to segments of their own; a layer that has some of them
//   only cuts a slot along the whole facade. A wall before the pane and at least two small planes
//   at its edges that look at its middle tell it. Arches fall to planes too small to be any: a face
//   is added.
// Notation: –
#include "windows.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "parameters.h"

namespace colod::elements {
namespace {

using namespace parameters::elements::windows;

/// A wall with the ranges that it takes.
struct Pane {
  const Panel& panel;
  Vec3 across = beside(panel.out);
  Range width = panel.along(across), height = panel.height();
  double back = panel.at(panel.out);
};

/// Small, across the pane, from its edge forward, and looking at its middle.
bool is_reveal(const Panel& p, const Pane& pane) {
  const Panel& wall = pane.panel;
  if (p.id == wall.id || p.plane->area > wall.plane->area ||
      std::abs(p.plane->normal.dot(wall.out)) > kAcrossPane || !is_near(p.box, wall.box, kBeside) ||
      p.plane->normal.dot(wall.box.center() - p.plane->centroid) <= 0)
    return false;
  const Range depth = p.along(wall.out), width = p.along(pane.across), height = p.height();
  return std::abs(depth.low - pane.back) < kBeside &&
         depth.high > pane.back + kLeastDepthOfWindow &&
         depth.high < pane.back + kMostDepthOfWindow && width.low > pane.width.low - 2 * kBeside &&
         width.high < pane.width.high + 2 * kBeside && height.low > pane.height.low - 2 * kBeside &&
         height.high < pane.height.high + 2 * kBeside;
}

bool is_within(const Range& inner, const Range& outer) {
  return inner.low > outer.low && inner.high < outer.high;
}

/// A wall that looks the same way, before the pane, and around it or larger and beside it.
bool is_facade(const Panel& p, const Pane& pane) {
  const Panel& wall = pane.panel;
  const double before = p.at(wall.out) - pane.back;
  if (!p.is_wall || p.out.dot(wall.out) < kAlike || before < 0.5 * kLeastDepthOfWindow ||
      before > kMostDepthOfWindow)
    return false;
  const Range width = p.along(pane.across), height = p.height();
  return p.plane->area > wall.plane->area
             ? overlap(width, pane.width) > -kReach && overlap(height, pane.height) > -kReach
             : is_within(pane.width, width) && is_within(pane.height, height);
}

/// Where no reveal looks down from the pane's upper edge, or inward from one of its sides, a face
/// is added there, from the pane to the facade.
std::vector<Element::Rim> rims_of(const Pane& pane, const std::vector<const Panel*>& reveals,
                                  const Range& depth) {
  const auto is_missing = [&](const Vec3& inward) {
    return std::none_of(reveals.begin(), reveals.end(),
                        [&](const Panel* p) { return p->plane->normal.dot(inward) > kFacing; });
  };
  std::vector<Element::Rim> rims;
  if (is_missing(-Vec3::UnitZ()))
    rims.push_back(level_rim(-1, pane.height.high, pane.across, pane.width, pane.panel.out, depth));
  for (const double side : {-1.0, 1.0}) {
    const Vec3 inward = -side * pane.across;
    if (!is_missing(inward)) continue;
    const double at = side > 0 ? -pane.width.high : pane.width.low;
    const Range along = side > 0 ? depth : Range{-depth.high, -depth.low};
    rims.push_back(upright_rim(inward, at, along, pane.height));
  }
  return rims;
}

std::optional<Element> window_before(const std::vector<Panel>& panels, const Panel& wall) {
  if (!wall.is_wall || wall.plane->area < kLeastPane || wall.plane->area > kMostPane)
    return std::nullopt;
  const Pane pane{wall};
  Element window{.kind = ElementKind::kWindow, .planes = {wall.id}};
  std::vector<const Panel*> reveals;
  Range depth{pane.back, pane.back};
  for (const Panel& p : panels) {
    if (!is_reveal(p, pane)) continue;
    reveals.push_back(&p), window.planes.push_back(p.id);
    depth.high = std::max(depth.high, p.along(wall.out).high);
  }
  if (reveals.size() < kReveals || std::none_of(panels.begin(), panels.end(),
                                                [&](const Panel& p) { return is_facade(p, pane); }))
    return std::nullopt;
  window.air = {{-wall.out, -pane.back},
                {wall.out, depth.high},
                {-pane.across, -pane.width.low},
                {pane.across, pane.width.high},
                {-Vec3::UnitZ(), -pane.height.low},
                {Vec3::UnitZ(), pane.height.high}};
  window.rims = rims_of(pane, reveals, depth);
  window.is_whole = true;
  return window;
}

}  // namespace

std::vector<Element> find_windows(const std::vector<Panel>& panels) {
  std::vector<Element> found;
  for (const Panel& p : panels)
    if (auto window = window_before(panels, p)) found.push_back(std::move(*window));
  return found;
}

}  // namespace colod::elements
