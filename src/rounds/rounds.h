// Between `read` and `planes`: what a source draws as flat sides around an axis: domes, onion
// spires, cones, round towers, apses, barrel vaults.
//
// A round shape is a profile of straight rows, turned about an axis in equal steps, and then
// perhaps narrowed along one level direction: an elliptical dome. Where a row and a column meet
// lies one flat side. It is known as exactly as its file, and fewer rows and columns make the same
// shape regular again.
#pragma once

#include <vector>

#include "core/geometry.h"
#include "core/rules.h"
#include "shape.h"

namespace colod {

/// The round shapes of a mesh that is exact to the millimetre, largest evidence first; each face is
/// in one at most; elliptical ones by Rule::kEllipses. None in clouds and scans. Deterministic;
/// about 1 s for 50,000 curved edges.
std::vector<RoundShape> find_rounds(const Source& source, const RuleSet& rules = RuleSet::all());

}  // namespace colod
