// OBJ (a polygon for each strictly convex facet, triangles for the others) and binary PLY (double
// precision, triangles) per layer, in world coordinates.
#pragma once

#include "exporters/exporter.h"

namespace colod {

/// path: buildings/<name>.layer<k>.obj / .ply, k = `layer`, one of the level's. A PLY has the
/// colours of its facets, per face.
Encoded encode_obj(const ExportBuilding& building, const ExportLevel& level, int layer);
/// What a textured OBJ names: its .mtl and its image; nothing where there is no texture.
std::vector<Encoded> encode_obj_material(const ExportBuilding& building, const ExportLevel& level,
                                         int layer);
Encoded encode_ply(const ExportBuilding& building, const ExportLevel& level, int layer);

}  // namespace colod
