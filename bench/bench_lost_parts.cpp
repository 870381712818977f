// Pictures of the parts that are lost, or on another layer than most of their kind, close up: the
// source beside each layer from the same camera; and what became of their faces, as a table.
//
//   bench_lost_parts FOLDER... -o SHEET.png [--truth TRUTH.json] [--types NAME...] [--ns N]
//   [--layers N] [--visibility ENGINE] [--width N] [--threads N]
//
// Each FOLDER is a scene of its own and holds meshes whose faces carry object numbers; its truth is
// its own truth.json, as synth writes it, unless --truth names one. A row a part: its faces are
// orange in the source, and a blue frame is its box in all pictures of the row. Types are those
// with a median relief of at least 0.3 m unless --types names them. The table goes to the standard
// output as Markdown.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>

#include "core/error.h"
#include "core/parallel.h"
#include "core/rays.h"
#include "picture/picture.h"
#include "pipeline/pipeline.h"
#include "read/read.h"

using namespace colod;

namespace {

constexpr double kLeastRelief = 0.3;  // metres
constexpr Color kGrey{205, 205, 200}, kOrange{240, 150, 50}, kBlue{40, 90, 220};
constexpr std::size_t kMostTried = 500;  // faces of a part that the camera is chosen by

struct Settings {
  std::vector<std::string> folders, types;
  std::string truth, out;
  Options options;
  int width = 300, threads = 0;
};

/// A part that is not where most of its kind are.
struct Lost {
  PlacedPart part;
  int most = -1;  ///< layer on which most of its kind appear
};

struct Sheet {
  std::vector<Image> images;
  std::vector<std::string> captions;
};

std::string text(const char* format, auto... values) {
  char buffer[256];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

Scene build(const Settings& s, const std::string& folder) {
  ReadResult input = read_sources({folder});
  Scene scene;
  scene.buildings.resize(input.sources.size());
  parallel_for(scene.buildings.size(), [&](std::size_t i) {
    scene.buildings[i] = segment_building({std::move(input.sources[i]), i, {}}, s.options);
  });
  analyze_scene(scene, s.options);
  parallel_for(scene.buildings.size(),
               [&](std::size_t i) { mesh_building(scene.buildings[i], s.options); });
  return scene;
}

std::vector<Lost> lost_parts(const Scene& scene, const Truth& truth, const Settings& s) {
  std::vector<PlacedPart> placed;
  for (const Building& b : scene.buildings)
    for (PlacedPart& p : place_parts(b, b.source, truth)) placed.push_back(std::move(p));
  std::vector<Lost> lost;
  for (const TypeConsistency& t : tally_parts(placed, s.options.layers)) {
    const bool is_asked = s.types.empty() ? t.depth >= kLeastRelief
                                          : std::find(s.types.begin(), s.types.end(),
                                                      name_of(t.kind)) != s.types.end();
    if (!is_asked) continue;
    for (const PlacedPart& p : placed)
      if (p.kind == t.kind && p.is_seen && p.first != t.majority_layer)
        lost.push_back({p, t.majority_layer});
  }
  return lost;
}

std::vector<int> faces_of(const Source& source, int instance) {
  std::vector<int> faces;
  for (std::size_t f = 0; f < source.mesh.faces.size(); ++f)
    if (source.face_object[f] == instance) faces.push_back(static_cast<int>(f));
  return faces;
}

Vec3 to_camera(double azimuth_deg, double elevation_deg) {
  const double az = azimuth_deg * std::numbers::pi / 180,
               el = elevation_deg * std::numbers::pi / 180;
  return {std::cos(el) * std::sin(az), -std::cos(el) * std::cos(az), std::sin(el)};
}

/// From where most of the part's faces are seen.
void look_at(const Mesh& mesh, const RayScene& rays, const std::vector<int>& faces,
             PreviewOptions& view) {
  const std::size_t step = faces.size() / kMostTried + 1;
  double best = -1;
  for (const double elevation : {12.0, 35.0, -20.0})
    for (int azimuth = 0; azimuth < 360; azimuth += 15) {
      const Vec3 d = to_camera(azimuth, elevation);
      double seen = 0;
      for (std::size_t i = 0; i < faces.size(); i += step) {
        const Face& f = mesh.faces[faces[i]];
        const double facing = 0.5 * face_cross(mesh, f).dot(d);
        const Vec3 middle = (mesh.vertices[f[0]] + mesh.vertices[f[1]] + mesh.vertices[f[2]]) / 3;
        if (facing > 0 && !rays.is_occluded(middle, d, 0.02, 1e4)) seen += facing;
      }
      if (seen <= best) continue;
      best = seen, view.azimuth_deg = azimuth, view.elevation_deg = elevation;
    }
}

struct Scenery {
  Mesh mesh;
  std::vector<Color> colors;
};

/// The twelve edges of a box as bars.
void add_frame(const Box& box, double thickness, Scenery& scenery) {
  for (int axis = 0; axis < 3; ++axis)
    for (int corner = 0; corner < 4; ++corner) {
      Box bar;
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      Vec3 low = box.min, high = box.max;
      low[u] = high[u] = corner & 1 ? box.max[u] : box.min[u];
      low[v] = high[v] = corner & 2 ? box.max[v] : box.min[v];
      bar.extend(low - Vec3::Constant(thickness));
      bar.extend(high + Vec3::Constant(thickness));
      const int first = static_cast<int>(scenery.mesh.vertices.size());
      for (int k = 0; k < 8; ++k)
        scenery.mesh.vertices.emplace_back(k & 1 ? bar.max.x() : bar.min.x(),
                                           k & 2 ? bar.max.y() : bar.min.y(),
                                           k & 4 ? bar.max.z() : bar.min.z());
      for (const auto& [a, b, c, d] :
           {std::array{0, 2, 3, 1}, std::array{4, 5, 7, 6}, std::array{0, 1, 5, 4},
            std::array{2, 6, 7, 3}, std::array{0, 4, 6, 2}, std::array{1, 3, 7, 5}}) {
        scenery.mesh.faces.push_back({first + a, first + b, first + c});
        scenery.mesh.faces.push_back({first + a, first + c, first + d});
      }
    }
  scenery.colors.resize(scenery.mesh.faces.size(), kBlue);
}

void add_pictures(const Building& b, const Lost& lost, int width, Sheet& sheet) {
  const Mesh& source = b.source.mesh;
  const std::vector<int> faces = faces_of(b.source, lost.part.instance);
  Box box;
  for (const int f : faces)
    for (const int v : source.faces[f]) box.extend(source.vertices[v]);
  PreviewOptions view{.width = width, .height = 3 * width / 4, .box = box};
  view.box.min -= Vec3::Constant(0.5 + 0.15 * box.diagonal());
  view.box.max += Vec3::Constant(0.5 + 0.15 * box.diagonal());
  look_at(source, RayScene(source), faces, view);
  const double bar = 0.004 * view.box.diagonal();

  Scenery shown{source, std::vector<Color>(source.faces.size(), kGrey)};
  for (const int f : faces) shown.colors[f] = kOrange;
  add_frame(box, bar, shown);
  const PlacedPart& p = lost.part;
  sheet.images.push_back(render_preview(shown.mesh, view, {}, shown.colors));
  sheet.captions.push_back(p.building + " " + name_of(p.kind) + " " + std::to_string(p.instance) +
                           (p.first < 0 ? ": on none" : ": on " + std::to_string(p.first)) +
                           ", most on " + std::to_string(lost.most));
  const Frame turn{Vec3::Zero(), b.frame.yaw};  // layers are parallel to the world's axes
  for (std::size_t k = 0; k < b.layers.size(); ++k) {
    Scenery layer{b.layers[k].mesh.mesh(), {}};
    for (Vec3& v : layer.mesh.vertices) v = turn.to_local(v);
    layer.colors.assign(layer.mesh.faces.size(), kGrey);
    add_frame(box, bar, layer);
    sheet.images.push_back(render_preview(layer.mesh, view, {}, layer.colors));
    sheet.captions.push_back(text("layer %zu: %.0f %% of it, %s", k, 100 * p.near[k],
                                  p.present[k] ? "present" : "absent"));
  }
}

/// What became of a part's faces, in m².
struct Fate {
  double area = 0;        ///< seen
  double no_plane = 0;    ///< in none
  double foreign = 0;     ///< in planes of which it has less than half
  int segment = -1;       ///< that most of its own planes are in
  double in_segment = 0;  ///< of the part
  double others = 0;      ///< of other things in that segment
};

Fate fate_of(const Building& b, int instance) {
  Fate fate;
  std::vector<double> on_plane(b.planes.planes.size(), 0);
  for (const int f : faces_of(b.source, instance)) {
    const double a = face_area(b.source.mesh, b.source.mesh.faces[f]);
    const int plane = b.planes.plane_of_item[f];
    fate.area += a;
    (plane < 0 ? fate.no_plane : on_plane[plane]) += a;
  }
  std::map<int, double> own, all;
  for (std::size_t p = 0; p < on_plane.size(); ++p) {
    const double whole = b.planes.planes[p].area;
    const int s = b.segments.segment_of_plane[p];
    all[s] += whole;
    if (2 * on_plane[p] < whole)
      fate.foreign += on_plane[p];
    else
      own[s] += on_plane[p];
  }
  for (const auto& [s, a] : own)
    if (s >= 0 && a > fate.in_segment) fate.segment = s, fate.in_segment = a;
  if (fate.segment >= 0) fate.others = std::max(0.0, all[fate.segment] - fate.in_segment);
  return fate;
}

/// The stage after which it is not what its kind is.
std::string stage_of(const Fate& fate, const Lost& lost, int layer) {
  if (fate.in_segment < 0.5 * fate.area) return "planes";
  if (fate.others > fate.in_segment) return "segments";
  return layer != lost.most ? "layers" : "extraction";
}

void print_row(const Building& b, const Lost& lost) {
  const Fate fate = fate_of(b, lost.part.instance);
  const int layer = fate.segment < 0 ? -1 : b.layer_of_segment[fate.segment];
  std::string near;
  for (const double share : lost.part.near)
    near += text("%s%.0f", near.empty() ? "" : " / ", 100 * share);
  std::printf("| %s %s %d | %s | %d | %s | %.1f | %.1f | %.1f | %s | %s |\n",
              lost.part.building.c_str(), name_of(lost.part.kind).c_str(), lost.part.instance,
              lost.part.first < 0 ? "none" : std::to_string(lost.part.first).c_str(), lost.most,
              near.c_str(), fate.area, fate.no_plane, fate.foreign,
              fate.segment < 0 ? "none"
                               : text("%.1f of it, %.1f of others, layer %d", fate.in_segment,
                                      fate.others, layer)
                                     .c_str(),
              stage_of(fate, lost, layer).c_str());
}

void add_scene(const Settings& s, const std::string& folder, Sheet& sheet) {
  const Truth truth = read_truth(
      s.truth.empty() ? (std::filesystem::path(folder) / "truth.json").string() : s.truth);
  const Scene scene = build(s, folder);
  for (const Lost& lost : lost_parts(scene, truth, s))
    for (const Building& b : scene.buildings)
      if (b.source.name == lost.part.building) {
        print_row(b, lost);
        add_pictures(b, lost, s.width, sheet);
      }
}

int run(const Settings& s) {
  std::printf(
      "| part | on layer | most on | %% near layers | m² seen | in no plane | in planes of others "
      "| "
      "segment, m² | lost in |\n|---|---|---|---|---|---|---|---|---|\n");
  Sheet sheet;
  for (const std::string& folder : s.folders) add_scene(s, folder, sheet);
  std::ofstream out(s.out, std::ios::binary);
  out << encode_png(contact_sheet(sheet.images, sheet.captions, s.options.layers + 1));
  if (!out.flush()) throw Error(Stage::kOutput, s.out, "cannot be written");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Settings s;
  s.options.ns = 64;
  CLI::App app("pictures of the parts that are lost or on another layer than most of their kind");
  app.add_option("folder", s.folders)->required()->check(CLI::ExistingDirectory);
  app.add_option("-o,--out", s.out, "PNG to write")->required();
  app.add_option("--truth", s.truth)->check(CLI::ExistingFile);
  app.add_option("--types", s.types);
  app.add_option("--ns", s.options.ns);
  app.add_option("--layers", s.options.layers);
  app.add_option_function<std::string>(
      "--visibility", [&s](const std::string& v) { s.options.visibility = visibility_of(v); });
  app.add_option("--width", s.width, "of a picture")->check(CLI::Range(64, 4096));
  app.add_option("--threads", s.threads);
  CLI11_PARSE(app, argc, argv);
  limit_threads(s.threads);
  try {
    validate(s.options);
    return run(s);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "bench_lost_parts: %s\n", e.what());
    return 1;
  }
}
