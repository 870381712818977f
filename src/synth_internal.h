// Inside the synth room: from clean models to scans.
#pragma once

#include <vector>

#include "synth.h"

namespace colod::synth {

/// Replaces every building's clean model by a simulated scan of it among the others.
void scan_neighbourhood(std::vector<SynthBuilding>& buildings, const SynthOptions& options);

}  // namespace colod::synth
