// Differs: a building that fails keeps its place with the reason. A coarser layer that came out
// richer than the next finer one takes its mesh, so that detail never decreases along a chain;
// under robust rules also one whose volume is off by more than a fifth: it has lost part of the
// building.

#include "pipeline.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <tuple>

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "losses.h"
#include "parameters.h"
#include "rounds.h"
#include "scene/ground.h"
#include "scene/hidden.h"
#include "scene/left_out.h"
#include "stand_ins.h"

namespace colod {
namespace {

using namespace parameters::layers;

constexpr int kDistanceSamples = 25'000;  // means are off by 0.2 % in the median, 1.2 % at most

void append(std::vector<std::string>& to, const std::vector<std::string>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

constexpr const char* kEmptyLayer =
    "came out empty: no body in the input's box; a piece far away, or --unit, makes it too large";

constexpr const char* kNoRoof =
    "its walls are stepped as the cells of its heights are, since no roof was told apart from the "
    "ground: --footprints with its plan says where it stands";
constexpr const char* kSteppedByChoice =
    "its walls are stepped as the cells of its heights are: --rules robust without --without "
    "relief.melted makes them straight";

/// What is melted, which nothing with exact round shapes is, has its relief's planes, as has a
/// raster of heights, whose steps may look round; all else is freed of its ground and inside first.
void find_planes(Building& b, const Options& o) {
  Stopwatch watch(b.timings.planes);
  const bool is_of_heights = raster_cell(b.source.mesh) > 0;
  if (o.rules.has(Rule::kRelief) && (is_of_heights || find_rounds(b.source, o.rules).empty()))
    if (std::optional<Relief> relief = find_relief(b.source.mesh)) {
      b.planes = relief_planes(b.source, *std::move(relief));
      return;
    }
  if (is_of_heights)
    b.source.warnings.emplace_back(o.rules.has(Rule::kRelief) ? kNoRoof : kSteppedByChoice);
  if (o.rules.has(Rule::kGround)) b.source = separate_ground(std::move(b.source));
  if (o.rules.has(Rule::kHidden)) b.source = remove_hidden(std::move(b.source));
  b.planes = detect_planes(b.source, {.rules = o.rules,
                                      .distance = o.distance,
                                      .angle_deg = o.angle_deg,
                                      .min_points = o.min_points});
}

void find_segments(Building& b, const Options& o) {
  find_planes(b, o);
  b.segments =
      build_segments(b.planes, {.rules = o.rules,
                                .alcove_area = o.alcove_area,
                                .visibility = {.engine = o.visibility, .ns = o.ns, .nr = o.nr}});
  b.timings.visibility = b.segments.visibility_seconds;
  b.timings.segments = b.segments.aggregation_seconds;
  Stopwatch watch(b.timings.similarity);
  b.descriptors = describe_segments(b.planes, b.segments, b.source.name, {.seed = o.seed});
}

/// Layer k's planes join those of coarser layers, which are cut first: a finer partition refines
/// the coarser one.
void add_layer_planes(const Building& b, int k, const Options& o, std::vector<int>& order) {
  std::vector<char> is_taken(b.planes.planes.size(), 0);
  for (const int plane : order) is_taken[plane] = 1;
  for (const int plane : layer_planes(b.planes, b.segments, b.layer_of_segment, k,
                                      {.rules = o.rules, .layers = o.layers}))
    if (!is_taken[plane]) order.push_back(plane);
}

/// Metres: what is no detail on layer k. An exact model of few planes has none to give away.
double tolerance(const Building& b, int k, const Options& o) {
  if (!o.rules.has(Rule::kTolerance)) return 0;
  const bool is_plain = b.planes.is_clean() && b.planes.planes.size() <= kFewPlanes;
  const double least = kLeastTolerance * b.planes.box.diagonal();
  if (is_plain) return std::min(least, b.planes.distance);
  const double share = k + 1 < o.layers ? kTolerance / std::pow(2, k) : 0;
  return std::max(share * b.planes.box.diagonal(), least);
}

/// The layer of these planes; where round shapes have fewer sides, with planes of its own.
Extraction extract_planes(const Building& b, int k, const std::vector<RoundShape>& shapes,
                          const std::vector<int>& planes, std::vector<std::vector<int>> spares,
                          Sight& sight, const Options& o) {
  const ExtractionOptions options{.rules = o.rules,
                                  .nr = o.nr,
                                  .tolerance = tolerance(b, k, o),
                                  .is_finest = k + 1 == o.layers};
  if (shapes.empty() || options.is_finest || !o.rules.has(Rule::kRoundLayers))
    return extract_layer(b.planes, planes, spares, sight, options);
  const ReducedLayer reduced =
      reduce_layer(b.planes, planes, shapes, 2 * M_PI / (kSides * std::pow(2, k)));
  for (std::vector<int>& set : spares)
    std::erase_if(set, [&](int p) { return b.planes.has_side(p); });
  std::erase_if(spares, [](const std::vector<int>& set) { return set.empty(); });
  Sight seen(reduced.planes);  // a chord of the real surface would be taken for an inside
  Extraction result = extract_layer(reduced.planes, reduced.which, spares, seen, options);
  for (PolygonMesh::Facet& f : result.mesh.facets)
    if (f.plane >= 0) f.plane = reduced.real[f.plane];
  return result;
}

/// `planes`: in the order of cutting, those of coarser layers, and then of this one too.
void extract(Building& b, Layer& layer, const std::vector<RoundShape>& shapes,
             std::vector<int>& planes, Sight& sight, const Options& o) {
  try {
    add_layer_planes(b, layer.layer, o, planes);
    std::vector<std::vector<int>> spares;
    if (o.rules.has(Rule::kMissingPlanes) && layer.layer == 0 && o.layers > 1)
      spares = spare_planes(b.planes, b.segments, b.layer_of_segment, planes);
    Extraction result = extract_planes(b, layer.layer, shapes, planes, std::move(spares), sight, o);
    planes.insert(planes.end(), result.joined.begin(), result.joined.end());
    layer.mesh = std::move(result.mesh);
    if (layer.mesh.triangles.empty()) layer.failure = kEmptyLayer;
    for (const std::string& w : result.warnings)
      b.warnings.push_back("layer " + std::to_string(layer.layer) + ": " + w);
  } catch (const Error& e) {
    layer.failure = e.what();
  }
}

void unturn(PolygonMesh& mesh, const Frame& frame) {
  const Frame turn{Vec3::Zero(), frame.yaw};
  for (Vec3& v : mesh.vertices) v = turn.to_world(v);
  for (auto& f : mesh.facets) f.normal = turn.to_world(f.normal);
}

void unturn(Layer& layer, const Frame& frame) {
  unturn(layer.mesh, frame);
  for (FaultPlace& worst : layer.looks.worst)
    worst.place = Frame{Vec3::Zero(), frame.yaw}.to_world(worst.place);
}

void measure(const DistanceGauge& source, const LookGauge& looks, Layer& layer) {
  layer.looks = looks.look_at(layer.mesh.mesh());
  layer.distances = source.measure_to(layer.mesh.mesh());
  layer.validity = check_validity(layer.mesh.mesh());
  layer.validity.polygons = static_cast<int>(layer.mesh.facets.size());
}

/// Layers that did not fail, each with its sight.
void look_at_layers(Building& b) {
  std::vector<Mesh> meshes;
  std::vector<Layer*> shown;
  for (Layer& layer : b.layers)
    if (layer.failure.empty()) meshes.push_back(layer.mesh.mesh()), shown.push_back(&layer);
  std::vector<LayerSight> sights = measure_sights(meshes);
  for (std::size_t i = 0; i < shown.size(); ++i) shown[i]->sight = std::move(sights[i]);
}

/// Per item whether it has this mark, or, without one, any; empty: none has.
std::vector<char> parted(const Planes& planes, std::optional<int> mark = {}) {
  std::vector<char> is_parted;
  for (const int p : planes.plane_of_item)
    is_parted.push_back(mark ? p == *mark : p == kFloater || p == kAround);
  if (std::none_of(is_parted.begin(), is_parted.end(), [](char c) { return c; })) is_parted.clear();
  return is_parted;
}

/// What the planes left out, told by reason.
void tell_parted(Building& b) {
  for (const auto& [mark, reason] : {std::pair{kAround, LeftOut::Reason::kGround},
                                     std::pair{kFloater, LeftOut::Reason::kFloater}})
    if (const std::vector<char> is_parted = parted(b.planes, mark); !is_parted.empty())
      b.left_out.push_back(measure_left_out(b.source, is_parted, reason, b.left_out));
}

/// Where the buildings of each file stand in the scene, which is sorted by name.
std::vector<std::vector<std::size_t>> positions_by_name(const Inventory& inventory) {
  std::vector<std::tuple<std::string, std::size_t, std::size_t>> order;  // name, file, place in it
  std::vector<std::vector<std::size_t>> positions(inventory.files.size());
  for (std::size_t f = 0; f < positions.size(); ++f) {
    positions[f].resize(inventory.files[f].names.size());
    for (std::size_t i = 0; i < positions[f].size(); ++i)
      order.emplace_back(inventory.files[f].names[i], f, i);
  }
  std::sort(order.begin(), order.end());
  for (std::size_t k = 0; k < order.size(); ++k)
    positions[std::get<1>(order[k])][std::get<2>(order[k])] = k;
  return positions;
}

/// Descriptors and coverage are lent for the time: a city's would be large twice.
void choose_layer0(Scene& scene, const Options& options, const Prior* prior) {
  std::vector<SelectionBuilding> lent;
  for (Building& b : scene.buildings)
    lent.push_back({std::move(b.descriptors), std::move(b.segments.coverage)});
  scene.selection = select_layer0(lent, {.rules = options.rules,
                                         .beta = options.beta,
                                         .lambda = options.lambda,
                                         .eta = options.eta,
                                         .seed = options.seed,
                                         .gap = options.gap,
                                         .prior = prior});
  for (std::size_t i = 0; i < lent.size(); ++i) {
    scene.buildings[i].descriptors = std::move(lent[i].segments);
    scene.buildings[i].segments.coverage = std::move(lent[i].coverage);
  }
}

}  // namespace

const char* to_string(StandIn reason) {
  switch (reason) {
    case StandIn::kNone:
      return "";
    case StandIn::kRicher:
      return "richer";
    case StandIn::kInvented:
      return "invented";
    case StandIn::kVolume:
      return "volume";
  }
  return "";
}

bool is_failure(StandIn reason) {
  return reason == StandIn::kInvented || reason == StandIn::kVolume;
}

bool Building::is_ragged() const {
  if (layers.empty() || !layers.back().failure.empty()) return false;
  const Looks& looks = layers.back().looks;
  return looks.wall_area > kLeastWall && looks.ragged > kMostRagged * looks.wall_area;
}

bool Building::has_lost_shape() const {
  return is_ragged() || std::any_of(left_out.begin(), left_out.end(), is_loss) ||
         std::any_of(layers.begin(), layers.end(),
                     [](const Layer& l) { return is_failure(l.stand_in); });
}

bool Building::has_failed() const {
  return !failure.empty() || std::any_of(layers.begin(), layers.end(),
                                         [](const Layer& l) { return !l.failure.empty(); });
}

void leave_out_dismissed(Scene& scene) {
  for (const Building& b : scene.buildings)
    if (b.is_dismissed) scene.warnings.push_back(b.failure);
  std::erase_if(scene.buildings, [](const Building& b) { return b.is_dismissed; });
}

Counts count(const Building& b) {
  const std::vector<Vec3>& points =
      b.source.is_mesh() ? b.source.mesh.vertices : b.source.cloud.points;
  return {points.size(), b.source.mesh.faces.size(), b.planes.planes.size(),
          bounding_box(points).diagonal()};
}

void drop_geometry(Building& b) {
  b.source.mesh = {};
  b.source.cloud = {};
  b.source.face_object = std::vector<int>();
  b.source.look = {};
  b.planes = {};
}

void note_look(Building& b) {
  b.has_texture = b.source.look.has_detail();
  b.has_colors = !b.source.look.is_empty();
}

Building segment_building(Turn turn, const Options& options) {
  Building b;
  Source& source = turn.source;
  try {
    if (turn.problem) throw *turn.problem;
    b.frame = main_frame(source);
    b.timings.read = source.read_seconds;
    b.source = localize(source, b.frame);
    find_segments(b, options);
    b.left_out = b.source.left_out;
    note_look(b);
    tell_parted(b);
  } catch (const Error& e) {
    b.failure = e.what();
  } catch (const std::exception& e) {  // a library gave up: this building's problem only
    b.failure = source.name + ": " + e.what();
  }
  if (b.source.name.empty())
    b.source.name = source.name, b.source.given_name = source.given_name,
    b.source.path = source.path;
  b.counts = count(b);
  append(b.warnings, b.source.warnings);
  append(b.warnings, b.planes.warnings);
  append(b.warnings, b.segments.warnings);
  return b;
}

void analyze_scene(Scene& scene, const Options& options, const Prior* prior) {
  Stopwatch watch(scene.coanalysis_seconds);
  if (prior && prior->layers != options.layers)
    throw Error(Stage::kUsage, "--prior",
                "it has " + std::to_string(prior->layers) + " layers, not " +
                    std::to_string(options.layers));
  scene.has_prior = prior != nullptr;
  choose_layer0(scene, options, prior);
  scene.overruled.clear();
  for (const Overruled& o : scene.selection.overruled) {
    const Building& b = scene.buildings[o.building];
    scene.overruled.push_back({b.source.name, o.segment, b.descriptors[o.segment].kind});
  }
  std::vector<Descriptor> rest;
  for (std::size_t i = 0; i < scene.buildings.size(); ++i)
    for (std::size_t s = 0; s < scene.buildings[i].descriptors.size(); ++s)
      if (!scene.selection.is_layer0[i][s]) rest.push_back(scene.buildings[i].descriptors[s]);
  const ClusteringOptions clustering{
      .rules = options.rules,
      .layering = options.is_size_layering ? Layering::kSize : Layering::kSpectral,
      .layers = options.layers,
      .eta = options.eta,
      .seed = options.seed};
  scene.clustering =
      prior ? classify_segments(rest, *prior, clustering) : cluster_segments(rest, clustering);
  std::size_t next = 0;
  for (std::size_t i = 0; i < scene.buildings.size(); ++i) {
    Building& b = scene.buildings[i];
    b.layer_of_segment.assign(b.descriptors.size(), 0);
    for (std::size_t s = 0; s < b.descriptors.size(); ++s)
      if (!scene.selection.is_layer0[i][s]) b.layer_of_segment[s] = scene.clustering.layer[next++];
  }
}

void Hooks::check() const {
  if (is_cancelled && is_cancelled()) throw Cancelled{};
}

void mesh_building(Building& b, const Options& options, const Hooks& hooks) {
  if (!b.failure.empty()) return;
  try {
    Sight sight(b.planes);
    const std::vector<RoundShape> shapes = options.rules.has(Rule::kRoundSides)
                                               ? find_rounds(b.source, options.rules)
                                               : std::vector<RoundShape>();
    mark_sides(shapes, b.planes);
    std::vector<int> planes;
    for (int k = 0; k < options.layers; ++k) {
      hooks.check();
      Layer layer;
      layer.layer = k;
      layer.segments = static_cast<int>(std::count_if(
          b.layer_of_segment.begin(), b.layer_of_segment.end(), [k](int l) { return l <= k; }));
      Stopwatch watch(b.timings.extraction);
      extract(b, layer, shapes, planes, sight, options);
      b.layers.push_back(std::move(layer));
    }
    keep_chain_sound(b, options);
    Stopwatch watch(b.timings.measure);
    const Surface surface = surface_of(b);
    weigh_finest(surface, b);
    if (options.rules.has(Rule::kScenePart)) b.failure = judge_building(surface, b);
    if (!b.failure.empty()) {
      b.is_dismissed = b.source.is_found;
      b.layers.clear();
      forget_losses(b);
      return;
    }
    replace_invented(surface, options.rules.has(Rule::kVolume), b);
    const DistanceGauge source(b.source, {.samples = kDistanceSamples}, parted(b.planes));
    const LookGauge looks(b.source, surface);
    for (Layer& layer : b.layers)
      if (layer.failure.empty()) measure(source, looks, layer);
    look_at_layers(b);
    for (Layer& layer : b.layers) unturn(layer, b.frame);
  } catch (const std::exception& e) {
    b.layers.clear();
    b.failure = b.source.name + ": " + e.what();
  }
}

std::vector<PlacedPart> place_parts(const Building& b, const Source& source, const Truth& truth) {
  const auto named = std::find_if(truth.begin(), truth.end(),
                                  [&](const TruthBuilding& t) { return t.name == source.name; });
  if (named == truth.end() || b.has_failed()) return {};
  const Frame turn{Vec3::Zero(), b.frame.yaw};  // layers are parallel to the world's axes
  std::vector<Mesh> layers;
  for (const Layer& layer : b.layers) {
    layers.push_back(layer.mesh.mesh());
    for (Vec3& v : layers.back().vertices) v = turn.to_local(v);
  }
  return place_parts(source, *named, layers);
}

void for_each_source(const Inventory& inventory, const Reader& read,
                     const std::function<void(Turn)>& body) {
  const std::vector<std::vector<std::size_t>> positions = positions_by_name(inventory);
  parallel_for(inventory.files.size(), [&](std::size_t f) {
    const InputFile& file = inventory.files[f];
    std::vector<Source> sources(file.names.size());
    std::optional<Error> problem;
    try {
      sources = read(f);
    } catch (const Error& e) {
      problem = e;
    } catch (const std::exception& e) {  // a library gave up, or memory
      problem = Error(Stage::kInput, file.path, std::string("cannot be read: ") + e.what());
    }
    if (problem) {
      sources.resize(file.names.size());
      for (std::size_t i = 0; i < sources.size(); ++i)
        sources[i].name = file.names[i], sources[i].path = file.path;
    }
    parallel_for(sources.size(), [&](std::size_t i) {
      body({std::move(sources[i]), positions[f][i], problem});
    });
  });
}

Scene build_scene(const Inventory& inventory, const Reader& read, const Options& options,
                  const Hooks& hooks, const Prior* prior) {
  Scene scene;
  scene.failures = inventory.failures;
  scene.warnings = inventory.warnings;
  scene.buildings.resize(inventory.building_count());
  std::mutex mutex;
  int done = 0;
  const auto report = [&](const Building& b, const char* stage) {
    const std::lock_guard lock(mutex);
    if (hooks.progress)
      hooks.progress(b.source.name, stage, ++done, static_cast<int>(scene.buildings.size()));
  };
  for_each_source(inventory, read, [&](Turn turn) {
    hooks.check();
    Building& b = scene.buildings[turn.position];
    b = segment_building(std::move(turn), options);
    for (const Observer& o : hooks.observers)
      if (o.segmented) o.segmented(b);
    if (hooks.depot) hooks.depot->put(b);
    report(b, "segments");
  });
  hooks.check();
  analyze_scene(scene, options, prior);
  done = 0;
  parallel_for(scene.buildings.size(), [&](std::size_t i) {
    hooks.check();
    Building& b = scene.buildings[i];
    if (hooks.depot) hooks.depot->get(b);
    mesh_building(b, options, hooks);
    for (const Observer& o : hooks.observers)
      if (o.meshed) o.meshed(b);
    if (hooks.depot) hooks.depot->drop(b);
    report(b, "layers");
  });
  hooks.check();
  return scene;
}

Scene build_scene(ReadResult input, const Options& options, const Hooks& hooks,
                  const Prior* prior) {
  Inventory inventory{{}, std::move(input.failures), {}};
  for (const Source& s : input.sources) inventory.files.push_back({s.path, {s.name}});
  const Reader take = [&](std::size_t i) {
    std::vector<Source> one;
    one.push_back(std::move(input.sources[i]));
    return one;
  };
  return build_scene(inventory, take, options, hooks, prior);
}

}  // namespace colod
