#include "blank.h"

#include <algorithm>

#include "owners.h"
#include "parameters.h"

namespace colod::bake {

using namespace parameters::bake;

namespace {

std::vector<Corners> triangles_of(const PolygonMesh& mesh, const Chart& chart) {
  std::vector<Corners> out;
  for (const int t : chart.triangles) {
    Corners c;
    for (int k = 0; k < 3; ++k) c.at[k] = chart.flat(mesh.vertices[mesh.triangles[t][k]]);
    c.orient();
    out.push_back(c);
  }
  return out;
}

SampleGrid grid_over(const Chart& chart) {
  const double step = std::max(chart.width / kMostProbes, chart.height / kProbes);
  const auto count = [&](double length) {
    return std::max(1, static_cast<int>(std::ceil(length / step)));
  };
  return {Vec2::Constant(0.5 * step), step, count(chart.width), count(chart.height)};
}

}  // namespace

bool is_blank(const PolygonMesh& mesh, const Chart& chart, const Sight& sight) {
  if (!(chart.height > 0)) return false;
  const std::vector<Corners> triangles = triangles_of(mesh, chart);
  const SampleGrid grid = grid_over(chart);
  const std::vector<Sighting> sightings = sight.look(grid, {});
  int asked = 0, found = 0;
  for (int y = 0; y < grid.rows; ++y)
    for (int x = 0; x < grid.columns; ++x) {
      const Vec2 q = grid.at(x, y);
      if (std::none_of(triangles.begin(), triangles.end(),
                       [&](const Corners& c) { return c.holds(q); }))
        continue;
      ++asked;
      found += sightings[grid.index(x, y)].face >= 0 || sight.may_be_near(q);
    }
  return asked >= kLeastAsked && found < kLeastSeen * asked;
}

}  // namespace colod::bake
