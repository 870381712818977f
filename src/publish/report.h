// report.json: what was done, building by building and layer by layer (DESIGN section 2).
#pragma once

#include <string>

#include "core/options.h"
#include "pipeline/pipeline.h"
#include "tally.h"

namespace colod {

struct RunTotals {
  double seconds = 0;
  std::uint64_t peak_memory_bytes = 0;
};

/// JSON text. Times and memory apart, the same input gives the same text.
std::string report_json(const Scene& scene, const Options& options, const RunTotals& totals);

/// The same in pieces, for buildings that are not all in memory: `before`, rows parted by commas,
/// a line's end and two spaces if there are any, `after`.
struct ReportFrame {
  std::string before, after;
};
/// `scene` without its buildings, of which `tally` is the sum.
ReportFrame report_frame(const Scene& scene, const Options& options, const RunTotals& totals,
                         const Tally& tally);
/// One building's.
std::string report_row(const Scene& scene, const Building& building);

/// Peak resident memory of this process so far.
std::uint64_t peak_memory_bytes();

}  // namespace colod
