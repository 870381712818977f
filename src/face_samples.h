// Points spread over a mesh's faces, for measures by area.
#pragma once

#include <algorithm>
#include <cmath>

#include "geometry.h"

namespace colod {

/// Calls visit(point, m² that it stands for) at points of the face about `spacing` metres apart, at
/// most 64 along an edge. Nothing for a face without an area or with a place that is not finite.
template <typename Visit>
void sample_face(const Mesh& m, const Face& f, double spacing, const Visit& visit) {
  constexpr int kMostSteps = 64;
  const Vec3 &a = m.vertices[f[0]], &b = m.vertices[f[1]], &c = m.vertices[f[2]];
  const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  const double area = face_area(m, f);
  if (!std::isfinite(longest) || !(area > 0)) return;
  const double steps = std::min(std::ceil(longest / spacing), 1.0 * kMostSteps);
  const int n = std::max(1, static_cast<int>(steps));
  for (int i = 0; i < n; ++i)
    for (int j = 0; i + j < n; ++j)
      for (const double third : {1.0 / 3, 2.0 / 3}) {  // of n² equal triangles, the middles
        const double s = (i + third) / n, t = (j + third) / n;
        if (s + t < 1) visit(Vec3(a + s * (b - a) + t * (c - a)), area / (n * n));
      }
}

}  // namespace colod
