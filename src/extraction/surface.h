// Inside room `extraction`, the last verb: cells → one watertight polygonal mesh. Every verb that
// changes cells ends with it, since facets are what it is judged by.
#pragma once

#include <string>
#include <vector>

#include "core/geometry.h"
#include "label.h"
#include "partition/partition.h"

namespace colod {

struct Shell {
  PolygonMesh mesh;   ///< closed, outward
  double mended = 0;  ///< m³ of the cells that were turned round to make it a 2-manifold
};

/// The surface around the inside cells: pinches mended, short edges contracted; the largest
/// component, and by rules substantial others, with cavities filled. Empty when no cell
/// is inside.
Shell make_surface(const Partition& partition, std::vector<char> is_inside,
                   const RuleSet& rules = RuleSet::all());

/// A verb may cost the body no more than 3 % of its volume.
bool keeps_volume(const PolygonMesh& before, const PolygonMesh& after);

/// A layer between two verbs: the space as it was cut, what of it is inside, the surface around it.
struct Draft {
  Partition partition;
  Labels labels;
  Shell shell;
  std::vector<std::string> warnings;  ///< of the first partition and of labelling
};

}  // namespace colod
