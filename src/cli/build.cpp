#include <chrono>
#include <memory>

#include "../../exporters/files.h"
#include "../parallel.h"
#include "../pipeline.h"
#include "../store.h"
#include "cli.h"
#include "input_options.h"
#include "output.h"
#include "pipeline_options.h"

namespace colod::cli {
namespace {

struct BuildArguments {
  std::vector<std::string> inputs;
  ReadOptions read;
  Options options;
  OutputArguments output;
  RunArguments run;
};

int build(const BuildArguments& a) {
  const auto start = std::chrono::steady_clock::now();
  validate(a.options);
  limit_threads(a.run.threads);
  const Log log = a.run.log();
  const Inventory inventory = take_inventory(a.inputs, a.read);
  make_folder(a.output.out);  // fails now rather than after all the work
  TemporaryStore depot;
  Scene scene = build_scene(
      inventory, [&](std::size_t file) { return read_file(inventory.files[file], a.read); },
      a.options, depot, [&](auto&&... args) { log.progress(args...); });
  export_scene(scene, a.output, log);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  return finish(scene, a.options, seconds.count(), a.output, log);
}

}  // namespace

Run add_build(CLI::App& app) {
  auto a = std::make_shared<BuildArguments>();
  add_config_option(app);
  app.add_option("INPUT", a->inputs, "files and folders with buildings")->required();
  add_output_options(app, a->output);
  add_input_options(app, a->read);
  add_pipeline_options(app, a->options);
  add_run_options(app, a->run);
  return [a] { return build(*a); };
}

}  // namespace colod::cli
