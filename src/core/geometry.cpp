#include "geometry.h"

#include <cmath>

namespace colod {

Box bounding_box(const std::vector<Vec3>& points) {
  Box box;
  for (const Vec3& p : points) box.extend(p);
  return box;
}

CornerWeights::CornerWeights(const Mesh& m, const Face& f) {
  const Vec3 normal = face_cross(m, f);
  const double square = normal.squaredNorm();
  if (!(square > 0)) return;
  const Vec3 &a = m.vertices[f[0]], &b = m.vertices[f[1]], &c = m.vertices[f[2]];
  first_ = a;
  rise_ = {(c - a).cross(normal) / square, normal.cross(b - a) / square};
  is_flat_ = false;
}

double surface_area(const Mesh& m) {
  double area = 0;
  for (const Face& f : m.faces) area += face_area(m, f);
  return area;
}

double signed_volume(const Mesh& m) {
  if (m.vertices.empty()) return 0;
  const Vec3 o = m.vertices.front();  // a local apex keeps digits when coordinates are large
  double volume = 0;
  for (const Face& f : m.faces)
    volume += (m.vertices[f[0]] - o).dot((m.vertices[f[1]] - o).cross(m.vertices[f[2]] - o));
  return volume / 6;
}

std::array<Vec3, 2> plane_basis(const Vec3& normal) {
  const double horizontal = std::hypot(normal.x(), normal.y());
  const Vec3 u = horizontal > 1e-6 ? Vec3(-normal.y() / horizontal, normal.x() / horizontal, 0)
                                   : Vec3(Vec3::UnitX());
  const Vec3 v = normal.cross(u).normalized();
  return {v.cross(normal), v};
}

}  // namespace colod
