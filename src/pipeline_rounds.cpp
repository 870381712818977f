// Based on: rounds.h.
// Differs: the paper's layers have no planes of their own.
// Notation: –
#include "pipeline_rounds.h"

#include <algorithm>

namespace colod {
namespace {

constexpr double kLeastDrawn = 0.25;  // of a new side: less is what a house leaves of it

double area_of(const Outline& outline) {
  double sum = 0;
  for (const Face& f : outline.triangles) {
    const Vec3 &a = outline.vertices[f[0]], &b = outline.vertices[f[1]],
               &c = outline.vertices[f[2]];
    sum += 0.5 * (b - a).cross(c - a).norm();
  }
  return sum;
}

Plane side_plane(const RoundShape& shape, const RoundShape::Side& side) {
  Plane plane;
  plane.normal = shape.normal(side.row, side.column);
  plane.offset = shape.offset(side.row, side.column);
  for (const Vec3& x : shape.corners(side.row, side.column)) {
    plane.outline.vertices.push_back(x - plane.signed_distance(x) * plane.normal);
    plane.centroid += 0.25 * plane.outline.vertices.back();
  }
  plane.outline.rings = {{0, 1, 2, 3}};
  plane.outline.triangles = {{0, 1, 2}, {0, 2, 3}};
  plane.area = area_of(plane.outline);
  plane.items = side.faces;
  return plane;
}

/// Rows that follow each other are on the layer together, when half of what they stand for is: a
/// dome without some of its rings would be a crown.
std::vector<char> rows_on_layer(const Planes& planes, const std::vector<char>& is_in,
                                const RoundShape& reduced) {
  std::vector<int> chain;
  for (const RoundShape::Row& row : reduced.rows)
    chain.push_back(chain.empty() ? 0 : chain.back() + (row.is_joined ? 0 : 1));
  std::vector<double> balance(reduced.rows.size(),
                              0);  // per chain: m² on the layer − m² that are not
  for (const RoundShape::Side& side : reduced.sides) {
    const double each = side.area / static_cast<double>(side.faces.size());
    for (const int face : side.faces) {
      const int p = planes.plane_of_item[face];
      balance[chain[side.row]] += p >= 0 && is_in[p] ? each : -each;
    }
  }
  std::vector<char> is_row_in;
  for (const int c : chain) is_row_in.push_back(balance[c] > 0);
  return is_row_in;
}

}  // namespace

void mark_sides(const std::vector<RoundShape>& shapes, Planes& planes) {
  planes.is_side.assign(shapes.empty() ? 0 : planes.planes.size(), 0);
  for (const RoundShape& shape : shapes)
    for (const RoundShape::Side& side : shape.sides)
      for (const int face : side.faces)
        if (const int p = planes.plane_of_item[face]; p >= 0) planes.is_side[p] = 1;
}

ReducedLayer reduce_layer(const Planes& planes, const std::vector<int>& layer_planes,
                          const std::vector<RoundShape>& shapes, double turn) {
  ReducedLayer result{planes, {}, {}};
  std::vector<char> is_in(planes.planes.size(), 0);
  for (const int p : layer_planes) {
    is_in[p] = 1;
    if (!planes.is_side[p]) result.which.push_back(p);
  }
  for (std::size_t p = 0; p < planes.planes.size(); ++p) result.real.push_back(static_cast<int>(p));
  for (const RoundShape& shape : shapes) {
    const RoundShape reduced = reduce_round(shape, turn);
    const std::vector<char> is_row_in = rows_on_layer(planes, is_in, reduced);
    for (const RoundShape::Side& side : reduced.sides) {
      if (!is_row_in[side.row]) continue;
      for (const int face : side.faces)
        if (const int p = planes.plane_of_item[face]; p >= 0) result.planes.planes[p].outline = {};
      Plane plane = side_plane(reduced, side);
      const int real = planes.plane_of_item[side.faces[side.faces.size() / 2]];
      if (real < 0 || side.area < kLeastDrawn * plane.area) continue;
      result.which.push_back(static_cast<int>(result.planes.planes.size()));
      result.real.push_back(real);
      result.planes.planes.push_back(std::move(plane));
      result.planes.is_side.push_back(1);
    }
  }
  return result;
}

}  // namespace colod
