// How a tile looks: the levels of a group share one atlas, stand-ins wear the mean colours of their
// sides.
#pragma once

#include "tree.h"

namespace colod {

struct TileLook {
  std::vector<LevelLook> parts;  ///< per part of the tile, coordinates in the tile's own image
  LevelLook whole;               ///< the image or the colours that all of them share; or nothing
};

/// Buildings without appearance are grey beside others. Atlases of a group that do not fit into one
/// of `largest` texels a side are halved until they do; its facets have one colour each where not
/// even a block of texels for each building fits.
TileLook look_of(const PlannedTile& tile, const std::vector<ExportBuilding>& buildings,
                 int largest);

}  // namespace colod
