// report.json: what was done, building by building and layer by layer (DESIGN section 2).
#pragma once

#include <string>

#include "core/options.h"
#include "pipeline/pipeline.h"

namespace colod {

struct RunTotals {
  double seconds = 0;
  std::uint64_t peak_memory_bytes = 0;
};

/// JSON text. Times and memory apart, the same input gives the same text.
std::string report_json(const Scene& scene, const Options& options, const RunTotals& totals);

/// Peak resident memory of this process so far.
std::uint64_t peak_memory_bytes();

}  // namespace colod
