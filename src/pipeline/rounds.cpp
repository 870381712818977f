// Based on: rounds/rounds.h.
// Differs: the paper's layers have no planes of their own.
// Notation: –
#include "rounds.h"

#include <algorithm>
#include <cmath>

#include "parameters.h"
#include "rounds/reduce.h"

namespace colod {
namespace {

using namespace parameters::layers;

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

/// A shape of which more than half is on the layer is there as a whole, and else the rows that
/// follow each other are together: a dome without some of its rings would be a crown.
std::vector<char> rows_on_layer(const Planes& planes, const std::vector<char>& is_in,
                                const RoundShape& reduced) {
  std::vector<int> chain;
  for (const RoundShape::Row& row : reduced.rows)
    chain.push_back(chain.empty() ? 0 : chain.back() + (row.is_joined ? 0 : 1));
  double whole = 0;  // m² on the layer less what is not
  std::vector<double> of_chain(reduced.rows.size(), 0);
  for (const RoundShape::Side& side : reduced.sides) {
    const double each = side.area / static_cast<double>(side.faces.size());
    for (const int face : side.faces) {
      const int p = planes.plane_of_item[face];
      const double area = p >= 0 && is_in[p] ? each : -each;
      whole += area, of_chain[chain[side.row]] += area;
    }
  }
  std::vector<char> is_row_in;
  for (const int c : chain) is_row_in.push_back(whole > 0 || of_chain[c] > 0);
  return is_row_in;
}

/// A plane that the side stands for; −1: none was large enough for one.
int plane_of(const Planes& planes, const RoundShape::Side& side) {
  int most = -1;
  for (const int face : side.faces) most = std::max(most, planes.plane_of_item[face]);
  return most;
}

/// A flat plane that ends a row of the shape: a gallery's floor, what is under an eave.
bool is_cap(const Plane& plane, const RoundShape& shape, const std::vector<char>& is_row_in) {
  if (std::abs(plane.normal.dot(shape.axis)) < kCapCosine) return false;
  const Eigen::Matrix3d back = shape.stretch.inverse();
  const double height = shape.axis.dot(back * plane.centroid - shape.center);
  double radius = -1;
  for (std::size_t r = 0; r < is_row_in.size(); ++r)
    for (const Vec2& end : {shape.rows[r].from, shape.rows[r].to})
      if (is_row_in[r] && std::abs(end.y() - height) < kCapReach)
        radius = std::max(radius, std::abs(end.x()) / std::cos(shape.step / 2));
  return radius >= 0 && std::all_of(plane.outline.vertices.begin(), plane.outline.vertices.end(),
                                    [&](const Vec3& v) {
                                      const Vec3 x = back * v - shape.center;
                                      return shape.axis.cross(x).norm() < radius + kCapReach;
                                    });
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
      if (side.area < kLeastDrawn * plane.area) continue;
      result.which.push_back(static_cast<int>(result.planes.planes.size()));
      result.real.push_back(plane_of(planes, side));
      result.planes.planes.push_back(std::move(plane));
      result.planes.is_side.push_back(1);
    }
    for (std::size_t p = 0; p < is_in.size(); ++p)
      if (!is_in[p] && !planes.is_side[p] && is_cap(planes.planes[p], reduced, is_row_in))
        is_in[p] = 1, result.which.push_back(static_cast<int>(p));
  }
  return result;
}

}  // namespace colod
