// OBJ (a polygon for each strictly convex facet, triangles for the others) and binary PLY (double
// precision, triangles) per layer, in world coordinates.
#pragma once

#include "exporters/exporter.h"

namespace colod {

/// path: buildings/<name>.layer<k>.obj / .ply, k = `layer`, one of the level's.
Encoded encode_obj(const ExportBuilding& building, const ExportLevel& level, int layer);
Encoded encode_ply(const ExportBuilding& building, const ExportLevel& level, int layer);

}  // namespace colod
