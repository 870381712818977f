// Inside the synth room: a tile's picture, as an atlas of charts, and what is true of it.
#pragma once

#include "scene_surface.h"

namespace colod::synth {

/// What a tile's charts are painted from.
struct Sight {
  const Town& town;
  const std::map<int, Standing>& standing;
  const SkyView& view;

  SynthClass class_of(int object) const;
  /// What lies just below a place of the surface.
  int object_below(const Vec3& p, const Vec3& normal) const;
};

/// Fills uvs and picture of a tile that has its mesh. `texel`: metres.
void paint_tile(const Sight& sight, double texel, SynthTile& tile);

/// The classes from straight above, and of each face.
void tell_truth(const Sight& sight, const TilePlace& place, SynthTile& tile);

}  // namespace colod::synth
