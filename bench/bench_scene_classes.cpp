// What a scene's cells are taken for: ground, buildings, plants and the rest, for
// bench/scene_truth.
//
//   bench_scene_classes SCENE OUT [--footprints FILE] [--threads N]
//
// OUT is a line of JSON (corner, cell, width, height; metres in the scene's frame) and then a byte
// a cell, row by row from the least y: 0 nothing, 1 ground, 2 building, 3 plant, 4 rest; and as
// many four-byte floats, the height of the ground below each. FILE: the plans that were found, for
// bench/footprints.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/parallel.h"
#include "job/scene_input.h"

using namespace colod;

int main(int argc, char** argv) {
  CLI::App app{"What a scene's cells are taken for"};
  std::string path, out, footprints;
  int threads = 0;
  app.add_option("scene", path, "what colod build takes for a scene")->required();
  app.add_option("out", out, "the file that is written")->required();
  app.add_option("--footprints", footprints,
                 "where the plans that were found are written, as GeoJSON");
  app.add_option("--threads", threads, "default: all");
  CLI11_PARSE(app, argc, argv);
  try {
    limit_threads(threads);
    SceneChoice choice;
    choice.mode = SceneMode::kScene;
    const Inputs inputs = open_inputs({path}, {}, choice, {}, [](const Message& m) {
      std::fprintf(stderr, "%s\n", m.text.c_str());
    });
    const HeightMap& map = inputs.scene->map;
    const SceneClasses& classes = inputs.scene->classes;
    std::ofstream file(out, std::ios::binary);
    file << nlohmann::json{{"corner", {map.origin.x(), map.origin.y()}},
                           {"cell", map.cell},
                           {"width", map.width},
                           {"height", map.height}}
                .dump()
         << '\n';
    for (const SceneClass c : classes.of_cell) file.put(static_cast<char>(c));
    file.write(reinterpret_cast<const char*>(classes.ground.data()),
               static_cast<std::streamsize>(classes.ground.size() * sizeof(float)));
    const std::string plans = footprints_geojson(inputs.scene->footprints, inputs.scene->place);
    if (!footprints.empty() && !(std::ofstream(footprints) << plans).flush())
      throw std::runtime_error(footprints + ": cannot be written");
    if (!file.flush()) throw std::runtime_error(out + ": cannot be written");
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
  return 0;
}
