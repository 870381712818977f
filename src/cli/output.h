// What `build` and `export` share: a finished scene to a folder, messages and an exit code.
#pragma once

#include <chrono>
#include <string>

#include "cli.h"
#include "log.h"
#include "output_options.h"

namespace colod::cli {

struct OutputArguments {
  std::string out;
  OutputOptions options;
};

void add_output_arguments(CLI::App& app, OutputArguments& a);

/// `depot` has the sources. Writes the files of all buildings and of the scene, report.html and
/// report.json; says what failed and what was done; returns the exit code. `start`: when the job
/// began. Throws Error{kOutput} for what cannot be written.
int write_all(Scene& scene, const Options& options, std::chrono::steady_clock::time_point start,
              Pictures pictures, Depot& depot, const OutputArguments& a, const Log& log);

/// All problems of a scene.
void log_problems(const Scene& scene, const Log& log);

}  // namespace colod::cli
