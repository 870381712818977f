// What the co-analysis made of the segments, for the report's page: clusters and similarities.
#pragma once

#include <string>

#include "core/options.h"
#include "pipeline/pipeline.h"

namespace colod {

/// JSON text:
///   clusters   per layer: segments, buildings (that have any), flat, extent (median, metres), area
///   (m²) members    per building, per layer: segments similarity (absent without segments) of at
///   most 320 segments, in the order of layers and there
///              of falling extent; beyond 320 evenly picked: layer, building, segment (each per
///              picked one), extent, and values: base64 of a byte a pair (255 · Sim), row by row,
///              from the diagonal on
///   between    per pair of layers the mean of these similarities, a segment's with itself left
///   out;
///              null: no pair
/// Segments on layers that `options` has not are left out. A few milliseconds whatever the scene's
/// size; the same text for any number of threads.
std::string parts_json(const Scene& scene, const Options& options);

}  // namespace colod
