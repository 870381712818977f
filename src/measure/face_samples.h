// Points spread over a mesh's surface, for measures by area.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/geometry.h"
#include "core/spread.h"

namespace colod {

struct SurfaceSample {
  Vec3 point;
  int face;  ///< of the mesh
};

/// One point for every `spacing`² of the surface, in the order of the faces; of faces that are
/// smaller every so many get one. At most 4096 on a face; faces with a place that is not finite get
/// none.
inline std::vector<SurfaceSample> spread_over(const Mesh& m, double spacing) {
  constexpr double kMost = 4096;
  std::vector<SurfaceSample> samples;
  double due = 0.5;  // of a sample
  for (std::size_t i = 0; i < m.faces.size(); ++i) {
    const Face& f = m.faces[i];
    const double area = face_area(m, f);
    if (!std::isfinite(area)) continue;
    due += std::min(kMost, area / (spacing * spacing));
    for (int k = 1; due >= 1; ++k, --due)
      samples.push_back(
          {spread_on_triangle(m.vertices[f[0]], m.vertices[f[1]], m.vertices[f[2]], k),
           static_cast<int>(i)});
  }
  return samples;
}

}  // namespace colod
