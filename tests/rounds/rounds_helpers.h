// Round things for tests: profiles turned about the z axis, and a vault.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "meshes.h"

namespace colod::test {

/// Closed body: `profile` (radius, height) from bottom to top in `sides` steps about z.
inline Mesh turned_mesh(const std::vector<Vec2>& profile, int sides, double phase = 0) {
  Mesh m;
  std::vector<std::vector<int>> rings;
  const auto add = [&m](const Vec3& p) {
    m.vertices.push_back(p);
    return static_cast<int>(m.vertices.size()) - 1;
  };
  for (const Vec2& p : profile) {
    rings.emplace_back();
    const int apex = p.x() < 1e-9 ? add({0, 0, p.y()}) : -1;
    for (int k = 0; k < sides; ++k) {
      const double a = phase + 2 * std::numbers::pi * k / sides;
      rings.back().push_back(apex >= 0 ? apex
                                       : add({p.x() * std::cos(a), p.x() * std::sin(a), p.y()}));
    }
  }
  const auto face = [&m](int a, int b, int c) {
    if (a != b && b != c && c != a) m.faces.push_back({a, b, c});
  };
  for (std::size_t r = 0; r + 1 < rings.size(); ++r)
    for (int k = 0; k < sides; ++k) {
      const int next = (k + 1) % sides;
      face(rings[r][k], rings[r][next], rings[r + 1][next]);
      face(rings[r][k], rings[r + 1][next], rings[r + 1][k]);
    }
  for (int k = 1; k + 1 < sides; ++k) {
    face(rings.front()[0], rings.front()[k + 1], rings.front()[k]);
    face(rings.back()[0], rings.back()[k], rings.back()[k + 1]);
  }
  return m;
}

/// A half ball of `rows` rows on a drum of height `drum`.
inline Mesh dome_mesh(double radius, int sides, int rows, double drum, double phase = 0) {
  std::vector<Vec2> profile = {{radius, 0}};
  for (int r = 0; r <= rows; ++r) {
    const double a = std::numbers::pi / 2 * r / rows;
    profile.emplace_back(r < rows ? radius * std::cos(a) : 0, drum + radius * std::sin(a));
  }
  return turned_mesh(profile, sides, phase);
}

/// A drum, a bulb that bends both ways, and a tip.
inline Mesh onion_mesh(double radius, int sides, int rows) {
  std::vector<Vec2> profile = {{0.8 * radius, 0}, {0.8 * radius, 3}};
  for (int r = 1; r <= rows; ++r) {
    const double t = static_cast<double>(r) / rows;
    const double bulb = 0.8 + 0.315 * std::sin(std::numbers::pi * std::min(1.0, 1.35 * t));
    const double tip = 0.1 * std::sin(std::numbers::pi * t) * (1 - t);
    profile.emplace_back(r < rows ? radius * (bulb * std::pow(1 - t, 0.9) + tip) : 0,
                         3 + 3 * radius * t);
  }
  return turned_mesh(profile, sides);
}

/// A hall of w × l whose roof is half a barrel of `sides` sides, axis along y; without its floor.
inline Mesh vault_mesh(double w, double l, double wall, int sides) {
  std::vector<Vec2> section = {{w / 2, 0}};
  for (int k = 0; k <= sides; ++k) {
    const double a = std::numbers::pi * k / sides;
    section.emplace_back(w / 2 * std::cos(a), wall + w / 2 * std::sin(a));
  }
  section.emplace_back(-w / 2, 0);
  Mesh m;
  const int n = static_cast<int>(section.size());
  for (const double y : {0.0, l})
    for (const Vec2& p : section) m.vertices.emplace_back(p.x(), y, p.y());
  for (int k = 0; k + 1 < n; ++k) {
    m.faces.push_back({k, n + k + 1, k + 1});
    m.faces.push_back({k, n + k, n + k + 1});
  }
  for (int k = 1; k + 1 < n; ++k) {
    m.faces.push_back({0, k, k + 1});
    m.faces.push_back({n, n + k + 1, n + k});
  }
  return m;
}

}  // namespace colod::test
