// Inside room `extraction`, the first verb: the planes that cut a layer, and where its building
// certainly ends.
#pragma once

#include <vector>

#include "elements/elements.h"
#include "extraction.h"
#include "partition/partition.h"
#include "planes/planes.h"

namespace colod {

/// What is handed to partition_space, and what must stay outside.
struct CuttingPlan {
  std::vector<CutPlane> planes;
  std::vector<int> input;  ///< per cut plane: the index in Planes::planes whose outline it carries,
                           ///< −1: none
  Box box;
  struct Limit {
    Vec3 normal;
    double offset;
  };
  std::vector<Limit> limits;      ///< cells with their centroid beyond one of them are outside
  std::vector<Element> elements;  ///< of the layer
};

/// What the layer's own planes, the elements that they form and (robust rules) the building's foot,
/// sides and lone roof borders ask for. Throws Error{kProcess} when no plane has an outline.
CuttingPlan plan_cuts(const Planes& planes, const std::vector<int>& layer_planes,
                      const RayScene& rays, const ExtractionOptions& options);

/// The convex hull of points on a plane, grown within it by `growth` metres.
std::vector<Vec3> grown_hull(const Plane& plane, const std::vector<Vec3>& points, double growth);

}  // namespace colod
