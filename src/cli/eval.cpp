#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli.h"
#include "core/error.h"
#include "core/parallel.h"
#include "image/look_sampler.h"
#include "input_options.h"
#include "log.h"
#include "measure/appearance.h"
#include "measure/consistency.h"
#include "measure/light_field.h"
#include "measure/looks.h"
#include "measure/metrics.h"
#include "measure/silhouettes.h"
#include "numbers.h"

namespace colod::cli {
namespace {

struct EvalArguments {
  std::string reference, model, truth;
  ReadOptions read;
  DistanceOptions distance;
  bool has_lfd = false, has_parts = false, has_appearance = false;
  double gsd = 0, memory = 512;  // metres; MiB
  int threads = 0;
};

void need_silhouettes(const Source& reference, const Source& model) {
  for (const Source* s : {&reference, &model})
    if (!s->is_mesh())
      throw Error(Stage::kInput, s->name, "points have no silhouette: --lfd compares two meshes");
}

using Json = nlohmann::ordered_json;

void add_light_fields(const Source& reference, const Source& model, Json& json) {
  need_silhouettes(reference, model);
  json["light_field_distance"] = light_field_distance(describe_light_fields(reference.mesh),
                                                      describe_light_fields(model.mesh));
  json["light_field_distance_program"] =
      light_field_distance(describe_as_program(reference.mesh), describe_as_program(model.mesh));
  const SilhouetteOverlap overlap = overlap_silhouettes(reference.mesh, model.mesh);
  json["silhouette_overlap"] = {{"mean", overlap.mean}, {"worst", overlap.worst}};
}

void tell_of_images(const Source& source, const LookSampler& look) {
  for (const std::vector<std::string>* lines : {&look.losses(), &look.warnings()})
    for (const std::string& line : *lines)
      Log(false, false).message({Level::kWarning, source.name + ": " + line});
}

void need_look(const Source& s) {
  if (!s.is_mesh() || s.look.is_empty())
    throw Error(Stage::kInput, s.name, "has neither textures nor colours: --appearance needs them");
}

void add_appearance(const Source& reference, const Source& model, const EvalArguments& a,
                    Json& json) {
  need_look(reference), need_look(model);
  const ImageCache images(static_cast<std::size_t>(a.memory * (1 << 20)));
  const LookSampler shown(reference.mesh, reference.look, images);
  const LookSampler judged(model.mesh, model.look, images);
  for (const auto& [source, look] : {std::pair(&reference, &shown), std::pair(&model, &judged)})
    tell_of_images(*source, *look);
  const AppearanceDifference d = compare_appearance(reference.mesh, shown, model.mesh, judged,
                                                    a.gsd > 0 ? a.gsd : judged.texel());
  json["appearance"] = {{"directions", d.directions},
                        {"gsd", d.gsd},
                        {"pixels", d.pixels},
                        {"psnr", d.psnr},
                        {"ssim", d.ssim},
                        {"flip", d.flip},
                        {"only_reference", d.only_reference},
                        {"only_model", d.only_model}};
}

Json read_report(const std::string& folder) {
  const std::string path = (std::filesystem::path(folder) / "report.json").string();
  std::ifstream in(path);
  if (!in)
    throw Error(Stage::kInput, path, "cannot be opened: name a folder that colod build wrote");
  try {
    return Json::parse(in);
  } catch (const Json::exception& e) {
    throw Error(Stage::kInput, path, std::string("damaged: ") + e.what());
  }
}

/// Per layer, coarsest first, which of a GLB's levels shows it, 0 the finest: a layer that is like
/// the finer one has its level.
std::vector<int> levels_of(const Json& layers) {
  std::vector<int> levels(layers.size(), 0);
  for (std::size_t k = layers.size() - 1; k-- > 0;)
    levels[k] = levels[k + 1] + (layers[k].value("like_finer", false) ? 0 : 1);
  return levels;
}

/// The layers of a building, coarsest first, in world coordinates; `levels`: of its GLB.
std::vector<Mesh> read_layers(const std::string& folder, const std::string& name,
                              const std::vector<int>& levels) {
  const std::string stem = (std::filesystem::path(folder) / "buildings" / name).string();
  std::vector<Mesh> meshes;
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const std::string text = stem + ".layer" + std::to_string(k);
    ReadOptions coarser;
    coarser.coarser = levels[k];
    if (std::filesystem::exists(text + ".obj"))
      meshes.push_back(read_single(text + ".obj").mesh);
    else if (std::filesystem::exists(text + ".ply"))
      meshes.push_back(read_single(text + ".ply").mesh);
    else
      meshes.push_back(read_single(stem + ".glb", coarser).mesh);
  }
  return meshes;
}

Json parts_json(const std::vector<PlacedPart>& parts) {
  Json json = Json::array();
  for (const PlacedPart& p : parts)
    json.push_back({{"building", p.building},
                    {"type", name_of(p.kind)},
                    {"instance", p.instance},
                    {"depth", p.depth},
                    {"seen", p.is_seen},
                    {"first", p.first},
                    {"shown", p.near}});
  return json;
}

/// Consistency of the layers in a folder that `build` or `export` wrote.
int eval_truth(const EvalArguments& a) {
  const Truth truth = read_truth(a.truth);
  const Json report = read_report(a.reference);
  std::vector<PlacedPart> parts;
  int layers = 0, judged = 0;
  for (const Json& b : report.at("buildings")) {
    const std::string name = b.at("name"), path = b.at("source");
    const auto named = std::find_if(truth.begin(), truth.end(),
                                    [&](const TruthBuilding& t) { return t.name == name; });
    const auto failed = [](const Json& layer) { return layer.contains("failure"); };
    if (named == truth.end() || b.at("layers").empty() ||
        std::any_of(b.at("layers").begin(), b.at("layers").end(), failed))
      continue;
    const int own = static_cast<int>(b.at("layers").size());
    layers = std::max(layers, own), ++judged;
    const std::vector<Source> sources = read_sources({path}, a.read).sources;
    const auto source = std::find_if(sources.begin(), sources.end(),
                                     [&](const Source& s) { return s.name == name; });
    const Source& shown = source != sources.end() ? *source : sources.at(0);
    const auto placed =
        place_parts(shown, *named, read_layers(a.reference, name, levels_of(b.at("layers"))));
    parts.insert(parts.end(), placed.begin(), placed.end());
  }
  Json json{{"truth", a.truth},
            {"buildings", judged},
            {"types", Json::parse(consistency_json(tally_parts(parts, layers)))}};
  if (a.has_parts) json["parts"] = parts_json(parts);
  print_answer(json.dump(2, ' ', false, Json::error_handler_t::replace));
  return 0;
}

int eval(const EvalArguments& a) {
  limit_threads(a.threads);
  if (!a.truth.empty()) return eval_truth(a);
  if (a.model.empty()) throw Error(Stage::kUsage, "MODEL", "is missing");
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
      {"enclosed_components", validity.enclosed_components},
      {"volume", validity.volume},
      {"hausdorff", {{"a_to_b", d.a_to_b}, {"b_to_a", d.b_to_a}, {"relative", d.relative}}},
      {"mean_distance", d.mean_a_to_b},
      {"mean_distance_back", d.mean_b_to_a},
      {"rms_distance", d.rms_a_to_b},
      {"samples", a.distance.samples}};
  const LookGauge gauge(reference);
  json["source"] = {{"faces", reference.mesh.faces.size()},
                    {"noise", gauge.source().noise},
                    {"edge", gauge.source().edge}};
  json["looks"] = Json::parse(looks_json(gauge.look_at(model.mesh)));
  if (a.has_lfd) add_light_fields(reference, model, json);
  if (a.has_appearance) add_appearance(reference, model, a, json);
  print_answer(json.dump(2, ' ', false, Json::error_handler_t::replace));
  return 0;
}

}  // namespace

Run add_eval(CLI::App& app) {
  auto a = std::make_shared<EvalArguments>();
  app.add_option("REFERENCE", a->reference,
                 "mesh or points that the model stands for (a); with --truth: a folder that build "
                 "wrote")
      ->required();
  app.add_option("MODEL", a->model, "mesh to judge (b); not with --truth");
  app.add_option("--truth", a->truth,
                 "truth.json of synth, or labels: on which layer the parts of each kind appear")
      ->check(CLI::ExistingFile);
  app.add_flag("--parts", a->has_parts,
               "with --truth: every part too, its relief and how much of it each layer shows");
  add_input_options(app, a->read);
  app.add_option("--samples", a->distance.samples, "area-uniform samples a side")
      ->check(number_between(1, 100000000));
  app.add_option("--seed", a->distance.seed, "of the samples")
      ->check(number_between(0.0, 9007199254740992.0));
  app.add_flag(
      "--lfd", a->has_lfd,
      "also the light field distance: how alike both look from all sides, 0 = the same; and how "
      "their silhouettes overlap");
  app.add_flag("--appearance", a->has_appearance,
               "also how alike both look: PSNR, SSIM and FLIP over the pixels of pictures from 24 "
               "directions");
  app.add_option("--gsd", a->gsd,
                 "with --appearance: side of a pixel [m], default that of the model's texels")
      ->check(number_between(1e-4, 1000.0));
  app.add_option("--texture-memory", a->memory,
                 "with --appearance: MiB that decoded images may take together, default 512; an "
                 "image that takes more is left out")
      ->check(number_between(1.0, 1e6));
  app.add_option("--threads", a->threads, "threads to use, 0 = all cores")
      ->check(number_between(0, 4096));
  return [a] { return eval(*a); };
}

}  // namespace colod::cli
