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

/// Where a building, or a camera that may see it, is. `to_street`: the horizontal unit direction in
/// which it looks.
Box scan_reach(const Box& building, const Vec3& to_street);

/// Replaces the buildings' clean models by simulated scans of them. `number`: of the first one.
/// `around`: the models of all that stands in their scan_reach, their own among them. `whole`: the
/// neighbourhood's box. `to_street` per building.
void scan_buildings(std::vector<SynthBuilding>& buildings, int number, const Mesh& around,
                    const Box& whole, const std::vector<Vec3>& to_street,
                    const SynthOptions& options);

}  // namespace colod::synth
