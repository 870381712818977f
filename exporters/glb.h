// Building GLB: the whole chain of one building with MSFT_lod, Draco inside (DESIGN section 5).
#pragma once

#include "exporter.h"

namespace colod {

struct GlbOptions {
  Compression compression = Compression::kDraco;
  double quantization = 0.01;  ///< metres: bound on the position error, finer for the finest layer
  double pixel_error = 2;      ///< p of c_k = p·D/(ε_{k+1}·H)
  double viewport_height = 1080;  ///< H
};

/// path: buildings/<name>.glb. Finest layer on the root node, named <name>_LOD0; coarser ones in
/// MSFT_lod.ids by falling detail; coarsest first in the binary chunk, the property table of the
/// levels after them.
Encoded encode_building_glb(const ExportBuilding& building, const GlbOptions& options = {});

}  // namespace colod
