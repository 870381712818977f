#include <chrono>
#include <memory>

#include "cli.h"
#include "core/parallel.h"
#include "exporters/files.h"
#include "job_options.h"
#include "output.h"

namespace colod::cli {
namespace {

struct BuildArguments {
  std::vector<std::string> inputs;
  std::string out;
  Job job;
  RunArguments run;
};

int build(const BuildArguments& a) {
  const auto start = std::chrono::steady_clock::now();
  limit_threads(a.run.threads);
  const Log log = a.run.log();
  const JobHooks hooks{.progress = [&](auto&&... args) { log.progress(args...); },
                       .is_cancelled = {},
                       .tell = [&](const Message& m) { log.message(m); },
                       .ready = [&] { make_folder(a.out); }};
  Product product = run_job(a.inputs, a.job, hooks);
  return write_all(product.scene, a.job.options, start, std::move(product.pictures), *product.depot,
                   {a.out, a.job.output}, log);
}

}  // namespace

Run add_build(CLI::App& app) {
  auto a = std::make_shared<BuildArguments>();
  add_config_option(app);
  app.add_option("INPUT", a->inputs, "files and folders with buildings")->required();
  app.add_option("-o,--out", a->out, "folder to write to")->required();
  add_job_options(app, a->job);
  add_run_options(app, a->run);
  return [a] {
    const Log log = a->run.log();
    switch_off_dependents(a->job.options, [&](const Message& m) { log.message(m); });
    return build(*a);
  };
}

}  // namespace colod::cli
