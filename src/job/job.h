// Inputs and options → a finished scene: the whole job, for the command line and the library.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/options.h"
#include "pipeline/pipeline.h"
#include "publish/outputs.h"
#include "read/archive.h"
#include "scene_choice.h"

namespace colod {

struct Job {
  ReadOptions read;
  SceneChoice scene;
  Options options;
  OutputOptions output;
  std::string prior;  ///< an analysed scene file; empty: none
  std::string truth;  ///< a ground truth of parts; empty: none
};

/// What stands around a job; all of it may be left out.
struct JobHooks {
  Progress progress;
  std::function<bool()> is_cancelled;  ///< asked from several threads
  Tell tell;
  std::function<void()> ready;  ///< called once what was asked for is known to be possible, before
                                ///< the long work
};

struct Product {
  Scene scene;                              ///< its switches are decided
  Pictures pictures;                        ///< for report.html; none with has_no_page
  std::unique_ptr<Depot> depot;             ///< where the sources lie, which textures are made of
  std::shared_ptr<const Unpacked> archive;  ///< where their images lie; null: in files of their own
};

/// The buildings of files and folders, or of one scene. Throws Error{kUsage} or Error{kInput} for
/// what stops the job as a whole, and Cancelled.
Product run_job(const std::vector<std::string>& inputs, const Job& job, const JobHooks& hooks = {});

/// Buildings that are in memory.
Product run_job(const std::vector<NamedArrays>& buildings, const Job& job,
                const JobHooks& hooks = {});

/// What an analysed scene file learnt; none for an empty path.
std::optional<Prior> read_prior(const std::string& path);

/// The sights of a prior's buildings; none, with a warning, when it has no meshes. Throws
/// Error{kUsage} when its number of layers is another.
std::vector<BuildingSights> read_sights(const std::string& prior, int layers, const Tell& tell);

/// What the voxels of the buildings that are worked on at once take must fit into half of this
/// machine's memory. Throws Error{kUsage} before the work.
void check_cost(const Options& options, std::size_t buildings);

/// Rules that need one that is off (rules/rules.h) are off, too, which is told.
void switch_off_dependents(Options& options, const Tell& tell);

}  // namespace colod
