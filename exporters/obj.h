// OBJ (polygons where a facet has no hole) and binary PLY (double precision) per layer, in world
// coordinates.
#pragma once

#include "exporter.h"

namespace colod {

/// path: buildings/<name>.layer<k>.obj / .ply
Encoded encode_obj(const ExportBuilding& building, const ExportLayer& layer);
Encoded encode_ply(const ExportBuilding& building, const ExportLayer& layer);

}  // namespace colod
