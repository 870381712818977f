// Inside room `rounds`: the sides of a shape whose axis and columns are known.
#pragma once

#include <numbers>
#include <vector>

#include "core/geometry.h"
#include "parameters.h"
#include "shape.h"

namespace colod::rounds {

using namespace parameters::rounds;

/// The faces of a mesh with their planes.
struct Facets {
  const Mesh& mesh;
  std::vector<Vec3> normal;    ///< unit
  std::vector<double> area;    ///< m²; 0: degenerate
  std::vector<char> is_taken;  ///< of a shape that was looked at
  double total_area = 0;
};
Facets collect_facets(const Mesh& mesh);

/// A right-handed frame whose w is an axis.
struct Axes {
  Vec3 u, v, w;
  Vec2 flat(const Vec3& x) const { return {u.dot(x), v.dot(x)}; }
};

/// Finds the rows of a shape whose columns are known, and the faces of each side: rows that one of
/// `founders` lies on. False: there are none.
bool find_sides(const Facets& facets, const std::vector<int>& founders, RoundShape& shape);

}  // namespace colod::rounds
