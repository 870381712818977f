// Inside the synth room: from clean models to scans.
#pragma once

#include <vector>

#include "synth.h"

namespace colod::synth {

/// Replaces every building's clean model by a simulated scan of it among the others.
/// `to_street[i]`: the horizontal unit direction in which building i looks.
void scan_neighbourhood(std::vector<SynthBuilding>& buildings, const std::vector<Vec3>& to_street,
                        const SynthOptions& options);

}  // namespace colod::synth
