// Inside the synth room: what a flight's pictures give of a piece of a town.
#pragma once

#include <map>

#include "core/rays.h"
#include "scene_house.h"

namespace colod::synth {

/// A building as rays meet it, about its plot's origin and foot.
struct Standing {
  Standing(const Plot& its_plot, const Pool& pool);

  const Plot* plot;
  SynthBuilding model;
  RayScene rays;
  Box box;

  Vec3 to_own(const Vec3& p) const {
    return {p.x() - plot->origin.x(), p.y() - plot->origin.y(), p.z() - plot->foot};
  }
};

/// Heights and what has them, on a grid of half the lattice, with a margin.
struct SkyView {
  static constexpr int kGround = -1;

  double cell = 0;
  int x0 = 0, y0 = 0;  ///< the grid's number of the first column and row
  int width = 0, height = 0;
  std::vector<double> top;     ///< metres
  std::vector<double> melted;  ///< metres, what is narrow and low partly filled
  std::vector<int> object;     ///< kGround; a plot; or a prop, numbered after the plots

  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y - y0) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x - x0);
  }
  int column(double x) const {
    return std::clamp(static_cast<int>(std::floor(x / cell)), x0, x0 + width - 1);
  }
  int row(double y) const {
    return std::clamp(static_cast<int>(std::floor(y / cell)), y0, y0 + height - 1);
  }
  int object_at(const Vec2& p) const { return object[at(column(p.x()), row(p.y()))]; }
  Vec2 middle(int x, int y) const { return cell * Vec2(x + 0.5, y + 0.5); }
};

/// One tile's piece of the world.
struct TilePlace {
  int i0 = 0, j0 = 0;         ///< the lattice's nodes from which on it reaches …
  int columns = 0, rows = 0;  ///< … over so many cells
  double cell = 0;            ///< metres, of the lattice
};

/// The buildings that a tile shows, by their plot's number.
std::map<int, Standing> standing_on(const Town& town, const Pool& pool, const TilePlace& place);

SkyView look_down(const Town& town, const std::map<int, Standing>& standing,
                  const TilePlace& place);

/// The surface: edges melted, facades bulging, noise, holes; thinned where it is flat. What
/// neighbours share of a border is the same in both.
Mesh reconstruct_tile(const SkyView& view, const TilePlace& place, std::uint64_t seed);

}  // namespace colod::synth
