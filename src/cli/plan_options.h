// The options by which stages work on a plan's cells instead of named files.
#pragma once

#include <string>

#include "cli.h"
#include "plan/plan.h"

namespace colod::cli {

struct PlanArguments {
  std::string path;   ///< of plan.json; empty: none
  std::string shard;  ///< "I/N"; empty: what the environment says, else all cells
};

inline void add_plan_options(CLI::App& app, PlanArguments& a, bool is_sharded) {
  app.add_option("--plan", a.path, "plan.json of colod plan: its cells instead of named files")
      ->check(CLI::ExistingFile);
  if (is_sharded)
    app.add_option("--shard", a.shard,
                   "I/N: every N-th cell of the plan from the I-th on, I from 0 to N - 1; default: "
                   "the task of a Slurm array or of an indexed Kubernetes job, else all cells");
}

}  // namespace colod::cli
