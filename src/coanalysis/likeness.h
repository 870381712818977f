// Inside room `coanalysis`: what kind a segment is of that no detector told.
#pragma once

#include <vector>

#include "similarity.h"

namespace colod {

/// Per segment its own kind, or that of the elements that it repeats: of the five nearest by shape
/// and context, whatever their size, at least three are of that kind and near enough.
/// Deterministic; uses threads.
std::vector<ElementKind> likely_kinds(const std::vector<Descriptor>& segments, double eta);

}  // namespace colod
