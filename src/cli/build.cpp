#include <chrono>
#include <map>
#include <memory>
#include <mutex>

#include "cli.h"
#include "core/parallel.h"
#include "exporters/files.h"
#include "input_options.h"
#include "output.h"
#include "pipeline/pipeline.h"
#include "pipeline_options.h"
#include "publish/report_pictures.h"
#include "store/store.h"

namespace colod::cli {
namespace {

struct BuildArguments {
  std::vector<std::string> inputs;
  std::string prior, truth;
  ReadOptions read;
  Options options;
  OutputArguments output;
  RunArguments run;
};

/// Holds each building against the truth when its layers are done, and passes everything on.
class Judge : public Depot {
 public:
  Judge(const Truth& truth, Depot& depot) : truth_(truth), depot_(depot) {}

  void put(Building& b) override {
    {
      const std::lock_guard lock(mutex_);
      sources_[b.source.name] = b.source;  // the depot does not keep the faces' objects
    }
    depot_.put(b);
  }
  void get(Building& b) override { depot_.get(b); }
  void drop(Building& b) override {
    std::vector<PlacedPart> parts = place_parts(b, source_of(b), truth_);
    {
      const std::lock_guard lock(mutex_);
      parts_[b.source.name] = std::move(parts);
    }
    depot_.drop(b);
  }

  std::vector<PlacedPart> parts() const {
    std::vector<PlacedPart> all;
    for (const auto& [name, parts] : parts_) all.insert(all.end(), parts.begin(), parts.end());
    return all;
  }

 private:
  Source source_of(const Building& b) {
    const std::lock_guard lock(mutex_);
    return std::move(sources_[b.source.name]);
  }

  const Truth& truth_;
  Depot& depot_;
  std::mutex mutex_;
  std::map<std::string, Source> sources_;
  std::map<std::string, std::vector<PlacedPart>> parts_;
};

int build(const BuildArguments& a) {
  const auto start = std::chrono::steady_clock::now();
  validate(a.options);
  check_place(a.output);
  limit_threads(a.run.threads);
  const Log log = a.run.log();
  const Truth truth = a.truth.empty() ? Truth{} : read_truth(a.truth);
  const std::optional<Prior> prior = read_prior(a.prior);
  const std::vector<BuildingSights> sights = read_sights(a.prior, a.options.layers, log);
  const Inventory inventory = take_inventory(a.inputs, a.read);
  check_cost(a.options, inventory.building_count());
  make_folder(a.output.out);  // fails now rather than after all the work
  TemporaryStore store;
  Judge judge(truth, store);
  Depot& judged = truth.empty() ? static_cast<Depot&>(store) : judge;
  Gallery gallery(inventory.building_count(), a.options.layers, judged);
  Scene scene = build_scene(
      inventory, [&](std::size_t file) { return read_file(inventory.files[file], a.read); },
      a.options, a.output.has_no_page ? judged : gallery,
      [&](auto&&... args) { log.progress(args...); }, prior ? &*prior : nullptr);
  if (!truth.empty()) scene.consistency = tally_parts(judge.parts(), a.options.layers);
  decide_switches(scene, a.options.layers, switch_options(a.output), sights);
  write_outputs(scene, a.output, log);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  return finish(scene, a.options, seconds.count(), gallery.take(scene), a.output, log);
}

}  // namespace

Run add_build(CLI::App& app) {
  auto a = std::make_shared<BuildArguments>();
  add_config_option(app);
  app.add_option("INPUT", a->inputs, "files and folders with buildings")->required();
  add_output_options(app, a->output);
  add_input_options(app, a->read);
  add_folder_options(app, a->read);
  add_pipeline_options(app, a->options);
  add_prior_option(app, a->prior);
  app.add_option("--truth", a->truth,
                 "a ground truth of parts: how consistent the layers are goes into report.json")
      ->check(CLI::ExistingFile);
  add_run_options(app, a->run);
  return [a] {
    switch_off_dependents(a->options, a->run.log());
    return build(*a);
  };
}

}  // namespace colod::cli
