// colod plan: a scene in cells that segment and mesh can work on apart.

#include "plan/plan.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>

#include "cli.h"
#include "core/error.h"
#include "core/parallel.h"
#include "exporters/files.h"
#include "input_options.h"
#include "job/job.h"
#include "numbers.h"
#include "output.h"
#include "pipeline_options.h"
#include "plan/cell_lock.h"

namespace colod::cli {
namespace {

namespace fs = std::filesystem;

struct MakePlanArguments {
  std::vector<std::string> inputs;
  std::string out;
  int cells = 8;
  ReadOptions read;
  Options options;
  RunArguments run;
};

/// What is the same stays untouched, so that a workflow engine sees what changed.
void write_changed(const fs::path& path, const std::string& text) {
  std::ifstream in(path, std::ios::binary);
  if (in && std::string{std::istreambuf_iterator<char>(in), {}} == text) return;
  const fs::path folder = path.parent_path();
  write_file(folder.empty() ? "." : folder.string(), {path.filename().string(), text});
}

/// The plan that is there. One that cannot be read, among its cells' stamps, is made anew.
std::optional<Plan> plan_before(const std::string& path, const Log& log) {
  if (!fs::exists(path)) return {};
  try {
    return read_plan(path);
  } catch (const Error& e) {
    if (!fs::exists(cell_stamp_file(path, 0))) throw;
    log.message({Level::kWarning, std::string(e.what()) + ": made anew, files may change cells"});
    return {};
  }
}

int make(const MakePlanArguments& a) {
  validate(a.options);
  limit_threads(a.run.threads);
  const fs::path folder = fs::path(a.out).parent_path();
  make_folder(folder.empty() ? "." : folder.string());
  const CellLock lock(a.out);
  const Log log = a.run.log();
  const std::optional<Plan> previous = plan_before(a.out, log);
  const Inventory inventory = take_inventory(a.inputs, a.read);
  const Plan plan =
      make_plan(inventory, a.read, a.options, a.cells, previous ? &*previous : nullptr);
  for (std::size_t cell = 0; cell < plan.cells.size(); ++cell)
    write_changed(cell_stamp_file(a.out, cell), cell_stamp(plan, cell));
  write_changed(a.out, plan_text(plan));
  Scene problems;
  problems.failures = plan.failures;
  problems.warnings = plan.warnings;
  problems.buildings.resize(plan.building_count());
  log_problems(problems, log);
  log.message({Level::kInfo, std::to_string(plan.building_count()) + " buildings in " +
                                 std::to_string(plan.cells.size()) + " cells, written to " +
                                 a.out});
  return exit_code(problems);
}

}  // namespace

Run add_plan(CLI::App& app) {
  auto a = std::make_shared<MakePlanArguments>();
  add_config_option(app);
  app.add_option("INPUT", a->inputs, "files and folders with buildings")->required();
  app.add_option("-o,--out", a->out,
                 "plan.json to write; of one that is there, files keep their cells")
      ->required();
  app.add_option("--cells", a->cells, "parts that are worked on apart, default 8")
      ->check(number_between(1, 9999));
  add_input_options(app, a->read);
  add_folder_options(app, a->read);
  add_pipeline_options(app, a->options);
  add_run_options(app, a->run);
  return [a] {
    const Log log = a->run.log();
    switch_off_dependents(a->options, [&](const Message& m) { log.message(m); });
    return make(*a);
  };
}

}  // namespace colod::cli
