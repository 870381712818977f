// Whether two meshes have the same main shape: how their outlines overlap, in one frame.
#pragma once

#include "core/geometry.h"

namespace colod {

struct SilhouetteOverlap {
  double mean = 0, worst = 0;  ///< 0..1 over the views: intersection over union of what is covered
};

/// From the ten directions of the upright light field (light_field.h) and from above, each of 256 ×
/// 256 pixels around both. Both need a finite face with an area; throws as describe_light_fields.
SilhouetteOverlap overlap_silhouettes(const Mesh& a, const Mesh& b);

}  // namespace colod
