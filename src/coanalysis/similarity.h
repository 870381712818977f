// Segments → descriptors → distances (paper section 3.2, dis, scale_d, Sim_co).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "planes/planes.h"
#include "segments/segments.h"

namespace colod {

/// What the co-analysis knows of a segment.
struct Descriptor {
  std::array<double, 64>
      d2{};  ///< histogram of pair distances of the whitened surface, range 0..6, sum 1
  Vec3 eigenvalues = Vec3::Zero();         ///< of the surface's covariance, m², falling
  double area = 0;                         ///< m²
  double volume = 0;                       ///< m³
  double extent = 0;                       ///< metres: standard deviation along the longest axis
  ElementKind kind = ElementKind::kPlain;  ///< of the segment
  bool is_flat =
      false;  ///< one plane, or less than 5 cm thick: whitening would make noise its shape
};

struct DescriptorOptions {
  int pairs = 100000;  ///< point pairs; below 50,000 the layers depend on the seed
  std::uint64_t seed =
      1;  ///< each segment's own seed is a hash of this, the building's name and the segment
};

/// One descriptor a segment, in order.
std::vector<Descriptor> describe_segments(const Planes& planes, const Segments& segments,
                                          const std::string& building,
                                          const DescriptorOptions& options = {});

/// What a scene that was analysed before learnt: the layers of its segments.
struct Prior {
  struct PriorBuilding {
    std::vector<Descriptor> segments;
    std::vector<int> layer;  ///< per segment, 0..layers − 1
  };
  int layers = 0;  ///< l_n of that scene
  std::vector<PriorBuilding> buildings;
};

/// dis(s, s') = eta ‖d2 − d2'‖₂ + ‖v_e − v_e'‖₁ / (‖v_e‖₁ + ‖v_e'‖₁). Symmetric, ≥ 0, 0 for equal
/// descriptors.
double segment_distance(const Descriptor& a, const Descriptor& b, double eta);
/// Sim = exp(−dis), in (0, 1].
double segment_similarity(const Descriptor& a, const Descriptor& b, double eta);

}  // namespace colod
