// Inside room `extraction`, the fifth verb: facets that are not worth their price go.
#pragma once

#include <vector>

#include "evidence.h"
#include "extraction.h"
#include "partition/partition.h"
#include "planes/planes.h"
#include "surface.h"

namespace colod {

/// The draft with fewer facets at the layer's tolerance, or as it was.
Draft simplify(Draft draft, const Planes& planes, const ExtractionOptions& options);

struct SimplifyOptions {
  double facet_volume = 0;          ///< m³ that may change sides for each facet that this saves
  double depth = 0;                 ///< metres that the surface may move
  std::vector<char> is_fixed = {};  ///< per plane of the partition: its facets stay; empty: of none
};

/// Turns the cells under or over a facet round where that leaves fewer facets; never the forced
/// ones. Ends after a few rounds over all facets. Returns how many facets went, components and
/// pinches aside.
int simplify_cells(const Partition& partition, const Evidence& evidence,
                   const std::vector<char>& is_forced_out, const SimplifyOptions& options,
                   std::vector<char>& is_inside);

}  // namespace colod
