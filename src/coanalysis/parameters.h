// The numbers of the rules selection.*, clustering.* and layers.*.
// The registry in room `rules` says what each does and why it has its value.
#pragma once

#include <cstddef>

namespace colod::parameters::coanalysis {

constexpr double kPaperBound = 0.8, kRobustBound = 0.95;  // on f_r
constexpr int kKindsALayer = 4;
constexpr double kSameKind = 0.1;       // distance; samples of the same shape differ by up to 0.07
constexpr double kSizeTail = 0.1;       // of the segments, at both ends of the range of sizes
constexpr double kSmallPlanes = 0.03;   // of the area of layer 0's segments, together …
constexpr double kSmallPlane = 0.01;    // … and each of them
constexpr double kSpareShare = 0.005;   // of all planes' area: smaller ones never join layer 0 …
constexpr double kSparesShare = 0.01;   // … nor do planes that have less together
constexpr double kRoofShare = 0.1;      // of a relief's plan: such a roof is on each layer
constexpr double kThin = 0.05;          // metres: thinner is flat, and the whitening's floor
constexpr double kThinRelative = 0.02;  // of the longest axis

}  // namespace colod::parameters::coanalysis
