// What `build` and `export` share: a finished scene to files, messages and an exit code.
#pragma once

#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "../../exporters/exporter.h"
#include "../pipeline.h"
#include "cli.h"
#include "log.h"

namespace colod::cli {

struct OutputArguments {
  std::string out;
  std::vector<std::string> formats = {"glb", "3dtiles"};
  Compression compression = Compression::kDraco;
  double quantization = 0.01, target_sse = 16, pixel_error = 2;
  std::string crs, origin;   ///< empty: what lies beside the sources says
  bool has_no_page = false;  ///< no report.html
};

/// Per building of the scene, PNGs (report_pictures.h).
using Pictures = std::vector<std::vector<std::string>>;

void add_output_options(CLI::App& app, OutputArguments& a);

/// Writes a building's files when its layers are done, while others are computed, notes the seconds
/// in its timings and passes everything on. drop throws Error{kOutput}.
class Press : public Depot {
 public:
  Press(const OutputArguments& a, Depot& depot);
  void put(Building& building) override;
  void get(Building& building) override;
  void drop(Building& building) override;

  /// After the last building: what is about the whole scene, in its order, and its seconds; says
  /// where on Earth the tileset is, if anywhere. Throws Error{kOutput}.
  void finish(Scene& scene, const Log& log);

 private:
  const OutputArguments& arguments_;
  Depot& depot_;
  std::mutex mutex_;
  std::map<std::string, ExportBuilding> buildings_;
};

/// Failures as errors, the rest as warnings, one line each.
void report_problems(const Scene& scene, const Log& log);

/// 0, 1, or 3 and 4 when nothing could be read or made.
int exit_code(const Scene& scene);

/// Writes report.html and report.json, says what failed and what was done; returns the exit code.
int finish(const Scene& scene, const Options& options, double seconds, Pictures pictures,
           const OutputArguments& a, const Log& log);

}  // namespace colod::cli
