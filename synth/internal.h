// Inside the synth room: from clean models to scans.
#pragma once

#include <vector>

#include "synth.h"

namespace colod::synth {

/// A point of a scan.
struct Sample {
  Vec3 point, normal;
  int object = -1;
  Vec3 to_camera = Vec3::Zero();  ///< of the camera that sees it best; zero: seen by less than two
};

/// Triangles over the samples (indices), facing as the samples do: a manifold with borders, small
/// holes closed, small pieces dropped. No side is longer than `longest_edge`, but for closed holes.
std::vector<Face> reconstruct(const std::vector<Sample>& samples, double longest_edge);

/// Replaces every building's clean model by a simulated scan of it among the others.
/// `to_street[i]`: the horizontal unit direction in which building i looks.
void scan_neighbourhood(std::vector<SynthBuilding>& buildings, const std::vector<Vec3>& to_street,
                        const SynthOptions& options);

}  // namespace colod::synth
