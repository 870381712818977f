// Inside room `bake` only: which charts nobody saw.
#pragma once

#include "sight.h"

namespace colod::bake {

/// Whether the source shows nothing on nearly all of a chart, by samples spread over its triangles:
/// floors, party walls, what was dark. One mean colour stands for it.
bool is_blank(const PolygonMesh& mesh, const Chart& chart, const Sight& sight);

}  // namespace colod::bake
