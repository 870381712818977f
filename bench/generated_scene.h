// Made-up descriptors of a whole town, for measuring the co-analysis alone.
#pragma once

#include <cmath>
#include <random>

#include "coanalysis/selection.h"

namespace colod::bench {

inline double uniform(std::mt19937_64& random) {
  return static_cast<double>(random() >> 11) * 0x1p-53;
}

/// Of one of the kinds 0 (body), 1 (roof), 2…7 (details): its own histogram and size, noise as
/// between two samplings and scans of one object, sizes of a kind within a factor of about 2.
inline Descriptor generated_descriptor(int kind, std::mt19937_64& random) {
  Descriptor d;
  const double shift = 2 * uniform(random), width = 6 + 0.7 * kind;
  double sum = 0;
  for (int b = 0; b < 64; ++b) {
    const double x = (b - 18.0 - 1.5 * kind - shift) / width;
    sum += d.d2[b] = std::exp(-0.5 * x * x) * (1 + 0.15 * uniform(random));
  }
  for (double& b : d.d2) b /= sum;
  const double extent = 4 * std::pow(0.62, kind) * (0.7 + 0.7 * uniform(random));
  const double second = 0.3 + 0.5 * uniform(random), third = 0.1 + 0.4 * uniform(random);
  d.eigenvalues = extent * extent * Vec3(1, second, second * third);
  d.extent = extent;
  d.volume = 8 * extent * extent * extent * std::sqrt(second * second * third);
  d.area = 24 * extent * extent * std::sqrt(second);
  d.is_flat = uniform(random) < 0.1;
  return d;
}

/// `count` segments over the buildings as evenly as can be: a body with 45–75 % of the voxels, a
/// roof with 10–30 %, details; a tenth of the voxels is enclosed by two segments.
inline std::vector<SelectionBuilding> generated_scene(int buildings, int count,
                                                      std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<SelectionBuilding> scene(buildings);
  for (int i = 0; i < buildings; ++i) {
    SelectionBuilding& b = scene[i];
    const int n = count / buildings + (i < count % buildings);
    std::vector<double> part(n);
    double details = 0;
    for (int s = 0; s < n; ++s) {
      const int kind = s < 2 ? s : 2 + static_cast<int>(random() % 6);
      b.segments.push_back(generated_descriptor(kind, random));
      part[s] = s == 0   ? 0.45 + 0.3 * uniform(random)
                : s == 1 ? 0.1 + 0.2 * uniform(random)
                         : std::pow(0.5, kind) * (0.2 + uniform(random));
      if (s > 1) details += part[s];
    }
    for (int s = 2; s < n; ++s) part[s] *= (1 - part[0] - part[1]) / details;
    for (int s = 0; s < n; ++s) {
      b.coverage.push_back({{s}, 0.9 * part[s]});
      if (s > 0) b.coverage.push_back({{0, s}, 0.1 * part[s]});
    }
  }
  return scene;
}

}  // namespace colod::bench
