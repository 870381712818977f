// The command line: each subcommand registers its options on an app and runs when it was named.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace colod::cli {

/// Runs the subcommand and returns the exit code. May throw Error.
using Run = std::function<int()>;

Run add_build(CLI::App& app);
Run add_plan(CLI::App& app);
Run add_segment(CLI::App& app);
Run add_analyze(CLI::App& app);
Run add_mesh(CLI::App& app);
Run add_export(CLI::App& app);
Run add_merge(CLI::App& app);
Run add_eval(CLI::App& app);
Run add_info(CLI::App& app);
Run add_synth(CLI::App& app);
Run add_preview(CLI::App& app);
Run add_rules(CLI::App& app);
Run add_view(CLI::App& app);

}  // namespace colod::cli
