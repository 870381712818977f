// A layer's planes → one watertight polygonal mesh (paper section 3.3, eq. 11): plan → cut → label
// → prune → simplify → thicken → surface, each verb a file with its own header, values in and out.
//
// Space is cut at most three times (the plan, and twice without planes that the surface does not
// need), once more for sheets on the finest layer; with spares all of that at most five times.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/geometry.h"
#include "core/rules.h"
#include "planes/planes.h"
#include "sight.h"

namespace colod {

struct ExtractionOptions {
  RuleSet rules = RuleSet::all();  ///< none: whole planes, level rays, more than half of
                                   ///< n_r, no min-cut, no base and no rectangle
  int nr = 100;
  double growth = 0.1;      ///< metres an outline's hull reaches beyond the outline
  double smoothness = 0.4;  ///< robust: weight of facet area in the min-cut
  double tolerance = 0;     ///< metres, robust: planes whose outline lies this near to a larger one
                            ///< that looks about the same way take its place
  bool is_finest = false;   ///< robust: what is drawn without thickness becomes a thin body, and a
                            ///< facet's price does not grow with the building
  int max_cells = 30000;    ///< of one partition: three times the most seen on real buildings
                            ///< (November 2026: six sets, airborne, photogrammetric, modelled)
};

struct Extraction {
  PolygonMesh mesh;  ///< closed, 2-manifold where `is_manifold`; local frame; never empty
  std::int64_t cells = 0;
  bool is_manifold = true;
  std::vector<int> joined;  ///< planes of the spares that joined the layer's, in that order
  std::vector<std::string> warnings;
};

/// `layer_planes` are indices into `planes`, in the order of cutting (coarse layers first, large
/// planes first). The mesh looks outward; it is one component, under robust rules also others of at
/// least 5 % of the largest one's volume (a detached annex). Facets name planes of `planes`, or −1
/// for candidate planes (base, rectangle, walls under roof borders). Deterministic, uses threads;
/// about 0.2 ms a cell on one core. A building whose planes make more cells than any real one's
/// gets its layers without further attempts (leaner cuts, spares), and beyond `max_cells` without
/// the planes that come last, which a warning says. Throws Error{kProcess} when no plane has an
/// outline, and under paper rules when no interior is found; robust rules then take the box around
/// the layer, with a warning.
Extraction extract_layer(const Planes& planes, const std::vector<int>& layer_planes, Sight& sight,
                         const ExtractionOptions& options = {});

/// Likewise; where it brings the surface much nearer to all outlines for few facets, sets of
/// `spares` (rising plane indices, planes of finer layers) join the layer's planes: `joined`.
Extraction extract_layer(const Planes& planes, const std::vector<int>& layer_planes,
                         const std::vector<std::vector<int>>& spares, Sight& sight,
                         const ExtractionOptions& options);

}  // namespace colod
