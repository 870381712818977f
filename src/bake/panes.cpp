// Based on: linear interpolation over a triangle; seen in parallel, a corner's weight at a place is
// the same on the triangle and on its picture.
#include "panes.h"

#include <algorithm>
#include <cmath>

#include "core/flat.h"
#include "parameters.h"

namespace colod::bake {

using namespace parameters::bake;

Probe::Holes holes_in(const LookSampler& sampler, Lens& lens) {
  if (!sampler.has_holes()) return {};
  return [&](int face, const Vec3& point) { return sampler.is_hole(face, point, lens); };
}

Panes::Panes(const Sight& sight, const SampleGrid& grid, const LookSampler& sampler, Lens& lens)
    : sight_(sight), grid_(grid), sampler_(sampler), lens_(lens), panes_(kPanes) {}

Pane Panes::made(int face) const {
  Pane pane;
  pane.face = face;
  pane.look = sampler_.look_at(face, grid_.step, lens_);
  pane.changes = lens_.changes();
  const std::array<Vec3, 3> corners = sight_.corners(face);
  std::array<Vec2, 3> at;
  for (std::size_t k = 0; k < 3; ++k) at[k] = (corners[k].head<2>() - grid_.begin) / grid_.step;
  const double area = cross(at[1] - at[0], at[2] - at[0]);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto across = static_cast<Eigen::Index>((k + 2) % 3);
    const Vec2 side = (at[(k + 1) % 3] - at[k]) / area;
    pane.base[across] = cross(side, Vec2(-at[k]));
    pane.right[across] = -side.y(), pane.down[across] = side.x();
    pane.offsets[static_cast<Eigen::Index>(k)] = corners[k].z();
  }
  return pane;
}

int Panes::about(const Vec2& at, const std::vector<Sighting>& sightings, double reach) {
  const int x = static_cast<int>(std::floor(at.x())), y = static_cast<int>(std::floor(at.y()));
  int best = -1, last = -1;
  double least = reach;
  for (int k = 0; k < 4; ++k) {
    const int column = std::clamp(x + k % 2, 0, grid_.columns - 1);
    const int row = std::clamp(y + k / 2, 0, grid_.rows - 1);
    const int face = sightings[grid_.index(column, row)].face;
    if (face < 0 || face == last) continue;
    const Pane& pane = of(last = face);
    const Vec3 weight = pane.weight(at);
    const double offset = std::abs(weight.dot(pane.offsets));
    if (weight.minCoeff() >= -kOnEdge && offset < least) best = face, least = offset;
  }
  return best;
}

}  // namespace colod::bake
