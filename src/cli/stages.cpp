// The same job as `build` in stages, through scene files: segment, analyze, mesh, export.

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>

#include "cells.h"
#include "cli.h"
#include "core/error.h"
#include "core/parallel.h"
#include "exporters/files.h"
#include "input_options.h"
#include "job/job.h"
#include "job/place_record.h"
#include "job/scene_input.h"
#include "numbers.h"
#include "output.h"
#include "pipeline/switches.h"
#include "pipeline_options.h"
#include "plan/cell_lock.h"
#include "plan_options.h"
#include "publish/cells.h"
#include "publish/report_pictures.h"
#include "read/archive.h"
#include "store/store.h"
#include "update_analysis.h"

namespace colod::cli {
namespace {

struct StageArguments {
  std::vector<std::string> inputs;  ///< sources (segment) or scene files
  PlanArguments plan;               ///< instead of inputs
  std::string scene;                ///< the scene file that segment writes
  std::string prior;                ///< an analysed scene file, or empty
  double gap = -1;                  ///< analyze: instead of the scene file's; negative: not given
  bool is_update = false;           ///< analyze: what is new alone
  ReadOptions read;
  SceneChoice choice;
  Options options;
  OutputArguments output;
  RunArguments run;
};

/// Does what of the inventory is not yet in the scene file; what went wrong is added to `problems`.
void segment_into(Store& store, const Inventory& inventory, const Reader& read,
                  const Options& pipeline, const Log& log, Scene& problems) {
  store.put_options(pipeline);
  const std::size_t before = problems.buildings.size();
  problems.buildings.resize(before + inventory.building_count());
  std::mutex mutex;
  int done = 0;
  for_each_source(inventory, read, [&](Turn turn) {
    const std::size_t position = turn.position;
    const std::string name = turn.source.name, key = segments_key(turn.source, pipeline);
    bool is_there;
    {
      const std::lock_guard lock(mutex);
      is_there = !turn.problem && store.segments_key(name) == key;
    }
    Building b;
    if (!is_there) b = segment_building(std::move(turn), pipeline);
    const std::lock_guard lock(mutex);
    if (!is_there) store.put_segments(b, static_cast<int>(position), key);
    log.progress(name, is_there ? "already there" : "segments", ++done,
                 static_cast<int>(inventory.building_count()));
    Building& problem = problems.buildings[before + position];
    problem.source.name = name;
    problem.failure = b.failure;
    problem.is_dismissed = b.is_dismissed;
    problem.warnings = b.warnings;
  });
}

/// The cells of this run's shard, each into its own scene file.
void segment_cells(const StageArguments& a, const Log& log, Scene& problems) {
  const Plan plan = read_plan(a.plan.path);
  check_cost(plan.options, plan.building_count());
  for_own_cells(a.plan, plan, [&](std::size_t cell, const std::string& path) {
    const Inventory inventory = inventory_of(plan, cell);
    Store store = Store::open_or_renew(path, warns(log));
    store.keep_only(names_of(inventory));
    const Reader read = [&](std::size_t f) { return read_file(inventory.files[f], plan.read); };
    segment_into(store, inventory, read, plan.options, log, problems);
  });
}

/// Later stages make textures of the images that a scene file names, which were gone by then.
void refuse_archive(const std::string& input) {
  if (is_archive(input))
    throw Error(Stage::kUsage, input,
                "is unpacked for one run alone, and later stages need its images: `unzip IN.3tz -d "
                "DIR` unpacks it, then DIR is the input");
}

int segment(const StageArguments& a) {
  limit_threads(a.run.threads);
  const Log log = a.run.log();
  Scene problems;
  if (!a.plan.path.empty()) {
    segment_cells(a, log, problems);
  } else {
    validate(a.options);
    for (const std::string& input : a.inputs) refuse_archive(input);
    const Inputs found =
        open_inputs(a.inputs, a.read, a.choice, {}, [&](const Message& m) { log.message(m); });
    check_cost(a.options, found.inventory.building_count());
    problems.failures = found.inventory.failures;
    problems.warnings = found.inventory.warnings;
    Store store(a.scene, true);
    store.drop_damaged(warns(log));
    segment_into(store, found.inventory, found.read, a.options, log, problems);
    if (!found.attributes.empty()) store.put_attributes(found.attributes);
    if (found.scene)  // what a later run adds is not of it, which export tells
      store.put_place(to_json({found.scene->tiles.tree().path, a.read, a.choice}));
  }
  log_problems(problems, log);
  return exit_code(problems);
}

/// All buildings of several scene files, as much as `read` gives without its geometry, so that
/// memory does not follow the sources, by name, as one run would have them; `file_of[i]` tells
/// where building i came from.
Scene read_scene(std::vector<Store>& stores, std::vector<std::size_t>& file_of,
                 Building (Store::*read)(const std::string&) const) {
  std::vector<std::pair<std::string, std::size_t>> order;
  for (std::size_t f = 0; f < stores.size(); ++f)
    for (const std::string& name : stores[f].names()) order.emplace_back(name, f);
  std::sort(order.begin(), order.end());
  Scene scene;
  for (const auto& [name, f] : order) {
    scene.buildings.push_back((stores[f].*read)(name));
    drop_geometry(scene.buildings.back());
    file_of.push_back(f);
  }
  if (scene.buildings.empty())
    throw Error(Stage::kInput, "scene", "holds no building: run colod segment first");
  return scene;
}

std::vector<Store> open_all(const std::vector<std::string>& files) {
  std::vector<Store> stores;
  std::error_code error;
  for (std::size_t i = 0; i < files.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j)
      if (std::filesystem::equivalent(files[i], files[j], error))
        throw Error(Stage::kInput, files[i], "is named twice");
    stores.emplace_back(files[i], false);
  }
  return stores;
}

/// What was segmented by other rules is not analysed together.
void check_same_rules(const std::vector<Store>& stores, const std::vector<std::string>& files) {
  for (std::size_t i = 0; i < stores.size(); ++i) {
    stores[i].check_rules();
    if (!(stores[i].options().rules == stores.front().options().rules))
      throw Error(Stage::kInput, files[i],
                  "was segmented with other rules than " + files.front() +
                      ": run colod segment again with the same --rules and --without");
  }
}

/// Layers that are missing, or older than the segments, would be nonsense.
void check_analysed(const Store& store, const std::vector<std::string>& names) {
  for (const std::string& name : names)
    if (!store.has_layers_of_segments(name))
      throw Error(Stage::kInput, name, "is new since colod analyze: run it again first");
}

/// What stands in one folder needs names of its own.
void check_exportable(const Scene& scene) {
  std::set<std::string> names;
  for (const Building& b : scene.buildings) {
    if (!names.insert(b.source.name).second)
      throw Error(Stage::kInput, b.source.name, "stands in two of the scene files");
    if (b.failure.empty() && b.layers.empty())
      throw Error(Stage::kInput, b.source.name, "has no meshes yet: run colod mesh first");
  }
}

using Locks = std::vector<std::unique_ptr<CellLock>>;

/// The scene files that are named, or all cells of the plan, each with all that it is to hold. With
/// `locks` no other run is at work on a cell from before it is looked at.
std::vector<std::string> scene_files(const StageArguments& a, Locks* locks = nullptr) {
  if (a.plan.path.empty()) return a.inputs;
  const Plan plan = read_plan(a.plan.path);
  std::vector<std::string> files;
  for (std::size_t cell = 0; cell < plan.cells.size(); ++cell) {
    files.push_back(cell_scene(a.plan.path, cell));
    if (locks) locks->push_back(std::make_unique<CellLock>(files.back()));
    check_whole(plan, a.plan.path, cell);
  }
  return files;
}

/// The scene files that an analysis is of, nobody else's meanwhile.
struct Analysed {
  Locks locks;
  std::vector<std::string> files;
  std::vector<Store> stores;
};

Analysed open_analysed(const StageArguments& a) {
  Analysed out;
  out.files = scene_files(a, &out.locks);
  out.stores = open_all(out.files);
  check_same_rules(out.stores, out.files);
  return out;
}

int analyze(const StageArguments& a) {
  limit_threads(a.run.threads);
  Analysed opened = open_analysed(a);
  std::vector<Store>& stores = opened.stores;
  std::vector<std::size_t> file_of;
  Scene scene = read_scene(stores, file_of, &Store::described);
  Options options = stores.front().options();
  if (a.gap >= 0) options.gap = a.gap;
  const std::optional<Prior> prior = read_prior(a.prior);
  analyze_scene(scene, options, prior ? &*prior : nullptr);
  for (std::size_t i = 0; i < scene.buildings.size(); ++i)
    stores[file_of[i]].put_layers_of_segments(scene.buildings[i]);
  for (Store& store : stores) store.put_coanalysis(scene);
  return 0;
}

int update(const StageArguments& a) {
  limit_threads(a.run.threads);
  Analysed opened = open_analysed(a);
  std::vector<std::size_t> file_of;
  Scene scene = read_scene(opened.stores, file_of, &Store::described);
  update_analysis(opened.files, opened.stores, std::move(scene), std::move(file_of), a.run.log());
  return 0;
}

/// One scene file's buildings, each let go of when it is told what became of it.
CellOutcome mesh_scene(Store& store, const Log& log) {
  store.check_rules();
  store.drop_damaged_meshes(warns(log));
  const Options options = store.options();
  Scene facts;
  store.get_coanalysis(facts);
  const std::vector<std::string> names = store.names();
  check_analysed(store, names);
  std::mutex mutex;
  int done = 0;
  std::vector<CellOutcome> of_building(names.size());
  parallel_for(names.size(), [&](std::size_t i) {
    Building b;
    bool is_there;
    {
      const std::lock_guard lock(mutex);
      is_there = store.has_meshes(names[i]);
      b = store.building(names[i]);
    }
    if (!is_there) mesh_building(b, options);
    of_building[i] = {tally_of(b), problems_of(b)};
    if (is_there) return;
    const std::lock_guard lock(mutex);
    store.put_meshes(b);
    log.progress(names[i], "layers", ++done, static_cast<int>(names.size()));
  });
  CellOutcome outcome;
  for (CellOutcome& own : of_building) outcome += std::move(own);
  return outcome;
}

int mesh(const StageArguments& a) {
  limit_threads(a.run.threads);
  const Log log = a.run.log();
  CellOutcome outcome;
  if (a.plan.path.empty()) {
    for (Store& store : open_all(a.inputs)) outcome += mesh_scene(store, log);
  } else {
    const Plan plan = read_plan(a.plan.path);
    for_own_cells(a.plan, plan, [&](std::size_t cell, const std::string& path) {
      check_whole(plan, a.plan.path, cell);
      Store store(path, false);
      outcome += mesh_scene(store, log);
    });
  }
  log.messages(outcome.messages);
  return exit_code(Scene{}, outcome.tally);
}

/// The sources of scenes that were read before, one at a time, so that memory stays flat.
class Sources : public Depot {
 public:
  Sources(std::vector<Store>& stores, const Scene& scene, const std::vector<std::size_t>& file_of)
      : stores_(stores) {
    for (std::size_t i = 0; i < file_of.size(); ++i)
      file_of_[scene.buildings[i].source.name] = file_of[i];
  }

  void get(Building& b) override {
    const std::lock_guard lock(mutex_);
    Building kept = stores_[file_of_.at(b.source.name)].building(b.source.name);
    b.source.mesh = std::move(kept.source.mesh);
    b.source.cloud = std::move(kept.source.cloud);
    b.source.look = std::move(kept.source.look);
  }
  void drop(Building& b) override { drop_geometry(b); }
  void put(Building& b) override { drop(b); }

 private:
  std::vector<Store>& stores_;
  std::map<std::string, std::size_t> file_of_;
  std::mutex mutex_;
};

/// When layers switch; after an update of a plan's cells as before it.
void decide(const StageArguments& a, const Options& options, Scene& scene, const Log& log) {
  const SwitchOptions switching = switch_options(a.output.options);
  if (!a.plan.path.empty())
    if (auto before = switching_before(a.plan.path, scene, switching, log)) {
      scene.switching = std::move(*before);
      for (Building& b : scene.buildings) apply_switches(scene.switching, b);
      return;
    }
  decide_switches(scene, options.layers, switching,
                  read_sights(a.prior, options.layers, [&](const Message& m) { log.message(m); }));
  if (!a.plan.path.empty()) keep_switching(a.plan.path, scene);
}

/// What is around the buildings of a place.
void add_places(const StageArguments& a, const std::vector<Store>& stores, const Log& log,
                Scene& scene) {
  for (std::size_t i = 0; i < stores.size(); ++i) {
    const std::string record = stores[i].place();
    if (record.empty()) continue;
    if (stores.size() > 1) {
      scene.failures.push_back({a.inputs[i],
                                "is of a place: what is around its buildings is left "
                                "out, export it alone"});
      continue;
    }
    const OutputOptions& o = a.output.options;
    add_place_again(
        place_record_of(record), {o.crs, o.origin, o.target_sse, o.switching.pixel_error},
        [&](const Message& m) { log.message(m); }, scene);
  }
}

int export_files(const StageArguments& a) {
  if (!a.plan.path.empty() && is_sharded(a.plan.shard))
    return export_shard({a.plan, a.prior, a.output, a.run});
  const auto start = std::chrono::steady_clock::now();
  check_output(a.output.options);
  limit_threads(a.run.threads);
  const Log log = a.run.log();
  std::vector<Store> stores = open_all(scene_files(a));
  std::vector<std::size_t> file_of;
  Scene scene = read_scene(stores, file_of, &Store::building);
  stores.front().get_coanalysis(scene);
  if (!a.plan.path.empty()) {
    Plan plan = read_plan(a.plan.path);
    scene.failures = std::move(plan.failures);
    scene.warnings = std::move(plan.warnings);
  }
  for (const Store& store : stores) {
    store.get_attributes(scene.attributes);
    store.get_placed_later(scene);
  }
  check_exportable(scene);
  add_places(a, stores, log, scene);
  make_folder(a.output.out);
  const Options options = stores.front().options();
  Gallery gallery(scene.buildings.size(), options.layers);
  Sources sources(stores, scene, file_of);
  leave_out_dismissed(scene);
  if (!a.output.options.has_no_page)
    parallel_for(scene.buildings.size(), [&](std::size_t i) {
      Building& b = scene.buildings[i];
      sources.get(b);
      gallery.draw(b);
      sources.drop(b);
    });
  decide(a, options, scene, log);
  return write_all(scene, options, start, gallery.take(scene), sources, a.output, log);
}

/// What a stage works on: what is named, or a plan.
void check_named(const StageArguments& a, const char* what) {
  if (a.inputs.empty() == a.plan.path.empty())
    throw Error(Stage::kUsage, what, "name some, or --plan, and not both");
  if (a.plan.path.empty() && !a.plan.shard.empty())
    throw Error(Stage::kUsage, "--shard", "is a part of a plan: name --plan, too");
}

std::shared_ptr<StageArguments> add_scene_files(CLI::App& app, bool is_sharded) {
  auto a = std::make_shared<StageArguments>();
  app.add_option("SCENE", a->inputs, "scene files (.colod)");
  add_plan_options(app, a->plan, is_sharded);
  add_run_options(app, a->run);
  return a;
}

/// Options that segments depend on are the plan's.
void refuse_options_of_plan(const CLI::App& app) {
  for (const CLI::Option* o : app.get_options()) {
    const std::string name = o->get_name();
    const bool is_own = name == "--plan" || name == "--shard" || name == "--threads" ||
                        name == "--quiet" || name == "--log-json" || name == "--config";
    if (o->count() > 0 && !is_own)
      throw Error(Stage::kUsage, name, "stands in the plan: give it to colod plan");
  }
}

}  // namespace

Run add_segment(CLI::App& app) {
  auto a = std::make_shared<StageArguments>();
  add_config_option(app);
  app.add_option("INPUT", a->inputs, "files and folders with buildings");
  app.add_option("-o,--out", a->scene, "scene file to write or go on with; not with --plan");
  add_plan_options(app, a->plan, true);
  add_input_options(app, a->read);
  add_folder_options(app, a->read);
  add_scene_options(app, a->choice);
  add_pipeline_options(app, a->options);
  add_run_options(app, a->run);
  return [a, &app] {
    check_named(*a, "INPUT");
    if (!a->plan.path.empty())
      refuse_options_of_plan(app);
    else if (a->scene.empty())
      throw Error(Stage::kUsage, "--out", "is missing: the scene file to write");
    const Log log = a->run.log();
    switch_off_dependents(a->options, [&](const Message& m) { log.message(m); });
    return segment(*a);
  };
}

Run add_analyze(CLI::App& app) {
  auto a = add_scene_files(app, false);
  add_prior_option(app, a->prior);
  app.add_option("--gap", a->gap, "layer 0 is good enough when proven to be this near to the best")
      ->check(number_between(0.0, 1.0));
  app.add_flag(
         "--update", a->is_update,
         "leave buildings as they are that were analysed before, and place those that are new "
         "or have changed by what the others learnt")
      ->excludes("--prior")
      ->excludes("--gap");
  return [a] {
    check_named(*a, "SCENE");
    return a->is_update ? update(*a) : analyze(*a);
  };
}

Run add_mesh(CLI::App& app) {
  auto a = add_scene_files(app, true);
  return [a] {
    check_named(*a, "SCENE");
    return mesh(*a);
  };
}

Run add_export(CLI::App& app) {
  auto a = add_scene_files(app, true);
  app.add_option("--prior", a->prior,
                 "a scene file with meshes: its buildings decide where all layers switch")
      ->check(CLI::ExistingFile);
  add_output_arguments(app, a->output);
  return [a] {
    check_named(*a, "SCENE");
    return export_files(*a);
  };
}

}  // namespace colod::cli
