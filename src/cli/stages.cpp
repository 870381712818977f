// The same job as `build` in stages, through scene files: segment, analyze, mesh, export.

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <set>

#include "cli.h"
#include "core/error.h"
#include "core/parallel.h"
#include "exporters/files.h"
#include "input_options.h"
#include "job/job.h"
#include "job/scene_input.h"
#include "numbers.h"
#include "output.h"
#include "pipeline_options.h"
#include "publish/report_pictures.h"
#include "store/store.h"

namespace colod::cli {
namespace {

struct StageArguments {
  std::vector<std::string> inputs;  ///< sources (segment) or scene files
  std::string scene;                ///< the scene file that segment writes
  std::string prior;                ///< an analysed scene file, or empty
  double gap = -1;                  ///< analyze: instead of the scene file's; negative: not given
  ReadOptions read;
  SceneChoice choice;
  Options options;
  OutputArguments output;
  RunArguments run;
};

int segment(const StageArguments& a) {
  validate(a.options);
  limit_threads(a.run.threads);
  const Log log = a.run.log();
  const Inputs found =
      open_inputs(a.inputs, a.read, a.choice, {}, [&](const Message& m) { log.message(m); });
  const Inventory& inventory = found.inventory;
  check_cost(a.options, inventory.building_count());
  Scene problems;
  problems.failures = inventory.failures;
  problems.warnings = inventory.warnings;
  problems.buildings.resize(inventory.building_count());
  Store store(a.scene, true);
  store.put_options(a.options);
  if (!found.attributes.empty()) store.put_attributes(found.attributes);
  std::mutex mutex;
  int done = 0;
  for_each_source(inventory, found.read, [&](Turn turn) {
    const std::size_t position = turn.position;
    const std::string name = turn.source.name, key = segments_key(turn.source, a.options);
    bool is_there;
    {
      const std::lock_guard lock(mutex);
      is_there = !turn.problem && store.segments_key(name) == key;
    }
    Building b;
    if (!is_there) b = segment_building(std::move(turn), a.options);
    const std::lock_guard lock(mutex);
    if (!is_there) store.put_segments(b, static_cast<int>(position), key);
    log.progress(name, is_there ? "already there" : "segments", ++done,
                 static_cast<int>(problems.buildings.size()));
    Building& problem = problems.buildings[position];
    problem.source.name = name;
    problem.failure = b.failure;
    problem.warnings = b.warnings;
  });
  log_problems(problems, log);
  return exit_code(problems);
}

/// All buildings of several scene files without their geometry, so that memory does not follow the
/// sources; `file_of[i]` tells where building i came from.
Scene read_scene(std::vector<Store>& stores, std::vector<std::size_t>& file_of) {
  Scene scene;
  for (std::size_t f = 0; f < stores.size(); ++f)
    for (const std::string& name : stores[f].names()) {
      scene.buildings.push_back(stores[f].building(name));
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

int analyze(const StageArguments& a) {
  limit_threads(a.run.threads);
  std::vector<Store> stores = open_all(a.inputs);
  check_same_rules(stores, a.inputs);
  std::vector<std::size_t> file_of;
  Scene scene = read_scene(stores, file_of);
  Options options = stores.front().options();
  if (a.gap >= 0) options.gap = a.gap;
  const std::optional<Prior> prior = read_prior(a.prior);
  analyze_scene(scene, options, prior ? &*prior : nullptr);
  for (std::size_t i = 0; i < scene.buildings.size(); ++i)
    stores[file_of[i]].put_layers_of_segments(scene.buildings[i]);
  for (Store& store : stores) store.put_coanalysis(scene);
  return 0;
}

int mesh(const StageArguments& a) {
  limit_threads(a.run.threads);
  const Log log = a.run.log();
  Scene problems;
  for (Store& store : open_all(a.inputs)) {
    store.check_rules();
    const Options options = store.options();
    store.get_coanalysis(problems);
    const std::vector<std::string> names = store.names();
    check_analysed(store, names);
    std::mutex mutex;
    int done = 0;
    parallel_for(names.size(), [&](std::size_t i) {
      Building b;
      {
        const std::lock_guard lock(mutex);
        if (store.has_meshes(names[i])) return;
        b = store.building(names[i]);
      }
      mesh_building(b, options);
      const std::lock_guard lock(mutex);
      store.put_meshes(b);
      log.progress(names[i], "layers", ++done, static_cast<int>(names.size()));
    });
    for (const std::string& name : names) {
      problems.buildings.push_back(store.building(name));
      drop_geometry(problems.buildings.back());
    }
  }
  log_problems(problems, log);
  return exit_code(problems);
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

int export_files(const StageArguments& a) {
  const auto start = std::chrono::steady_clock::now();
  check_place(a.output.options);
  limit_threads(a.run.threads);
  const Log log = a.run.log();
  std::vector<Store> stores = open_all(a.inputs);
  std::vector<std::size_t> file_of;
  Scene scene = read_scene(stores, file_of);
  stores.front().get_coanalysis(scene);
  for (const Store& store : stores) store.get_attributes(scene.attributes);
  check_exportable(scene);
  make_folder(a.output.out);
  const Options options = stores.front().options();
  Gallery gallery(scene.buildings.size(), options.layers);
  Sources sources(stores, scene, file_of);
  if (!a.output.options.has_no_page)
    parallel_for(scene.buildings.size(), [&](std::size_t i) {
      Building& b = scene.buildings[i];
      sources.get(b);
      gallery.draw(b);
      sources.drop(b);
    });
  decide_switches(scene, options.layers, switch_options(a.output.options),
                  read_sights(a.prior, options.layers, [&](const Message& m) { log.message(m); }));
  return write_all(scene, options, start, gallery.take(scene), sources, a.output, log);
}

std::shared_ptr<StageArguments> add_scene_files(CLI::App& app) {
  auto a = std::make_shared<StageArguments>();
  app.add_option("SCENE", a->inputs, "scene files (.colod)")->required();
  add_run_options(app, a->run);
  return a;
}

}  // namespace

Run add_segment(CLI::App& app) {
  auto a = std::make_shared<StageArguments>();
  add_config_option(app);
  app.add_option("INPUT", a->inputs, "files and folders with buildings")->required();
  app.add_option("-o,--out", a->scene, "scene file to write or go on with")->required();
  add_input_options(app, a->read);
  add_folder_options(app, a->read);
  add_scene_options(app, a->choice);
  add_pipeline_options(app, a->options);
  add_run_options(app, a->run);
  return [a] {
    const Log log = a->run.log();
    switch_off_dependents(a->options, [&](const Message& m) { log.message(m); });
    return segment(*a);
  };
}

Run add_analyze(CLI::App& app) {
  auto a = add_scene_files(app);
  add_prior_option(app, a->prior);
  app.add_option("--gap", a->gap, "layer 0 is good enough when proven to be this near to the best")
      ->check(number_between(0.0, 1.0));
  return [a] { return analyze(*a); };
}

Run add_mesh(CLI::App& app) {
  auto a = add_scene_files(app);
  return [a] { return mesh(*a); };
}

Run add_export(CLI::App& app) {
  auto a = add_scene_files(app);
  app.add_option("--prior", a->prior,
                 "a scene file with meshes: its buildings decide where all layers switch")
      ->check(CLI::ExistingFile);
  add_output_arguments(app, a->output);
  return [a] { return export_files(*a); };
}

}  // namespace colod::cli
