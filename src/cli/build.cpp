#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "../../exporters/files.h"
#include "../../exporters/glb.h"
#include "../../exporters/obj.h"
#include "../../exporters/tiles3d.h"
#include "../error.h"
#include "../parallel.h"
#include "../pipeline.h"
#include "../report.h"
#include "cli.h"
#include "input_options.h"

namespace colod::cli {
namespace {

struct BuildArguments {
  std::vector<std::string> inputs;
  std::string out;
  ReadOptions read;
  Options options;
  std::vector<std::string> formats = {"glb", "3dtiles"};
  int threads = 0;
  bool is_quiet = false, is_json_log = false;
};

/// Messages on stderr: lines, JSON lines, or a line that is drawn over while stderr is a terminal.
class Log {
 public:
  Log(bool is_quiet, bool is_json)
      : is_quiet_(is_quiet), is_json_(is_json), is_terminal_(isatty(2) != 0) {}

  void progress(const std::string& building, const char* stage, int done, int total) {
    if (is_json_)
      write({{"event", "progress"},
             {"building", building},
             {"stage", stage},
             {"done", done},
             {"total", total}});
    else if (is_terminal_ && !is_quiet_)
      std::fprintf(stderr, "\r\033[K%s %d/%d: %s", stage, done, total, building.c_str());
  }
  void message(const char* level, const std::string& text) {
    if (is_json_) return write({{"event", level}, {"message", text}});
    if (is_quiet_ && std::string(level) != "error") return;
    if (is_terminal_ && !is_quiet_) std::fprintf(stderr, "\r\033[K");
    std::fprintf(stderr, "colod: %s%s\n",
                 std::string(level) == "info" ? "" : (std::string(level) + ": ").c_str(),
                 text.c_str());
  }

 private:
  void write(const nlohmann::ordered_json& line) {
    std::fprintf(stderr, "%s\n", line.dump().c_str());
  }
  bool is_quiet_, is_json_, is_terminal_;
};

ExportBuilding export_building(const Building& b) {
  ExportBuilding result{
      .name = b.source.name, .source = b.source.path, .origin = b.frame.origin, .layers = {}};
  for (const Layer& layer : b.layers)
    if (layer.failure.empty())
      result.layers.push_back({layer.layer, layer.mesh, layer.geometric_error});
  return result;
}

/// Encodes building by building and writes at once, so that memory holds one building's files.
void export_scene(const Scene& scene, const BuildArguments& a) {
  const std::set<std::string> formats(a.formats.begin(), a.formats.end());
  std::vector<ExportBuilding> buildings;
  for (const Building& b : scene.buildings) {
    buildings.push_back(export_building(b));
    if (buildings.back().layers.empty()) buildings.pop_back();
  }
  parallel_for(buildings.size(), [&](std::size_t i) {
    if (formats.count("glb")) write_file(a.out, encode_building_glb(buildings[i]));
    for (const ExportLayer& layer : buildings[i].layers) {
      if (formats.count("obj")) write_file(a.out, encode_obj(buildings[i], layer));
      if (formats.count("ply")) write_file(a.out, encode_ply(buildings[i], layer));
    }
  });
  if (formats.count("3dtiles") && !buildings.empty()) {
    // tileset.json last: whoever finds it finds the tiles it names.
    const std::vector<Encoded> tiles = encode_tileset(buildings);
    for (std::size_t i = tiles.size(); i-- > 0;) write_file(a.out, tiles[i]);
  }
}

void report_problems(const Scene& scene, Log& log) {
  for (const ReadFailure& f : scene.failures) log.message("error", f.path + ": " + f.message);
  for (const Building& b : scene.buildings) {
    if (!b.failure.empty()) log.message("error", b.failure);
    for (const Layer& layer : b.layers)
      if (!layer.failure.empty())
        log.message("error", b.source.name + ", layer " + std::to_string(layer.layer) + ": " +
                                 layer.failure);
    for (const std::string& w : b.warnings) log.message("warning", b.source.name + ": " + w);
  }
}

int exit_code(const Scene& scene) {
  std::size_t failed = scene.failures.size();
  for (const Building& b : scene.buildings) failed += b.has_failed();
  if (failed == 0) return 0;
  const bool is_any_done = std::any_of(scene.buildings.begin(), scene.buildings.end(),
                                       [](const Building& b) { return b.failure.empty(); });
  if (is_any_done) return 1;
  return static_cast<int>(scene.buildings.empty() ? Stage::kInput : Stage::kProcess);
}

int build(const BuildArguments& a) {
  const auto start = std::chrono::steady_clock::now();
  const auto seconds = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  validate(a.options);
  limit_threads(a.threads);
  Log log(a.is_quiet, a.is_json_log);
  const Scene scene = build_scene(read_sources(a.inputs, a.read), a.options,
                                  [&](auto&&... args) { log.progress(args...); });
  export_scene(scene, a);
  const RunTotals totals{seconds(), peak_memory_bytes()};
  write_file(a.out, {"report.json", report_json(scene, a.options, totals)});
  report_problems(scene, log);
  const auto done = std::count_if(scene.buildings.begin(), scene.buildings.end(),
                                  [](const Building& b) { return b.failure.empty(); });
  std::ostringstream summary;
  summary << done << " of " << scene.buildings.size() + scene.failures.size() << " buildings in "
          << std::fixed << std::setprecision(1) << totals.seconds << " s, written to " << a.out
          << " (layer 0 is the coarsest; the tileset is local, not placed on Earth)";
  log.message("info", summary.str());
  return exit_code(scene);
}

void add_options(CLI::App& app, BuildArguments& a) {
  app.add_option("INPUT", a.inputs, "files and folders with buildings")->required();
  app.add_option("-o,--out", a.out, "folder to write to")->required();
  add_input_options(app, a.read);
  app.add_option_function<std::string>(
         "--rules",
         [&a](const std::string& v) {
           a.options.rules = v == "paper" ? Rules::kPaper : Rules::kRobust;
         },
         "robust (default) or the paper's letter")
      ->check(CLI::IsMember({"robust", "paper"}));
  for (const OptionInfo& info : option_table()) {
    const auto set = [&a, &info](const double& value) {
      if (info.is_integer &&
          (!(value >= info.min && value <= info.max) || value != std::floor(value)))
        throw Error(Stage::kUsage, "--" + info.name, "must be a whole number in its range");
      info.set(a.options, value);
    };
    std::ostringstream help;
    help << info.help << (info.unit.empty() ? "" : " [" + info.unit + "]") << ", default "
         << info.get(Options{});
    app.add_option_function<double>("--" + info.name, set, help.str());
  }
  app.add_option("--format", a.formats,
                 "glb, 3dtiles, obj, ply; several with commas (default glb,3dtiles)")
      ->delimiter(',')
      ->check(CLI::IsMember({"glb", "3dtiles", "obj", "ply"}));
  app.add_option("--threads", a.threads, "threads to use, 0 = all cores")
      ->check(CLI::Range(0, 4096));
  app.add_flag("--quiet", a.is_quiet, "errors only");
  app.add_flag("--log-json", a.is_json_log, "progress and messages as JSON lines on stderr");
  app.set_config("--config", "", "TOML or INI file with any of these options");
}

}  // namespace

Run add_build(CLI::App& app) {
  auto arguments = std::make_shared<BuildArguments>();
  add_options(app, *arguments);
  return [arguments] { return build(*arguments); };
}

}  // namespace colod::cli
