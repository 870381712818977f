// What `build` and `export` share: a finished scene to files, messages and an exit code.
#pragma once

#include <string>
#include <vector>

#include "cli.h"
#include "exporters/exporter.h"
#include "log.h"
#include "pipeline/pipeline.h"

namespace colod::cli {

struct OutputArguments {
  std::string out;
  std::vector<std::string> formats = {"glb", "3dtiles"};
  Compression compression = Compression::kDraco;
  double quantization = 0.01, target_sse = 16;
  SwitchOptions switching;
  std::string crs, origin;   ///< empty: what lies beside the sources says
  bool has_no_page = false;  ///< no report.html
};

/// Per building of the scene, PNGs (publish/report_pictures.h).
using Pictures = std::vector<std::vector<std::string>>;

void add_output_options(CLI::App& app, OutputArguments& a);

/// With the rounding of what is written.
SwitchOptions switch_options(const OutputArguments& a);

/// The sights of a prior's buildings; none, with a warning, when it has no meshes. Throws
/// Error{kUsage} when its number of layers is another.
std::vector<BuildingSights> read_sights(const std::string& prior, int layers, const Log& log);

/// Throws Error{kUsage} when --crs and --origin name no place; before the work rather than after.
void check_place(const OutputArguments& a);

/// After decide_switches: writes the files of all buildings and of the scene, notes their seconds
/// and bytes, and says where on Earth the tileset is, if anywhere. A building that cannot be
/// encoded becomes a failed one. Throws Error{kOutput} for what cannot be written.
void write_outputs(Scene& scene, const OutputArguments& a, const Log& log);

/// Failures as errors, the rest as warnings, one line each.
void report_problems(const Scene& scene, const Log& log);

/// 0, 1, or 3 and 4 when nothing could be read or made.
int exit_code(const Scene& scene);

/// Writes report.html and report.json, says what failed and what was done; returns the exit code.
int finish(const Scene& scene, const Options& options, double seconds, Pictures pictures,
           const OutputArguments& a, const Log& log);

}  // namespace colod::cli
