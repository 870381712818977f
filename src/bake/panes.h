// Inside room `bake` only: faces of the source as places on a chart show them.
#pragma once

#include <vector>

#include "charts.h"
#include "image/look_sampler.h"
#include "probe.h"
#include "sight.h"

namespace colod::bake {

/// What its images leave out. Keeps references to both.
Probe::Holes holes_in(const LookSampler& sampler, Lens& lens);

/// A face of the source, seen along a chart's normal. Places are in steps of a grid.
struct Pane {
  int face = -1;
  int changes = 0;  ///< of the lens, when it was made
  FaceLook look;
  Vec3 base, right, down;  ///< weights of the corners at 0,0, and how a step changes them
  Vec3 offsets;            ///< of the corners, metres along the normal

  Vec3 weight(const Vec2& at) const { return base + at.x() * right + at.y() * down; }
};

/// Those asked for last on a window's grid. Keeps references to all that it is given.
class Panes {
 public:
  Panes(const Sight& sight, const SampleGrid& grid, const LookSampler& sampler, Lens& lens);
  /// Good until the next is asked for. The face agrees with the chart.
  const Pane& of(int face) {
    Pane& pane = panes_[static_cast<std::size_t>(face) % kPanes];
    if (pane.face != face || pane.changes != lens_.changes()) pane = made(face);
    return pane;
  }
  /// Of the faces that the four samples about a place show the one that lies nearest there; −1:
  /// none of them holds it. `sightings` are those of the grid.
  int about(const Vec2& at, const std::vector<Sighting>& sightings, double reach);

 private:
  static constexpr std::size_t kPanes = 64;  // more than a row of a window mostly shows
  Pane made(int face) const;

  const Sight& sight_;
  const SampleGrid& grid_;
  const LookSampler& sampler_;
  Lens& lens_;
  std::vector<Pane> panes_;
};

}  // namespace colod::bake
