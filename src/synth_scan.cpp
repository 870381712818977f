#include "synth_internal.h"
namespace colod::synth {
void scan_neighbourhood(std::vector<SynthBuilding>&, const SynthOptions&) {}
}  // namespace colod::synth
