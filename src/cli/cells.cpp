// Stages of a plan's cells: export of a shard, and merge.
#include "cells.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <mutex>
#include <set>

#include "cli.h"
#include "core/error.h"
#include "core/hash.h"
#include "core/parallel.h"
#include "exporters/files.h"
#include "job/job.h"
#include "pipeline/switches.h"
#include "plan/cell_lock.h"
#include "publish/cells.h"
#include "publish/kept_switching.h"
#include "store/store.h"

namespace colod::cli {
namespace {

namespace fs = std::filesystem;

/// "run colod STAGE --plan … --shard I/N".
std::string line_for(const char* stage, const std::string& plan_path, std::size_t cell,
                     const Plan& plan) {
  return std::string("colod ") + stage + " --plan " + plan_path + " --shard " +
         std::to_string(cell) + "/" + std::to_string(plan.cells.size());
}

/// All cells, each whole and meshed.
struct PlannedScene {
  Plan plan;
  Options options;
  Scene scene;                                  ///< without buildings
  std::vector<std::vector<std::string>> names;  ///< per cell

  CellScene common(const OutputOptions& output) const {
    return {output, options, scene, plan.building_count()};
  }
};

void check_meshed(const Store& store, const std::string& path, const std::string& remedy) {
  const std::size_t missing = store.unmeshed().size();
  if (missing > 0)
    throw Error(Stage::kInput, path,
                std::to_string(missing) + " of its buildings have no meshes yet: run " + remedy);
}

/// What one cell brings to the scene.
void add_cell(const std::string& plan_path, std::size_t cell, PlannedScene& all,
              std::vector<BuildingSights>& sights, std::set<std::string>& names) {
  check_whole(all.plan, plan_path, cell);
  const std::string path = cell_scene(plan_path, cell);
  const Store store(path, false);
  check_meshed(store, path, line_for("mesh", plan_path, cell, all.plan));
  if (cell == 0) {
    all.options = store.options();
    store.get_coanalysis(all.scene);
  }
  store.get_attributes(all.scene.attributes);
  store.get_placed_later(all.scene);
  for (BuildingSights& s : store.sights()) sights.push_back(std::move(s));
  all.names.push_back(store.names());
  for (const std::string& name : all.names.back())
    if (!names.insert(name).second)
      throw Error(Stage::kInput, name, "stands in two of the plan's cells");
}

PlannedScene read_planned(const CellArguments& a, const Log& log) {
  PlannedScene all;
  all.plan = read_plan(a.plan.path);
  all.scene.failures = all.plan.failures;
  all.scene.warnings = all.plan.warnings;
  std::vector<BuildingSights> sights;
  std::set<std::string> names;
  for (std::size_t cell = 0; cell < all.plan.cells.size(); ++cell)
    add_cell(a.plan.path, cell, all, sights, names);
  if (names.empty())
    throw Error(Stage::kInput, a.plan.path, "holds no building: name other inputs to colod plan");
  const SwitchOptions options = switch_options(a.output.options);
  if (auto before = switching_before(a.plan.path, all.scene, options, log))
    all.scene.switching = std::move(*before);
  else
    all.scene.switching = plan_switches(
        sights, all.options.layers, options,
        read_sights(a.prior, all.options.layers, [&](const Message& m) { log.message(m); }));
  return all;
}

std::vector<CellBuilding> buildings_of(const Store& store, const std::vector<std::string>& names) {
  std::vector<CellBuilding> buildings;
  for (const std::string& name : names) buildings.push_back({name, store.meshes_key(name)});
  return buildings;
}

/// Reads the file where its length is right.
HasFile looks_into(const std::string& out) {
  return [out](const WrittenFile& file) {
    const fs::path path = fs::path(out) / file.path;
    std::error_code error;
    if (fs::file_size(path, error) != file.bytes || error) return false;
    std::ifstream in(path, std::ios::binary);
    std::vector<char> piece(1 << 20);
    Hash hash;
    while (in.read(piece.data(), static_cast<std::streamsize>(piece.size())) || in.gcount() > 0)
      hash.add(piece.data(), static_cast<std::size_t>(in.gcount()));
    return hash.hex() == file.hash;
  };
}

std::string read_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  if (!file) throw Error(Stage::kInput, path, "cannot be read: run colod merge again");
  return bytes;
}

/// A file that would be as it was keeps its time.
Take writes_changed(const std::string& out) {
  return [out](const Encoded& file) {
    const fs::path path = fs::path(out) / file.path;
    std::error_code error;
    const bool is_as_long = fs::file_size(path, error) == file.bytes.size() && !error;
    if (!is_as_long || read_bytes(path.string()) != file.bytes) write_file(out, file);
  };
}

Shelf open_export(const std::string& path, const std::string& remedy) try {
  return {path, false};
} catch (const Error& e) {
  throw Error(e.stage, path, "is damaged, or cannot be read: run " + remedy);
}

/// What the cells' exports hand over. Throws Error{kInput} where there was none.
std::vector<MergedCell> exported_cells(const CellArguments& a, const PlannedScene& all) {
  std::vector<MergedCell> cells;
  for (std::size_t cell = 0; cell < all.names.size(); ++cell) {
    const std::string path = cell_export(a.plan.path, cell);
    const std::string remedy = line_for("export", a.plan.path, cell, all.plan) + " -o " +
                               a.output.out + " with the options that colod merge gets";
    if (!fs::exists(path)) throw Error(Stage::kInput, path, "is not there: run " + remedy);
    cells.push_back({path, open_export(path, remedy),
                     buildings_of(Store(cell_scene(a.plan.path, cell), false), all.names[cell]),
                     remedy});
  }
  return cells;
}

int merge(const CellArguments& a) {
  const auto start = std::chrono::steady_clock::now();
  check_output(a.output.options);
  limit_threads(a.run.threads);
  const Log log = a.run.log();
  const CellLock lock(a.plan.path);
  PlannedScene all = read_planned(a, log);
  std::vector<MergedCell> cells = exported_cells(a, all);
  make_folder(a.output.out);
  Shelf kept = Shelf::open_or_renew(kept_tiles_file(a.plan.path), warns(log));
  const std::vector<std::string>& formats = a.output.options.formats;
  const bool has_folder = std::find(formats.begin(), formats.end(), "3dtiles") != formats.end();
  const std::string tiles = has_folder ? a.output.out : archived_tiles(a.plan.path);
  const MergeTasks tasks{.take = writes_changed(a.output.out),
                         .write = [&](const std::string& path,
                                      const auto& body) { write_file(a.output.out, path, body); },
                         .has_file = looks_into(a.output.out),
                         .tell = [&](const Message& m) { log.message(m); },
                         .tiles = {.take = writes_changed(tiles),
                                   .has_file = looks_into(tiles),
                                   .read =
                                       [&](const std::string& path) {
                                         return read_bytes((fs::path(tiles) / path).string());
                                       },
                                   .kept = &kept,
                                   .place = fs::weakly_canonical(tiles).string()}};
  const auto seconds = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  Scene scene = all.scene;
  const CellOutcome outcome = merge_cells(all.common(a.output.options), scene, cells, tasks, [&] {
    return RunTotals{seconds(), peak_memory_bytes()};
  });
  keep_switching(a.plan.path, scene);
  log_problems(scene, log);
  log.messages(outcome.messages);
  log.message(summary_of(scene, outcome.tally, seconds(), a.output.out));
  return exit_code(scene, outcome.tally);
}

}  // namespace

std::function<void(const std::string&)> warns(const Log& log) {
  return [&log](const std::string& line) { log.message({Level::kWarning, line}); };
}

std::optional<Switching> switching_before(const std::string& plan_path, const Scene& scene,
                                          const SwitchOptions& options, const Log& log) {
  if (scene.placed_later.empty()) return std::nullopt;
  const std::string path = kept_switching_file(plan_path);
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  std::optional<Switching> before = switching_of(text, options);
  if (!before)
    log.message({Level::kWarning, path + ": says nothing of these options: when layers switch is "
                                         "decided anew, by all buildings"});
  return before;
}

void keep_switching(const std::string& plan_path, const Scene& scene) {
  if (!scene.placed_later.empty()) return;
  const fs::path path = kept_switching_file(plan_path);
  const std::string folder = path.parent_path().string();
  write_file(folder.empty() ? "." : folder,
             {path.filename().string(), switching_text(scene.switching)});
}

std::vector<std::string> names_of(const Inventory& inventory) {
  std::vector<std::string> names;
  for (const InputFile& file : inventory.files)
    names.insert(names.end(), file.names.begin(), file.names.end());
  return names;
}

void check_whole(const Plan& plan, const std::string& plan_path, std::size_t cell) {
  const std::string path = cell_scene(plan_path, cell);
  const std::vector<std::string> names = names_of(inventory_of(plan, cell));
  const std::string remedy = ": run " + line_for("segment", plan_path, cell, plan);
  std::size_t there = 0;
  if (fs::exists(path)) try {
      const Store store(path, false);
      for (const std::string& name : names) there += !store.segments_key(name).empty();
      if (there == names.size() && store.names().size() == names.size()) return;
    } catch (const Error& e) {
      throw Error(e.stage, e.what(), "it is damaged, or of another colod" + remedy);
    }
  throw Error(Stage::kInput, path,
              "has " + std::to_string(there) + " of the " + std::to_string(names.size()) +
                  " buildings that it is to have" + remedy);
}

void for_own_cells(const PlanArguments& a, const Plan& plan,
                   const std::function<void(std::size_t, const std::string&)>& body) {
  const std::size_t cells = plan.cells.size();
  for (const std::size_t cell : cells_of(shard_of(a.shard, cells), cells)) {
    const std::string path = cell_scene(a.path, cell);
    const CellLock lock(path);
    body(cell, path);
  }
}

int export_shard(const CellArguments& a) {
  check_output(a.output.options);
  limit_threads(a.run.threads);
  const Log log = a.run.log();
  const PlannedScene all = read_planned(a, log);
  make_folder(a.output.out);
  const CellScene common = all.common(a.output.options);
  CellOutcome outcome;
  for_own_cells(a.plan, all.plan, [&](std::size_t cell, const std::string& path) {
    const Store store(path, false);
    Shelf shelf = Shelf::open_or_renew(cell_export(a.plan.path, cell), warns(log));
    std::mutex mutex;
    int done = 0;
    const int count = static_cast<int>(all.names[cell].size());
    const CellTasks tasks{.buildings = buildings_of(store, all.names[cell]),
                          .load =
                              [&](const std::string& name) {
                                const std::lock_guard guard(mutex);
                                return store.building(name);
                              },
                          .take = [&](const Encoded& file) { write_file(a.output.out, file); },
                          .has_file = looks_into(a.output.out),
                          .progress =
                              [&](const std::string& name, bool is_new) {
                                log.progress(name, is_new ? "files" : "already there", ++done,
                                             count);
                              },
                          .tell = [&](const Message& m) { log.message(m); }};
    CellOutcome own = export_cell(common, tasks, shelf);
    outcome.tally += own.tally;
    log.messages(own.messages);
  });
  return exit_code(Scene{}, outcome.tally);
}

Run add_merge(CLI::App& app) {
  auto a = std::make_shared<CellArguments>();
  app.add_option("--plan", a->plan.path,
                 "plan.json of colod plan, whose cells colod export has exported")
      ->required()
      ->check(CLI::ExistingFile);
  app.add_option("--prior", a->prior,
                 "a scene file with meshes: its buildings decide where all layers switch")
      ->check(CLI::ExistingFile);
  add_output_arguments(app, a->output);
  add_run_options(app, a->run);
  return [a] { return merge(*a); };
}

}  // namespace colod::cli
