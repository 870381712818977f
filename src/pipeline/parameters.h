// The numbers of the rules rounds.layers, extraction.tolerance and chain.volume.
// The registry in room `rules` says what each does and why it has its value.
#pragma once

namespace colod::parameters::layers {

constexpr double kTolerance = 0.01;        // of the diagonal, on layer 0; half on each finer one
constexpr double kLeastTolerance = 0.001;  // of the diagonal, on the finest layer
constexpr double kVolumeChange = 0.2;      // of the finer layer's volume
constexpr int kSides = 8;  // of round shapes on layer 0; twice as many on each finer one
constexpr double kCapCosine = 0.99999;  // between a cap's normal and the axis
constexpr double kCapReach = 0.01;      // metres that a cap may be off its row's end
constexpr double kLeastDrawn = 0.25;    // of a new side: less is what a house leaves of it

}  // namespace colod::parameters::layers
