// What was parted from a building's source, and why: nothing is lost without a figure.
#pragma once

#include <vector>

#include "geometry.h"

namespace colod {

/// As in report.json: "ground", "floater".
const char* to_string(LeftOut::Reason reason);

/// The items of `source` (faces, or points) whose flag is set, against the others. `before` is what
/// earlier rooms parted from the same source, so that shares are of the whole input. Runs in
/// parallel: O(vertices left out · log faces).
LeftOut measure_left_out(const Source& source, const std::vector<char>& is_left_out,
                         LeftOut::Reason reason, const std::vector<LeftOut>& before);

}  // namespace colod
