// Based on: rounds.h.
// Differs: the same under both rules.
// Notation: none.
#include "shape.h"

#include <cmath>

namespace colod {

Vec3 RoundShape::direction(int column) const {
  const double azimuth = column * step;
  return std::cos(azimuth) * across + std::sin(azimuth) * axis.cross(across);
}

Vec3 RoundShape::normal(int row, int column) const {
  const Vec2 n = rows[row].normal();
  return (stretch.inverse().transpose() * (n.x() * direction(column) + n.y() * axis)).normalized();
}

double RoundShape::offset(int row, int column) const {
  const Vec2& x = rows[row].from;
  return normal(row, column).dot(stretch * (center + x.x() * direction(column) + x.y() * axis));
}

std::array<Vec3, 4> RoundShape::corners(int row, int column) const {
  const Vec3 out = direction(column), beside = axis.cross(out);
  const auto at = [&](const Vec2& x, double side) {
    return Vec3(stretch * (center + x.x() * out + x.y() * axis +
                           side * std::abs(x.x()) * std::tan(step / 2) * beside));
  };
  const Row& r = rows[row];
  return {at(r.from, -1), at(r.from, 1), at(r.to, 1), at(r.to, -1)};
}

}  // namespace colod
