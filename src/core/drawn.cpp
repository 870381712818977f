#include "drawn.h"

#include <cmath>

namespace colod {
namespace {

constexpr double kExactTurn = 1e-4;  // sine of the angle to the vertical, or to the plan

}  // namespace

double drawn_share(const Mesh& mesh) {
  double total = 0, exact = 0;
  for (const Face& f : mesh.faces) {
    const Vec3 cross = face_cross(mesh, f);
    const double length = cross.norm();
    total += length;
    const bool is_exact =
        std::abs(cross.z()) < kExactTurn * length || cross.head<2>().norm() < kExactTurn * length;
    if (is_exact) exact += length;
  }
  return total > 0 ? exact / total : 0;
}

}  // namespace colod
