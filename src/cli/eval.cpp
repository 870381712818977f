#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "../error.h"
#include "../light_field.h"
#include "../metrics.h"
#include "../parallel.h"
#include "cli.h"
#include "input_options.h"

namespace colod::cli {
namespace {

struct EvalArguments {
  std::string reference, model;
  ReadOptions read;
  DistanceOptions distance;
  bool has_lfd = false;
  int threads = 0;
};

int light_fields_apart(const Source& reference, const Source& model) {
  for (const Source* s : {&reference, &model})
    if (!s->is_mesh())
      throw Error(Stage::kInput, s->name, "points have no silhouette: --lfd compares two meshes");
  return light_field_distance(describe_light_fields(reference.mesh),
                              describe_light_fields(model.mesh));
}

int eval(const EvalArguments& a) {
  limit_threads(a.threads);
  const Source reference = read_single(a.reference, a.read);
  const Source model = read_single(a.model, a.read);
  const Validity validity = check_validity(model.mesh);
  const Distances d = measure_distances(reference, model.mesh, a.distance);
  nlohmann::ordered_json json{
      {"vertices", validity.vertices},
      {"faces", validity.faces},
      {"polygons", validity.polygons},
      {"watertight", validity.is_watertight},
      {"manifold", validity.is_manifold},
      {"self_intersections", validity.self_intersections},
      {"least_width", validity.least_width},
      {"boundary_edges", validity.boundary_edges},
      {"nonmanifold_edges", validity.nonmanifold_edges},
      {"nonmanifold_vertices", validity.nonmanifold_vertices},
      {"degenerate_faces", validity.degenerate_faces},
      {"components", validity.components},
      {"volume", validity.volume},
      {"hausdorff", {{"a_to_b", d.a_to_b}, {"b_to_a", d.b_to_a}, {"relative", d.relative}}},
      {"mean_distance", d.mean_a_to_b},
      {"mean_distance_back", d.mean_b_to_a},
      {"rms_distance", d.rms_a_to_b},
      {"samples", a.distance.samples}};
  if (a.has_lfd) json["light_field_distance"] = light_fields_apart(reference, model);
  std::printf("%s\n", json.dump(2).c_str());
  return 0;
}

}  // namespace

Run add_eval(CLI::App& app) {
  auto a = std::make_shared<EvalArguments>();
  app.add_option("REFERENCE", a->reference, "mesh or points that the model stands for (a)")
      ->required();
  app.add_option("MODEL", a->model, "mesh to judge (b)")->required();
  add_input_options(app, a->read);
  app.add_option("--samples", a->distance.samples, "area-uniform samples a side")
      ->check(CLI::Range(1, 100000000));
  app.add_option("--seed", a->distance.seed, "of the samples")
      ->check(CLI::Range(0.0, 9007199254740992.0));
  app.add_flag("--lfd", a->has_lfd,
               "also the light field distance: how alike both look from all sides, 0 = the same");
  app.add_option("--threads", a->threads, "threads to use, 0 = all cores")
      ->check(CLI::Range(0, 4096));
  return [a] { return eval(*a); };
}

}  // namespace colod::cli
