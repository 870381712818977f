// Building GLB: the whole chain of one building with MSFT_lod, Draco inside (DESIGN section 5).
#pragma once

#include "exporters/exporter.h"

namespace colod {

struct GlbOptions {
  Compression compression = Compression::kDraco;
  double quantization = 0.01;  ///< metres: bound on the position error, finer for the finest layer
  SwitchFacts switching = {};
};

/// The file, and how much of it each level's mesh takes.
struct BuildingGlb : Encoded {
  std::vector<std::size_t> level_bytes;  ///< coarsest first
};

/// path: buildings/<name>.glb. Finest layer on the root node, named after the given name, _LOD0;
/// coarser in MSFT_lod.ids by falling detail; coarsest first in the binary chunk, the property
/// table of the levels after them. Coverages are c = D / (g·H), with g of the next coarser level, D
/// the bounding sphere's diameter and H the viewport's height.
BuildingGlb encode_building_glb(const ExportBuilding& building, const GlbOptions& options = {});

}  // namespace colod
