// Made-up scenes for the selection: a body, parts, details of a few kinds, overlapping coverage.
#pragma once

#include <random>

#include "coanalysis/selection.h"

namespace colod::test {

struct RandomScene {
  int buildings = 3, segments = 4;  ///< segments a building
  double overlap = 0.3;             ///< share of voxels that several segments enclose
  double body = 0.6;                ///< of the voxels, of the first segment
};

inline double uniform(std::mt19937_64& random) {
  return static_cast<double>(random() >> 11) * 0x1p-53;
}

/// Kinds 0..5 with their own histogram and size, and noise.
inline Descriptor random_descriptor(int kind, std::mt19937_64& random) {
  Descriptor d;
  double sum = 0;
  for (int b = 0; b < 64; ++b) {
    const double x = (b - 14.0 - 2 * kind) / (5 + kind);
    sum += d.d2[b] = std::exp(-0.5 * x * x) * (1 + 0.4 * uniform(random));
  }
  for (double& b : d.d2) b /= sum;
  const double size = std::pow(2.0, 2 - kind) * (0.8 + 0.4 * uniform(random));
  d.eigenvalues = size * Vec3(1, 0.6, 0.2 + 0.2 * uniform(random));
  d.extent = std::sqrt(d.eigenvalues[0]);
  d.volume = d.extent * d.extent * d.extent;
  d.area = 6 * size * (0.5 + uniform(random));
  return d;
}

inline std::vector<SelectionBuilding> random_scene(const RandomScene& scene, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<SelectionBuilding> buildings(scene.buildings);
  for (SelectionBuilding& b : buildings) {
    std::vector<double> part(scene.segments);
    for (int s = 0; s < scene.segments; ++s) {
      const int kind = s == 0 ? 0 : 1 + static_cast<int>(random() % 5);
      b.segments.push_back(random_descriptor(kind, random));
      if (s == 0) b.segments.back().area *= 8;
      part[s] = std::pow(uniform(random), 3.0) / (1 + kind) + 0.001;
    }
    double rest = 0;
    for (int s = 1; s < scene.segments; ++s) rest += part[s];
    if (rest > 0) part[0] = scene.body / (1 - scene.body) * rest;
    for (int s = 0; s < scene.segments; ++s)
      b.coverage.push_back({{s}, part[s] * (1 - scene.overlap)});
    for (int c = 0; c < scene.segments && scene.segments > 1; ++c) {
      std::vector<int> set;
      for (int s = 0; s < scene.segments; ++s)
        if (uniform(random) < 2.5 / scene.segments) set.push_back(s);
      if (!set.empty()) b.coverage.push_back({set, scene.overlap * part[set.back()] * 0.5});
    }
    double sum = 0;
    for (const Coverage& c : b.coverage) sum += c.share;
    for (Coverage& c : b.coverage) c.share /= sum;
  }
  return buildings;
}

}  // namespace colod::test
