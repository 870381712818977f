// A scene in cells: each can be segmented and meshed by itself, on any machine that sees the same
// folder, and all together give the files that one run gives.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/options.h"
#include "read/read.h"

namespace colod {

struct PlannedFile {
  InputFile file;
  std::uint64_t bytes = 0;  ///< what its cost is taken to follow
  std::string hash;         ///< of its bytes
};

struct Plan {
  ReadOptions read;
  Options options;
  std::vector<std::vector<PlannedFile>> cells;  ///< each in the order of paths
  std::vector<ReadFailure> failures;            ///< files that could not be read
  std::vector<std::string> warnings;            ///< of the inputs as a whole

  std::size_t building_count() const;
};

/// Shares the files out to `cells` (≥ 1) cells of about equal bytes. A file that `previous`, a plan
/// of as many cells, knows stays in its cell, so that a scene that grows leaves the others' work as
/// it is; the others go, largest first, to the cell that has least. Reads every file to hash it, in
/// parallel. Throws Error{kInput} for one that cannot be read any more.
Plan make_plan(const Inventory& inventory, const ReadOptions& read, const Options& options,
               int cells, const Plan* previous = nullptr);

/// One cell's files as an inventory of their own.
Inventory inventory_of(const Plan& plan, std::size_t cell);

/// JSON. `parse_plan` throws Error{kInput} naming `where`.
std::string plan_text(const Plan& plan);
Plan parse_plan(const std::string& text, const std::string& where);
/// Throws Error{kInput} for a file that cannot be opened, or is no plan.
Plan read_plan(const std::string& path);

/// What a cell's segments are made from, on one line: it changes with its files, their content, and
/// the options.
std::string cell_stamp(const Plan& plan, std::size_t cell);

/// Beside the plan: where a cell's scene file lies; where its stamp does;
std::string cell_scene(const std::string& plan_path, std::size_t cell);
std::string cell_stamp_file(const std::string& plan_path, std::size_t cell);
/// What its export hands to the merge.
std::string cell_export(const std::string& plan_path, std::size_t cell);
/// What a merge leaves for the next one: which tiles there are, and when layers switch.
std::string kept_tiles_file(const std::string& plan_path);
/// The folder of tiles that only an archive shows.
std::string archived_tiles(const std::string& plan_path);
std::string kept_switching_file(const std::string& plan_path);

/// Which of `count` runs this is, 0 … count − 1.
struct Shard {
  std::size_t index = 0, count = 1;
};

/// "I/N"; of an empty text what SLURM_ARRAY_TASK_ID (with _MIN, _MAX and _STEP) or
/// JOB_COMPLETION_INDEX (one run a cell) say, else all cells. Throws Error{kUsage}.
Shard shard_of(const std::string& text, std::size_t cells);
/// Whether the text or the environment says that this is one of several runs.
bool is_sharded(const std::string& text);

/// Every count-th cell from the index on.
std::vector<std::size_t> cells_of(const Shard& shard, std::size_t cells);

}  // namespace colod
