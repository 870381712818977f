// OBJ (a polygon for each strictly convex facet, triangles for the others) and binary PLY (double
// precision, triangles) per layer, in world coordinates.
#pragma once

#include "exporter.h"

namespace colod {

/// path: buildings/<name>.layer<k>.obj / .ply
Encoded encode_obj(const ExportBuilding& building, const ExportLayer& layer);
Encoded encode_ply(const ExportBuilding& building, const ExportLayer& layer);

}  // namespace colod
