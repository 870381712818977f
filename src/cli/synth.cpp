#include "synth/synth.h"

#include <cstdio>
#include <memory>

#include "cli.h"
#include "core/parallel.h"
#include "exporters/files.h"
#include "numbers.h"

namespace colod::cli {
namespace {

struct SynthArguments {
  SynthOptions options;
  std::string out;
  int threads = 0;
};

int synth(const SynthArguments& a) {
  limit_threads(a.threads);
  const std::vector<SynthBuilding> buildings = make_neighbourhood(a.options);
  for (const SynthBuilding& b : buildings) {
    if (a.options.is_scan)
      write_file(a.out, {b.source.name + ".ply", synth_ply(b)});
    else
      write_file(a.out, {b.source.name + ".obj", synth_obj(b)});
  }
  write_file(a.out, {"truth.json", truth_json(buildings, a.options)});
  std::fprintf(stderr, "colod: %zu buildings and truth.json written to %s\n", buildings.size(),
               a.out.c_str());
  return 0;
}

}  // namespace

Run add_synth(CLI::App& app) {
  auto a = std::make_shared<SynthArguments>();
  app.add_option("-o,--out", a->out, "folder to write to")->required();
  app.add_option("--buildings", a->options.buildings, "how many, default 20")
      ->check(number_between(1, 10000));
  app.add_option("--seed", a->options.seed, "of everything drawn at random, default 1")
      ->check(number_between(0.0, 9007199254740992.0));
  app.add_flag("--scan", a->options.is_scan, "as a simulated photogrammetry mesh");
  app.add_option("--noise", a->options.noise, "sigma of the scan's noise [m], default 0.025")
      ->check(number_between(0.0, 1.0));
  app.add_option("--density", a->options.density, "samples of the scan per m2, default 40")
      ->check(number_between(1.0, 1000.0));
  app.add_option("--threads", a->threads, "threads to use, 0 = all cores")
      ->check(number_between(0, 4096));
  return [a] { return synth(*a); };
}

}  // namespace colod::cli
