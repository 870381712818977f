// What stands for buildings that are too far away for their coarsest layer: oriented boxes, one a
// building and farther up one for several, each with its measured deviation.
#pragma once

#include <optional>

#include "exporters/exporter.h"

namespace colod {

/// An upright box that stands for some buildings. World coordinates.
struct StandInBox {
  std::vector<int> buildings;  ///< rising
  Vec3 origin = Vec3::Zero();  ///< middle of the foot
  double yaw = 0;              ///< radians, of the box's x axis from the world's
  Vec3 half = Vec3::Zero();    ///< half length, half width, and the whole height
  double gsd = 0;              ///< metres a pixel, from where on it may be shown
  double error = 0;  ///< metres: no point of the buildings' finest levels is farther from the
                     ///< box, and none of the box farther from them
};

/// The box of one building: upright about its coarsest level with the least footprint, as high as
/// deviates least. Its gsd is measured as a level's is, and greater than the coarsest level's.
StandInBox stand_in_for(const ExportBuilding& building, int index, const SwitchFacts& facts = {});

/// Scope scene: the gsd of all buildings' boxes, as a layer has one, by what each has of its own.
/// Scope building: nothing, each keeps its own.
std::optional<double> shared_gsd(const std::vector<double>& own, const SwitchFacts& facts);

/// Merges the cheapest pairs until at most `most` (≥ 1) are left. A merged box's error is its
/// measured deviation from the boxes that it replaces, added to the largest of theirs; its gsd is
/// that at which this deviation covers `pixel_error` pixels, and no less than theirs. O(n²).
std::vector<StandInBox> merge_stand_ins(std::vector<StandInBox> boxes, std::size_t most,
                                        double pixel_error = 2);

/// Its four walls and its top, about `origin`, axes parallel to the world's; no floor, which no one
/// sees from far away.
PolygonMesh mesh_of(const StandInBox& box);

constexpr int kStandInTriangles = 10;

}  // namespace colod
