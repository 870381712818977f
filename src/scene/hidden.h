// Between the ground and room `planes`: what nobody sees from outside, out of the building's mesh.
#pragma once

#include "core/geometry.h"

namespace colod {

/// The shell of a mesh: faces of rooms, furniture, floor slabs and of the sides on which parts
/// touch or overlap are left out (reason kInside) with a warning that says how much. A face that is
/// seen in part is cut where others meet it. A place is outside where a cube of 2.5 m that comes
/// from around can stand, so that open windows and doors do not show the rooms behind them, where
/// nothing stands above, so that courts and shafts stay, and in a cavity that is open widely, so
/// that niches, porches and passages stay; a point is seen when such a place is in sight of it
/// within 0.75 m (more on buildings beyond some 60 m, whose voxels are larger). Unchanged where
/// less than 2 % of the area is hidden (0.1 % of what people draw): clouds, scans, single shells.
/// `source` is in its local frame (z up); the result keeps its order. Deterministic, runs in
/// parallel; at most 4 million voxels and O(faces · log faces).
Source remove_hidden(Source source);

}  // namespace colod
