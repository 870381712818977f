// The numbers of the rules visibility.*.
// The registry in room `rules` says what each does and why it has its value.
#pragma once

namespace colod::parameters::visibility {

constexpr double kBorderRatio = 1.5;  // of the planes' distance
// Of n_r: rays that meet inner sides at least, outer sides at most.
constexpr double kPartyInside = 0.35, kPartyOutside = 0.02;
constexpr double kSharpest = 0.5;  // corners sharper than some 40° move by less

}  // namespace colod::parameters::visibility
