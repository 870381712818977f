// What the co-analysis made of the segments, for the report's page: clusters and similarities.
#pragma once

#include <functional>
#include <string>
#include <vector>

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

/// What the page counts of a segment.
struct PartFacts {
  int layer = 0;
  double extent = 0, area = 0;  ///< metres, m²
  bool is_flat = false;
};
std::vector<PartFacts> parts_of(const Building& building);

using DescriptorOf = std::function<Descriptor(std::size_t building, std::size_t segment)>;

/// The same of buildings that are not in memory; descriptors of the picked segments are asked for.
std::string parts_json(const std::vector<std::vector<PartFacts>>& buildings,
                       const DescriptorOf& descriptor_of, const Options& options);

}  // namespace colod
