// What stages share that work on a plan's cells.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "output.h"
#include "pipeline_options.h"
#include "plan/plan.h"
#include "plan_options.h"

namespace colod::cli {

struct CellArguments {
  PlanArguments plan;
  std::string prior;  ///< a scene file with meshes, or empty
  OutputArguments output;
  RunArguments run;
};

std::vector<std::string> names_of(const Inventory& inventory);

/// A cell whose run was broken off, or never began, must not pass for a smaller one. Throws
/// Error{kInput} with the line that repairs it.
void check_whole(const Plan& plan, const std::string& plan_path, std::size_t cell);

/// Calls body(cell, its scene file) for the cells of this run's shard; no other run is at work on a
/// cell meanwhile.
void for_own_cells(const PlanArguments& a, const Plan& plan,
                   const std::function<void(std::size_t, const std::string&)>& body);

/// `log` must outlive it.
std::function<void(const std::string& line)> warns(const Log& log);

/// Exports the buildings of this run's shard; merge makes the files of the scene. Returns the exit
/// code.
int export_shard(const CellArguments& a);

/// When layers switched before buildings were placed later; none: none were, or the merge before
/// had other options, which is told.
std::optional<Switching> switching_before(const std::string& plan_path, const Scene& scene,
                                          const SwitchOptions& options, const Log& log);
/// Leaves it beside the plan for that, unless buildings were placed later.
void keep_switching(const std::string& plan_path, const Scene& scene);

}  // namespace colod::cli
