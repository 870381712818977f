#include "job.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "core/error.h"
#include "core/parallel.h"
#include "judge.h"
#include "pipeline/switches.h"
#include "publish/report_pictures.h"
#include "rules/rules.h"
#include "scene_input.h"
#include "store/store.h"

namespace colod {
namespace {

/// What is read before the buildings are.
struct Beside {
  Truth truth;
  std::optional<Prior> prior;
  std::vector<BuildingSights> sights;
};

Beside read_beside(const Job& job, const JobHooks& hooks) {
  validate(job.options);
  check_output(job.output);
  Beside beside;
  if (!job.truth.empty()) beside.truth = read_truth(job.truth);
  beside.prior = read_prior(job.prior);
  beside.sights = read_sights(job.prior, job.options.layers, hooks.tell);
  return beside;
}

/// `build` calls build_scene with the hooks and the prior that it gets.
Product work(const Job& job, const JobHooks& hooks, const Beside& beside, std::size_t buildings,
             const std::function<Scene(const Hooks&, const Prior*)>& build) {
  check_cost(job.options, buildings);
  if (hooks.ready) hooks.ready();
  auto store = std::make_unique<TemporaryStore>();
  Judge judge(beside.truth);
  Gallery gallery(buildings, job.options.layers);
  Hooks inner{.depot = store.get(),
              .observers = {},
              .progress = hooks.progress,
              .is_cancelled = hooks.is_cancelled};
  if (!beside.truth.empty()) inner.observers.push_back(judge.observer());
  if (!job.output.has_no_page) inner.observers.push_back(gallery.observer());
  Product product{build(inner, beside.prior ? &*beside.prior : nullptr), {}, nullptr, nullptr};
  if (!beside.truth.empty())
    product.scene.consistency = tally_parts(judge.parts(), job.options.layers);
  decide_switches(product.scene, job.options.layers, switch_options(job.output), beside.sights);
  product.pictures = gallery.take(product.scene);
  product.depot = std::move(store);
  return product;
}

}  // namespace

Product run_job(const std::vector<std::string>& inputs, const Job& job, const JobHooks& hooks) {
  const Beside beside = read_beside(job, hooks);
  const Inputs found = open_inputs(
      inputs, job.read, job.scene,
      {job.output.crs, job.output.origin, job.output.target_sse, job.output.switching.pixel_error},
      hooks.tell);
  Product product = work(job, hooks, beside, found.inventory.building_count(),
                         [&](const Hooks& inner, const Prior* prior) {
                           Scene scene =
                               build_scene(found.inventory, found.read, job.options, inner, prior);
                           add_place(found, scene);
                           return scene;
                         });
  if (found.scene) product.archive = found.scene->tiles.tree().archive;
  return product;
}

Product run_job(const std::vector<NamedArrays>& buildings, const Job& job, const JobHooks& hooks) {
  const Beside beside = read_beside(job, hooks);
  ReadResult input = take_arrays(buildings, job.read);
  const std::size_t count = input.sources.size();
  return work(job, hooks, beside, count, [&](const Hooks& inner, const Prior* prior) {
    return build_scene(std::move(input), job.options, inner, prior);
  });
}

void switch_off_dependents(Options& options, const Tell& tell) {
  const RuleSet met = with_needs_met(options.rules);
  if (met == options.rules) return;
  std::string ids;
  for (const RuleInfo& info : rule_table())
    if (options.rules.has(info.rule) && !met.has(info.rule))
      ids.append(ids.empty() ? "" : ", ").append(info.id);
  if (tell)
    tell({Level::kWarning,
          "--without: " + ids + " off as well, for want of what is off: colod rules ID names it"});
  options.rules = met;
}

std::optional<Prior> read_prior(const std::string& path) {
  if (path.empty()) return std::nullopt;
  return Store(path, false).prior();
}

std::vector<BuildingSights> read_sights(const std::string& prior, int layers, const Tell& tell) {
  if (prior.empty()) return {};
  const Store store(prior, false);
  if (const int its = store.options().layers; its != layers)
    throw Error(Stage::kUsage, "--prior",
                "it has " + std::to_string(its) + " layers, not " + std::to_string(layers));
  std::vector<BuildingSights> sights = store.sights();
  if (sights.empty() && tell)
    tell({Level::kWarning, prior + ": holds no meshes, so that this scene's own buildings "
                                   "decide where layers switch: run colod mesh on it first"});
  return sights;
}

void check_cost(const Options& options, std::size_t buildings) {
  constexpr double kBytesAVoxel = 16;  // measured: 14.5 GiB for 1000³ of a house
  constexpr double kGiB = 1 << 30;
  const double memory =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
  const auto at_once = std::min<std::size_t>(thread_count(), std::max<std::size_t>(buildings, 1));
  const double most = memory / 2 / static_cast<double>(at_once);
  const double taken = kBytesAVoxel * std::pow(options.ns, 3);
  if (taken <= most) return;
  std::ostringstream cause;
  cause << std::setprecision(3) << options.ns << " takes about " << taken / kGiB
        << " GiB a building, " << at_once << " at once, of this machine's " << memory / kGiB
        << " GiB: at most " << static_cast<int>(std::cbrt(most / kBytesAVoxel))
        << ", or fewer --threads";
  throw Error(Stage::kUsage, "--ns", cause.str());
}

}  // namespace colod
