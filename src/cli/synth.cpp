#include "synth/synth.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <map>
#include <memory>

#include "cli.h"
#include "core/error.h"
#include "core/parallel.h"
#include "exporters/files.h"
#include "numbers.h"
#include "synth/paint.h"
#include "synth_scene.h"

namespace colod::cli {
namespace {

struct SynthArguments {
  SynthOptions options;
  std::string out, scan;
  int threads = 0;
  bool is_textured = false, is_scene = false;
  double texel = 0.03;
  SynthLayout layout = SynthLayout::kObj;
};

/// Text that is read again once it is whole and, meanwhile, takes no memory.
class Spool {
 public:
  Spool() : file_(std::tmpfile()) {
    if (!file_) fail("no temporary file can be made: ");
  }
  ~Spool() { std::fclose(file_); }
  Spool(const Spool&) = delete;
  Spool& operator=(const Spool&) = delete;

  void append(const std::string& text) {
    if (std::fwrite(text.data(), 1, text.size(), file_) != text.size())
      fail("a temporary file cannot be written: ");
  }
  void read(const Append& take) {
    std::rewind(file_);
    std::string piece(1 << 16, '\0');
    for (std::size_t n; (n = std::fread(piece.data(), 1, piece.size(), file_)) > 0;)
      take(piece.substr(0, n));
    if (std::ferror(file_)) fail("a temporary file cannot be read: ");
  }

 private:
  [[noreturn]] static void fail(const char* cause) {
    throw Error(Stage::kOutput, "truth.json", std::string(cause) + std::strerror(errno));
  }
  std::FILE* file_;
};

/// A scan is painted with what its clean model shows.
void write_painted(const SynthArguments& a, const std::vector<SynthBuilding>& buildings,
                   const std::vector<SynthBuilding>& clean, const std::string& out) {
  parallel_for(buildings.size(), [&](std::size_t i) {
    const std::string& name = buildings[i].source.name;
    const PaintedModel model = paint(buildings[i], a.texel, clean.empty() ? nullptr : &clean[i]);
    write_file(out, {name + ".obj", model.obj});
    write_file(out, {name + ".mtl", model.mtl});
    write_file(out, {name + ".jpg", model.image});
  });
}

void write_models(const std::vector<SynthBuilding>& buildings, const std::string& out) {
  for (const SynthBuilding& b : buildings) write_file(out, {b.source.name + ".obj", synth_obj(b)});
}

void write_batch(const SynthArguments& a, const SynthBatch& batch) {
  const bool is_scan = a.options.is_scan || a.options.is_drone;
  if (a.is_textured) {
    write_painted(a, batch.buildings, batch.clean, a.out);
    if (is_scan) write_painted(a, batch.clean, {}, a.out + "/clean");
  } else if (is_scan) {
    for (const SynthBuilding& b : batch.buildings)
      write_file(a.out, {b.source.name + ".ply", synth_ply(b)});
    if (a.options.is_drone) write_models(batch.clean, a.out + "/clean");
  } else {
    write_models(batch.buildings, a.out);
  }
}

int synth(const SynthArguments& a) {
  limit_threads(a.threads);
  Spool truth;
  truth.append(truth_before(a.options));
  int done = 0;
  stream_neighbourhood(a.options, [&](const SynthBatch& batch) {
    write_batch(a, batch);
    for (const SynthBuilding& b : batch.buildings)
      truth.append((done++ > 0 ? ",\n" : "") + truth_entry(b));
  });
  truth.append(truth_after());
  write_file(a.out, "truth.json", [&](const Append& append) { truth.read(append); });
  std::fprintf(stderr, "colod: %d buildings and truth.json written to %s\n", done, a.out.c_str());
  return 0;
}

/// Apart from the streets' options, of which it takes the few that say the same of it.
void add_scene_options(CLI::App& app, SynthArguments& a) {
  CLI::Option* scene = app.add_flag(
      "--scene", a.is_scene,
      "a whole place: hills, roads, houses, rows, courts, halls, sheds, trees, cars as "
      "one textured mesh in tiles, with its truth; --buildings (default 100), --seed, "
      "--scan-edge and --texel-size (default 0.1) hold for it");
  for (const char* other :
       {"--scan", "--noise", "--sizes", "--variety", "--plan", "--slopes", "--texture"})
    scene->excludes(app.get_option(other));
  app.add_option(
         "--layout", a.layout,
         "of a scene's files: obj, as ContextCapture writes them (default), odm, 3dtiles, or las, "
         "an airborne cloud of --density points per m2 (default 10) with classes")
      ->needs(scene)
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, SynthLayout>{{"obj", SynthLayout::kObj},
                                             {"odm", SynthLayout::kOdm},
                                             {"3dtiles", SynthLayout::k3dTiles},
                                             {"las", SynthLayout::kLas}}));
}

int synth_scene(const SynthArguments& a, bool has_buildings, bool has_texel, bool has_density) {
  limit_threads(a.threads);
  SynthSceneOptions options;
  options.seed = a.options.seed, options.edge = a.options.scan_edge;
  if (has_buildings) options.buildings = a.options.buildings;
  if (has_texel) options.texel = a.texel;
  if (has_density) options.density = a.options.density;
  write_synth_scene(options, a.layout, a.out);
  return 0;
}

}  // namespace

Run add_synth(CLI::App& app) {
  auto a = std::make_shared<SynthArguments>();
  app.add_option("-o,--out", a->out, "folder to write to")->required();
  const CLI::Option* buildings =
      app.add_option("--buildings", a->options.buildings, "how many, default 20")
          ->check(number_between(1, 10000));
  app.add_option("--seed", a->options.seed, "of everything drawn at random, default 1")
      ->check(number_between(0.0, 9007199254740992.0));
  const CLI::Option* scan =
      app.add_option("--scan", a->scan,
                     "as a simulated photogrammetry mesh: near, with pictures from the street, or "
                     "drone; near where none is named")
          ->expected(0, 1)
          ->check(CLI::IsMember({"near", "drone"}));
  app.add_option("--scan-edge", a->options.scan_edge,
                 "median edge of a drone's mesh [m], default 0.6")
      ->check(number_between(0.02, 20.0));
  app.add_option("--noise", a->options.noise, "sigma of the scan's noise [m], default 0.025")
      ->check(number_between(0.0, 1.0));
  const CLI::Option* density =
      app.add_option("--density", a->options.density, "samples of the scan per m2, default 40")
          ->check(number_between(1.0, 1000.0));
  app.add_option("--sizes", a->options.sizes,
                 "alike: as builders make them; mixed: every kind from tiny to huge, so that no "
                 "size tells a kind")
      ->transform(CLI::CheckedTransformer(std::map<std::string, SynthSizes>{
          {"alike", SynthSizes::kAlike}, {"mixed", SynthSizes::kMixed}}));
  app.add_flag("--variety", a->options.is_varied,
               "plans, roofs, windows, dormers and balconies of many makes, from wide ranges");
  app.add_option("--plan", a->options.plans, "with --variety: any, hall or office alone")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, SynthPlans>{{"any", SynthPlans::kAny},
                                            {"hall", SynthPlans::kHalls},
                                            {"office", SynthPlans::kOffices}}));
  app.add_flag("--slopes", a->options.has_slopes, "with --variety: houses on sloping ground");
  app.add_flag(
      "--texture", a->is_textured,
      "brick, plaster, tiles, glass and a word on every wall, in OBJ, MTL and JPEG; scans too");
  const CLI::Option* texel =
      app.add_option("--texel-size", a->texel, "of the textures [m], default 0.03")
          ->check(number_between(0.002, 1.0));
  app.add_option("--threads", a->threads, "threads to use, 0 = all cores")
      ->check(number_between(0, 4096));
  add_scene_options(app, *a);
  return [a, scan, buildings, texel, density] {
    if (a->is_scene)
      return synth_scene(*a, buildings->count() > 0, texel->count() > 0, density->count() > 0);
    a->options.is_drone = a->scan == "drone";
    a->options.is_scan = scan->count() > 0 && !a->options.is_drone;
    return synth(*a);
  };
}

}  // namespace colod::cli
