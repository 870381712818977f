// What stands for buildings that are too far away for their coarsest layer: oriented boxes, one a
// building and farther up one for several, each with its measured deviation.
#pragma once

#include "exporter.h"

namespace colod {

/// An upright box that stands for some buildings. World coordinates.
struct StandIn {
  std::vector<int> buildings;  ///< rising
  Vec3 origin = Vec3::Zero();  ///< middle of the foot
  double yaw = 0;              ///< radians, of the box's x axis from the world's
  Vec3 half = Vec3::Zero();    ///< half length, half width, and the whole height
  double error = 0;  ///< metres: no point of the buildings' finest levels is farther from the
                     ///< box, and none of the box farther from them
};

/// The box of one building: upright about its coarsest layer with the least footprint, as high as
/// deviates least.
StandIn stand_in_for(const ExportBuilding& building, int index);

/// Merges the cheapest pairs until at most `most` (≥ 1) are left. A merged box's error is its
/// measured deviation from the boxes that it replaces, added to the largest of theirs. O(n²).
std::vector<StandIn> merge_stand_ins(std::vector<StandIn> boxes, std::size_t most);

/// Its four walls and its top, about `origin`, axes parallel to the world's; no floor, which no one
/// sees from far away.
PolygonMesh mesh_of(const StandIn& box);

constexpr int kStandInTriangles = 10;

}  // namespace colod
