// *Based on:* meshes of digital surface models, as many drone scenes are: one height a place.
//
// *Differs:* no --rules here.
//
// *Notation:* none.
#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/rays.h"
#include "drone.h"

namespace colod::synth {
namespace {

// Set so that edges, residuals and leaning walls are those of real height fields with edges of 0.4
// m.
constexpr double kSpacing = 0.8;  // of the median edge, which diagonals and walls lengthen
constexpr double kSidestep =
    0.24;                         // of the spacing, to both sides; from 0.25 on triangles turn over
constexpr double kAstray = 0.5;   // of the spacing that a height comes from beside its place
constexpr double kEvened = 0.42;  // of a place's height that its four neighbours decide

struct Grid {
  int columns, rows;

  int at(int x, int y) const { return y * columns + x; }
};

/// Melts edges a little, as matching windows do.
void blur(Mesh& mesh, const Grid& grid) {
  std::vector<double> height(mesh.vertices.size());
  for (int y = 0; y < grid.rows; ++y)
    for (int x = 0; x < grid.columns; ++x) {
      const auto z = [&](int i, int k) {
        return mesh
            .vertices[grid.at(std::clamp(i, 0, grid.columns - 1), std::clamp(k, 0, grid.rows - 1))]
            .z();
      };
      height[grid.at(x, y)] = (1 - kEvened) * z(x, y) +
                              kEvened / 4 * (z(x - 1, y) + z(x + 1, y) + z(x, y - 1) + z(x, y + 1));
    }
  for (std::size_t v = 0; v < height.size(); ++v) mesh.vertices[v].z() = height[v];
}

/// Each square by the diagonal over which it folds less.
void add_squares(Mesh& mesh, const Grid& grid) {
  for (int y = 0; y + 1 < grid.rows; ++y)
    for (int x = 0; x + 1 < grid.columns; ++x) {
      const int a = grid.at(x, y), b = grid.at(x + 1, y);
      const int c = grid.at(x + 1, y + 1), d = grid.at(x, y + 1);
      const auto drop = [&](int i, int k) {
        return std::abs(mesh.vertices[i].z() - mesh.vertices[k].z());
      };
      if (drop(a, c) <= drop(b, d)) {
        mesh.faces.push_back({a, b, c});
        mesh.faces.push_back({a, c, d});
      } else {
        mesh.faces.push_back({a, b, d});
        mesh.faces.push_back({b, c, d});
      }
    }
}

}  // namespace

Mesh make_field(const Mesh& soup, const Flight& flight, Random& random) {
  constexpr double kAbove = 5, kInside = 0.01;  // m
  const Box box = bounding_box(soup.vertices);
  const double spacing = kSpacing * flight.edge;
  const auto places = [&](double length) {
    return std::max(2, static_cast<int>((length - 2 * kInside) / spacing));
  };
  const Grid grid = {places(box.size().x()), places(box.size().y())};
  Mesh mesh;
  for (int y = 0; y < grid.rows; ++y)
    for (int x = 0; x < grid.columns; ++x)
      mesh.vertices.emplace_back(
          box.min.x() + (x + 0.5 + random.uniform(-kSidestep, kSidestep)) * spacing,
          box.min.y() + (y + 0.5 + random.uniform(-kSidestep, kSidestep)) * spacing, box.min.z());
  std::vector<Vec2> astray;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    astray.emplace_back(random.uniform(-kAstray, kAstray), random.uniform(-kAstray, kAstray));
  const RayScene scene(soup);
  parallel_for(
      mesh.vertices.size(),
      [&](std::size_t v) {
        Vec3& p = mesh.vertices[v];
        const Vec2 from = p.head<2>() + spacing * astray[v];
        const Vec3 eye(from.x(), from.y(), box.max.z() + kAbove);
        const RayHit hit = scene.first_hit(eye, -Vec3::UnitZ());
        if (hit) p.z() = eye.z() - hit.distance;
      },
      256);
  blur(mesh, grid);
  add_squares(mesh, grid);
  return mesh;
}

}  // namespace colod::synth
