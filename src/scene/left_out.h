// What was parted from a building's source, and why: nothing is lost without a figure.
#pragma once

#include <vector>

#include "core/geometry.h"

namespace colod {

/// As in report.json: "ground", "floater", "inside", "lost".
const char* to_string(LeftOut::Reason reason);

/// Of the input's volume: a body that holds more and is gone is a building's failure. A storey, a
/// wing and a house of a row hold more, a chimney and a dormer less.
constexpr double kMostLostVolume = 0.02;
/// Of the input's area, likewise, of open pieces: a roof or a facade holds more. Of 72 airborne
/// clouds, which were looked at, three lost more: a wing, an annex and what stands over a terrace.
constexpr double kMostLostSurface = 0.1;

/// Whether a body is gone, for whatever reason.
bool is_loss(const LeftOut& left_out);

/// The share (of the volume, else of the area) that a warning stands first for, if it is more than
/// what goes unasked: any lost body; pieces afloat over 2 % (of 72 airborne clouds and 16 scans
/// none has more than 1.3 %); ground over half of the input (both photogrammetry meshes with ground
/// have up to 36 %); the inside never, since furniture may be most of a model. 0: no warning.
double warning_weight(const LeftOut& left_out);

/// All of them together: sums, and of distances the largest; unknown volumes do not count.
LeftOut total_of(const std::vector<LeftOut>& parts);

/// The items of `source` (faces, or points) whose flag is set, against the others. `before` is what
/// earlier rooms parted from the same source, so that shares are of the whole input. `volume` is
/// that of the closed pieces among the faces; none for the ground. Runs in parallel: O(vertices
/// left out · log faces).
LeftOut measure_left_out(const Source& source, const std::vector<char>& is_left_out,
                         LeftOut::Reason reason, const std::vector<LeftOut>& before);

}  // namespace colod
