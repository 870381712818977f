// How a tile looks: the levels of a group share one atlas, stand-ins wear the mean colours of their
// sides.
#pragma once

#include <functional>

#include "tree.h"

namespace colod {

struct TileLook {
  std::vector<LevelLook> parts;  ///< per part of the tile, coordinates in the tile's own image
  LevelLook whole;               ///< the image or the colours that all of them share; or nothing
};

/// A building's coarsest level, as stand-ins are coloured by it.
struct CoarsestLook {
  Mesh mesh;                           ///< building-local
  std::vector<int> facet_of_triangle;  ///< per face of the mesh
  std::vector<Rgb> facet_colors;       ///< per facet; empty: it has none
};

CoarsestLook coarsest_look(const ExportLevel& coarsest);

/// Of a tile that shows buildings' levels, which are there. Buildings without appearance are grey
/// beside others. Where finer tiles take its place no texel needs to be finer than a
/// pixel is from there on: a building that looks the same on all levels wears less of its image.
/// Atlases of a group that do not fit into one of `largest` texels a side are halved until they do;
/// its facets have one colour each where not even a block of texels for each building fits.
TileLook look_of_levels(const PlannedTile& tile, int largest);

/// Of a tile that shows stand-ins: asks for each building's coarsest level, in rising order.
TileLook look_of_stand_ins(const PlannedTile& tile,
                           const std::function<CoarsestLook(int building)>& coarsest);

}  // namespace colod
