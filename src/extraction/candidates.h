// Inside room `extraction`: the planes that cut a layer, and where its building certainly ends.
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
  std::vector<Limit> limits;  ///< cells with their centroid beyond one of them are outside
  std::vector<Element> elements;
};

CuttingPlan plan_cuts(const Planes& planes, const std::vector<int>& layer_planes,
                      const RayScene& rays, const ExtractionOptions& options);

/// Per plane of `layer_planes` the plane whose place it takes, most often itself: a larger one that
/// looks about the same way and that its whole outline is within `tolerance` metres of.
std::vector<int> find_leaders(const Planes& planes, const std::vector<int>& layer_planes,
                              double tolerance);

/// The convex hull of points on a plane, grown within it by `growth` metres.
std::vector<Vec3> grown_hull(const Plane& plane, const std::vector<Vec3>& points, double growth);

/// Appends vertical candidates under roof borders that no plane supports. \pre the sides are in
/// `plan`.
void add_walls(const Planes& planes, const std::vector<int>& layer_planes, const RayScene& rays,
               CuttingPlan& plan);

/// The layer's balconies, loggias and chimneys; the planes that end them lead themselves
/// (elements.cpp).
void find_elements(const Planes& planes, std::vector<int> layer_planes, CuttingPlan& plan);
void keep_bounds(const std::vector<int>& layer_planes, const CuttingPlan& plan,
                 std::vector<int>& leaders);
/// The faces that a element lacks.
void add_rims(const Element& element, CuttingPlan& plan);

}  // namespace colod
