// Inside room `planes`: points on the faces of a mesh, for rules that see points only.
#pragma once

#include <vector>

#include "core/geometry.h"
#include "planes.h"

namespace colod::regions {

/// A cloud on a mesh: points with their faces' normals.
struct FaceSamples {
  Source cloud;           ///< the source without its mesh
  std::vector<int> face;  ///< per point: the face that it lies on
};

/// Evenly over all faces that have an area, kSampleDensity a square metre, but not fewer than
/// kLeastSamples in all nor more than kMostSamples. Deterministic.
FaceSamples sample_faces(const Source& source);

/// From what was found on the samples to the mesh: a face belongs to the plane that most of its
/// points lie on; of equal ones the first. A face without points belongs to none.
void hand_to_faces(const Source& source, const FaceSamples& samples, Planes& planes);

}  // namespace colod::regions
