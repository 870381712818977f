// How alike the layers of parts of the same kind are: ours beside the baselines.
//
//   bench_consistency FOLDER --truth TRUTH.json [--ns N] [--layers N] [--only NAME...] [--json]
//   [--segments FILE] [--no-meshes] [--threads N] [--nr N] [--visibility ENGINE]
//
// FOLDER holds meshes whose faces carry object numbers. Buildings are segmented once; then every
// method gives layers to the segments: joint (the product), alone (each building analysed for
// itself), extent and volume (size thresholds, placed so that as many segments lie on each layer as
// the joint analysis puts there). Quadric collapse has no segments: its layers are asked
// for as many faces as the joint ones. `mesh`: by the meshes, as `colod eval --truth` does it;
// `segment`: by the layer of the segment that overlaps a part most, where one has an IoU of face
// area of at least 0.3.
// --segments writes every segment with its descriptor, layer and part as JSON.
#include <meshoptimizer.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/parallel.h"
#include "pipeline/pipeline.h"
#include "read/read.h"

using namespace colod;
using nlohmann::json;

namespace {

constexpr double kLeastOverlap = 0.3;

struct Settings {
  std::string folder, truth, segments;
  Options options;
  std::vector<std::string> only;
  int threads = 0;
  bool is_json = false, has_no_meshes = false;
};

struct Result {
  std::string method;
  std::vector<TypeConsistency> by_mesh, by_segment;
};

/// Per layer, over all buildings: quadric collapse stops short where borders and loose pieces are.
struct Faces {
  std::vector<std::size_t> asked, got;
};

const TruthBuilding* truth_of(const Truth& truth, const std::string& name) {
  for (const TruthBuilding& t : truth)
    if (t.name == name) return &t;
  return nullptr;
}

/// Per truth part of the building the segment that overlaps it most, or −1.
std::vector<int> segments_of_parts(const Building& b, const TruthBuilding& truth) {
  const std::size_t segments = b.segments.segments.size();
  std::map<int, std::vector<double>> inside;  // per object: area in each segment
  std::map<int, double> area;
  std::vector<double> segment_area(segments, 0);
  for (std::size_t f = 0; f < b.source.mesh.faces.size(); ++f) {
    const double a = face_area(b.source.mesh, b.source.mesh.faces[f]);
    const int object = b.source.face_object[f];
    area[object] += a;
    const int plane = b.planes.plane_of_item[f];
    const int s = plane < 0 ? -1 : b.segments.segment_of_plane[plane];
    if (s < 0) continue;
    segment_area[s] += a;
    auto& row = inside[object];
    row.resize(segments, 0);
    row[s] += a;
  }
  std::vector<int> result;
  for (const TruthPart& p : truth.parts) {
    double best = kLeastOverlap;
    int who = -1;
    const auto row = inside.find(p.instance);
    for (std::size_t s = 0; row != inside.end() && s < segments; ++s) {
      const double iou = row->second[s] / (area[p.instance] + segment_area[s] - row->second[s]);
      if (iou > best) best = iou, who = static_cast<int>(s);
    }
    result.push_back(who);
  }
  return result;
}

std::vector<PlacedPart> place_by_segments(const Scene& scene, const Truth& truth, int layers) {
  std::vector<PlacedPart> placed;
  for (const Building& b : scene.buildings) {
    const TruthBuilding* t = truth_of(truth, b.source.name);
    if (!t || !b.failure.empty()) continue;
    const std::vector<int> segment = segments_of_parts(b, *t);
    for (std::size_t i = 0; i < t->parts.size(); ++i) {
      PlacedPart p;
      p.building = t->name, p.kind = t->parts[i].kind, p.depth = t->parts[i].depth;
      p.level = t->parts[i].level;
      p.is_seen = segment[i] >= 0;
      p.present.assign(layers, 0);
      if (p.is_seen) p.first = b.layer_of_segment[segment[i]];
      for (int k = std::max(0, p.first); k < layers; ++k) p.present[k] = p.is_seen;
      placed.push_back(p);
    }
  }
  return placed;
}

std::vector<PlacedPart> place_by_meshes(const Scene& scene, const Truth& truth) {
  std::vector<std::vector<PlacedPart>> placed(scene.buildings.size());
  parallel_for(placed.size(), [&](std::size_t i) {
    placed[i] = place_parts(scene.buildings[i], scene.buildings[i].source, truth);
  });
  std::vector<PlacedPart> all;
  for (const auto& p : placed) all.insert(all.end(), p.begin(), p.end());
  return all;
}

void mesh_all(Scene& scene, const Options& options) {
  parallel_for(scene.buildings.size(), [&](std::size_t i) {
    scene.buildings[i].layers.clear();
    mesh_building(scene.buildings[i], options);
  });
}

void analyze_alone(Scene& scene, const Options& options) {
  for (Building& b : scene.buildings) {
    Scene one;
    one.buildings.push_back(std::move(b));
    analyze_scene(one, options);
    b = std::move(one.buildings.front());
  }
}

/// Beyond the joint layer 0, or with it, by a measure of size: as many on each layer as now.
template <class Measure>
void layer_by_size(Scene& scene, int layers, const Measure& measure) {
  std::vector<int> count(layers, 0);
  std::vector<std::pair<double, int*>> order;
  for (Building& b : scene.buildings)
    for (std::size_t s = 0; s < b.descriptors.size(); ++s) {
      ++count[b.layer_of_segment[s]];
      order.push_back({-measure(b.descriptors[s]), &b.layer_of_segment[s]});
    }
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::size_t next = 0;
  for (int k = 0; k < layers; ++k)
    for (int i = 0; i < count[k]; ++i) *order[next++].second = k;
}

/// Edge collapse by quadrics (meshoptimizer) to about that many faces.
Mesh collapsed(const Mesh& mesh, std::size_t faces) {
  const Vec3 centre = bounding_box(mesh.vertices).center();
  std::vector<float> points;
  std::vector<unsigned> indices, left(3 * mesh.faces.size());
  for (const Vec3& v : mesh.vertices)
    for (int k = 0; k < 3; ++k) points.push_back(static_cast<float>(v[k] - centre[k]));
  for (const Face& f : mesh.faces)
    for (int k = 0; k < 3; ++k) indices.push_back(static_cast<unsigned>(f[k]));
  left.resize(meshopt_simplify(left.data(), indices.data(), indices.size(), points.data(),
                               mesh.vertices.size(), 3 * sizeof(float),
                               3 * std::max<std::size_t>(faces, 4), 1.0f, 0, nullptr));
  Mesh result{mesh.vertices, {}};
  for (std::size_t i = 0; i + 2 < left.size(); i += 3)
    result.faces.push_back(
        {static_cast<int>(left[i]), static_cast<int>(left[i + 1]), static_cast<int>(left[i + 2])});
  return result;
}

std::vector<PlacedPart> place_collapsed(const Scene& joint, const Truth& truth, Faces& faces) {
  std::vector<std::vector<PlacedPart>> placed(joint.buildings.size());
  std::vector<Faces> of(joint.buildings.size());
  parallel_for(joint.buildings.size(), [&](std::size_t i) {
    const Building& b = joint.buildings[i];
    const TruthBuilding* t = truth_of(truth, b.source.name);
    if (!t || b.has_failed()) return;
    std::vector<Mesh> layers;
    for (const Layer& layer : b.layers) {
      layers.push_back(collapsed(b.source.mesh, layer.mesh.triangles.size()));
      of[i].asked.push_back(layer.mesh.triangles.size());
      of[i].got.push_back(layers.back().faces.size());
    }
    placed[i] = place_parts(b.source, *t, layers);
  });
  for (const Faces& own : of)
    for (std::size_t k = 0; k < own.asked.size(); ++k) {
      faces.asked.resize(std::max(faces.asked.size(), k + 1), 0);
      faces.got.resize(faces.asked.size(), 0);
      faces.asked[k] += own.asked[k], faces.got[k] += own.got[k];
    }
  std::vector<PlacedPart> all;
  for (const auto& p : placed) all.insert(all.end(), p.begin(), p.end());
  return all;
}

void write_segments(const Scene& scene, const Truth& truth, const std::string& path) {
  json all = json::array();
  for (const Building& b : scene.buildings) {
    const TruthBuilding* t = truth_of(truth, b.source.name);
    std::map<int, std::string> type;
    if (t) {
      const std::vector<int> segment = segments_of_parts(b, *t);
      for (std::size_t i = 0; i < segment.size(); ++i)
        if (segment[i] >= 0) type[segment[i]] = name_of(t->parts[i].kind);
    }
    std::vector<double> share(b.descriptors.size(), 0);
    for (const Coverage& c : b.segments.coverage)
      for (const int s : c.segments) share[s] += c.share;
    for (std::size_t s = 0; s < b.descriptors.size(); ++s) {
      const Descriptor& d = b.descriptors[s];
      Box box;
      for (const int p : b.segments.segments[s].planes)
        for (const Vec3& v : b.planes.planes[p].outline.vertices) box.extend(v);
      all.push_back(
          {{"building", b.source.name},
           {"segment", s},
           {"type", type.count(s) ? type[s] : ""},
           {"kind", name_of(d.kind)},
           {"layer", b.layer_of_segment[s]},
           {"share", share[s]},
           {"area", d.area},
           {"volume", d.volume},
           {"extent", d.extent},
           {"flat", d.is_flat},
           {"alcove", b.segments.segments[s].is_alcove},
           {"planes", b.segments.segments[s].planes.size()},
           {"eigenvalues", {d.eigenvalues[0], d.eigenvalues[1], d.eigenvalues[2]}},
           {"context", {d.context[0], d.context[1], d.context[2]}},
           {"box", {box.min[0], box.min[1], box.min[2], box.max[0], box.max[1], box.max[2]}},
           {"d2", d.d2}});
    }
  }
  std::ofstream(path) << all.dump();
}

template <class Count>
std::string row(const std::vector<Count>& counts) {
  std::string text;
  for (const Count n : counts) text += (text.empty() ? "" : "/") + std::to_string(n);
  return text;
}

void print(const std::vector<Result>& results) {
  std::printf(
      "| type | relief | method | seen | never | appear on 0/1/2 | on the majority layer | "
      "buildings "
      "that agree | by segment |\n|---|---|---|---|---|---|---|---|---|\n");
  std::map<std::string, bool> types;
  for (const Result& r : results)
    for (const auto* list : {&r.by_mesh, &r.by_segment})
      for (const TypeConsistency& t : *list) types[name_of(t.kind)] = true;
  const auto find = [](const std::vector<TypeConsistency>& list, const std::string& type) {
    for (const TypeConsistency& t : list)
      if (name_of(t.kind) == type) return t;
    return TypeConsistency{};
  };
  for (const auto& [type, unused] : types)
    for (const Result& r : results) {
      const TypeConsistency m = find(r.by_mesh, type), s = find(r.by_segment, type);
      std::printf("| %s | %.2f | %s | %d | %d | %s | %.0f %% | %.0f %% of %d | %s: %.0f %% |\n",
                  type.c_str(), m.depth, r.method.c_str(), m.seen, m.never, row(m.first).c_str(),
                  100 * m.on_majority_layer, 100 * m.buildings_agreeing, m.buildings,
                  row(s.first).c_str(), 100 * s.on_majority_layer);
    }
}

Result run_method(const std::string& method, Scene& scene, const Truth& truth,
                  const Settings& settings) {
  const int layers = settings.options.layers;
  Result result{method, {}, {}};
  if (method == "alone") analyze_alone(scene, settings.options);
  if (method == "extent")
    layer_by_size(scene, layers, [](const Descriptor& d) { return d.extent; });
  if (method == "volume")
    layer_by_size(scene, layers, [](const Descriptor& d) { return d.volume; });
  result.by_segment = tally_parts(place_by_segments(scene, truth, layers), layers);
  if (settings.has_no_meshes) return result;
  mesh_all(scene, settings.options);
  result.by_mesh = tally_parts(place_by_meshes(scene, truth), layers);
  return result;
}

int run(const Settings& settings) {
  const Truth truth = read_truth(settings.truth);
  ReadResult input = read_sources({settings.folder});
  Scene scene;
  scene.buildings.resize(input.sources.size());
  parallel_for(scene.buildings.size(), [&](std::size_t i) {
    scene.buildings[i] = segment_building({std::move(input.sources[i]), i, {}}, settings.options);
  });
  analyze_scene(scene, settings.options);
  if (!settings.segments.empty()) write_segments(scene, truth, settings.segments);
  std::vector<std::vector<int>> joint;
  for (const Building& b : scene.buildings) joint.push_back(b.layer_of_segment);
  std::vector<Result> results;
  Faces faces;
  for (const std::string& method : settings.only) {
    for (std::size_t i = 0; i < joint.size(); ++i) scene.buildings[i].layer_of_segment = joint[i];
    if (method != "quadric") {
      results.push_back(run_method(method, scene, truth, settings));
    } else if (!settings.has_no_meshes) {
      mesh_all(scene, settings.options);
      results.push_back(
          {method, tally_parts(place_collapsed(scene, truth, faces), settings.options.layers), {}});
    }
  }
  if (!settings.is_json) {
    print(results);
    if (!faces.asked.empty())
      std::printf("\nQuadric collapse: %s faces asked for on 0/1/2, %s left.\n",
                  row(faces.asked).c_str(), row(faces.got).c_str());
    return 0;
  }
  json out;
  for (const Result& r : results)
    out[r.method] = {{"mesh", json::parse(consistency_json(r.by_mesh))},
                     {"segment", json::parse(consistency_json(r.by_segment))}};
  if (!faces.asked.empty())
    out["quadric"].update({{"faces_asked", faces.asked}, {"faces_left", faces.got}});
  std::printf("%s\n", out.dump(1).c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Settings s;
  s.options.ns = 64;
  s.only = {"joint", "alone", "extent", "volume", "quadric"};
  CLI::App app("consistency of layers, ours beside the baselines");
  app.add_option("folder", s.folder)->required();
  app.add_option("--truth", s.truth)->required()->check(CLI::ExistingFile);
  app.add_option("--ns", s.options.ns);
  app.add_option("--nr", s.options.nr);
  app.add_option_function<std::string>(
      "--visibility", [&s](const std::string& v) { s.options.visibility = visibility_of(v); });
  app.add_option("--layers", s.options.layers);
  app.add_option("--eta", s.options.eta);
  app.add_option("--only", s.only, "methods")
      ->check(CLI::IsMember({"joint", "alone", "extent", "volume", "quadric"}));
  app.add_option("--segments", s.segments, "JSON file to write");
  app.add_flag("--no-meshes", s.has_no_meshes, "by segment only");
  app.add_flag("--json", s.is_json);
  app.add_option("--threads", s.threads);
  CLI11_PARSE(app, argc, argv);
  limit_threads(s.threads);
  try {
    validate(s.options);
    return run(s);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "bench_consistency: %s\n", e.what());
    return 1;
  }
}
