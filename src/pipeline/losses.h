// What a building lost on its way: the measures between its last mesh and its report.
#pragma once

#include "measure/solid.h"
#include "pipeline.h"

namespace colod {

/// The source without what was taken for floaters; of a cloud its planes' outlines.
Surface surface_of(const Building& building);

/// Adds to `left_out` the bodies of the source that the finest layer does not stand for, and the
/// shares of the volume; sets `solid`. The finest layer is still in the building's frame. Of a
/// cloud's surface steep planes do not count.
void weigh_finest(const Surface& source, Building& building);

/// Of a building that failed as a whole nothing more is lost.
void forget_losses(Building& building);

/// Why the finest layer is no building's (measure/scene_part.h); empty: it is one.
std::string judge_building(const Surface& source, const Building& building);

/// Warnings of a ragged finest layer, and of what was lost or left out over a stated share
/// (scene/left_out.h), by falling share.
std::vector<std::string> loss_warnings(const Building& building);

}  // namespace colod
