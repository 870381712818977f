// Other methods on the same machine, for bench/quality.
//
//   bench_peers run PEER SOURCE OUT.off [--faces N]
//     PEER: meshopt   meshoptimizer's quadric collapse, to N faces (meshes only)
//           quadrics  CGAL's Garland & Heckbert collapse, to N faces (meshes only)
//           wrap      CGAL's alpha wrap (meshes and points)
//           collapse  as quadrics, of a SOURCE that has no ground to part with, such as a wrap
//           polyfit   CGAL's Polygonal_surface_reconstruction (Nan & Wonka 2017) with GLPK, on the
//                     20 largest of colod's own planes (meshes and points)
//           moved     no method but a control: the source, each vertex moved by up to 0.0001 of the
//                     diagonal: what the measures make of no difference (meshes only)
//     Exit code 1: no answer, the reason on stderr.
//   bench_peers measure SOURCE MODEL... : JSON with what `colod eval --lfd` says of each; null: no
//   mesh
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/GLPK_mixed_integer_program_traits.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/triangulate_faces.h>
#include <CGAL/Polygonal_surface_reconstruction.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_policies.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <CGAL/alpha_wrap_3.h>
#include <CGAL/property_map.h>
#include <meshoptimizer.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <random>

#include "core/error.h"
#include "core/spread.h"
#include "measure/light_field.h"
#include "measure/looks.h"
#include "measure/metrics.h"
#include "planes/planes.h"
#include "read/frame.h"
#include "read/read.h"
#include "scene/ground.h"

using namespace colod;

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using SurfaceMesh = CGAL::Surface_mesh<Point>;
namespace PMP = CGAL::Polygon_mesh_processing;
namespace SMS = CGAL::Surface_mesh_simplification;

constexpr double kWrapShare = 1.0 / 50;  // alpha over the diagonal
constexpr double kOffsetShare = 1.0 / 1500;
constexpr std::size_t kMostPlanes = 20;  // PolyFit
constexpr std::size_t kPolyfitPoints = 20000;

Error no_answer(const std::string& why) { return Error(Stage::kProcess, "peer", why); }

/// What all methods are given and measured against: the building without its ground, about which
/// colod does not argue with them.
Source read_building(const std::string& path) {
  const Source source = read_single(path);
  const Frame frame = main_frame(source);
  const Source local = localize(source, frame);
  Source building = separate_ground(local);
  if (building.mesh.faces.size() == local.mesh.faces.size()) return source;
  for (Vec3& v : building.mesh.vertices) v = frame.to_world(v);
  return building;
}

/// The source about its own centre: floats and predicates keep their digits.
Vec3 center(Source& source) {
  std::vector<Vec3>& points = source.is_mesh() ? source.mesh.vertices : source.cloud.points;
  const Vec3 origin = bounding_box(points).center();
  for (Vec3& p : points) p -= origin;
  return origin;
}

double diagonal_of(const Source& s) {
  return bounding_box(s.is_mesh() ? s.mesh.vertices : s.cloud.points).diagonal();
}

/// Vertices at equal coordinates made one; faces that become a line left out.
Mesh welded(const Mesh& mesh) {
  const auto less = [](const Vec3& a, const Vec3& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  };
  std::map<Vec3, int, decltype(less)> index(less);
  Mesh out;
  std::vector<int> at;
  for (const Vec3& v : mesh.vertices) {
    const auto [found, is_new] = index.emplace(v, static_cast<int>(out.vertices.size()));
    if (is_new) out.vertices.push_back(v);
    at.push_back(found->second);
  }
  for (const Face& f : mesh.faces) {
    const Face g = {at[f[0]], at[f[1]], at[f[2]]};
    if (g[0] != g[1] && g[1] != g[2] && g[2] != g[0]) out.faces.push_back(g);
  }
  return out;
}

Mesh run_meshopt(const Source& source, std::size_t faces) {
  if (!source.is_mesh()) throw no_answer("needs a mesh");
  const Mesh in = welded(source.mesh);
  std::vector<float> positions;
  for (const Vec3& v : in.vertices)
    for (int k = 0; k < 3; ++k) positions.push_back(static_cast<float>(v[k]));
  std::vector<unsigned> indices, result(3 * in.faces.size());
  for (const Face& f : in.faces)
    for (const int v : f) indices.push_back(static_cast<unsigned>(v));
  constexpr float kAnyError = 1e10f;
  result.resize(meshopt_simplify(result.data(), indices.data(), indices.size(), positions.data(),
                                 in.vertices.size(), 3 * sizeof(float), 3 * faces, kAnyError, 0,
                                 nullptr));
  Mesh out{in.vertices, {}};
  for (std::size_t i = 0; i < result.size(); i += 3)
    out.faces.push_back({static_cast<int>(result[i]), static_cast<int>(result[i + 1]),
                         static_cast<int>(result[i + 2])});
  return out;
}

SurfaceMesh to_surface_mesh(const Mesh& mesh) {
  std::vector<Point> points;
  for (const Vec3& v : mesh.vertices) points.emplace_back(v.x(), v.y(), v.z());
  std::vector<std::vector<std::size_t>> faces;
  for (const Face& f : mesh.faces)
    if (!CGAL::collinear(points[f[0]], points[f[1]], points[f[2]]))
      faces.push_back({static_cast<std::size_t>(f[0]), static_cast<std::size_t>(f[1]),
                       static_cast<std::size_t>(f[2])});
  PMP::orient_polygon_soup(points, faces);  // cuts at non-manifold places
  SurfaceMesh result;
  PMP::polygon_soup_to_polygon_mesh(points, faces, result);
  return result;
}

Mesh from_surface_mesh(const SurfaceMesh& mesh) {
  Mesh out;
  std::map<SurfaceMesh::Vertex_index, int> number;
  for (const auto v : mesh.vertices()) {
    number[v] = static_cast<int>(out.vertices.size());
    const Point& p = mesh.point(v);
    out.vertices.emplace_back(p.x(), p.y(), p.z());
  }
  for (const auto f : mesh.faces()) {
    std::vector<int> loop;
    for (const auto v : vertices_around_face(mesh.halfedge(f), mesh)) loop.push_back(number.at(v));
    if (loop.size() == 3) out.faces.push_back({loop[0], loop[1], loop[2]});
  }
  return out;
}

void collapse(SurfaceMesh& mesh, std::size_t faces) {
  using Policies = SMS::GarlandHeckbert_policies<SurfaceMesh, Kernel>;
  const Policies policies(mesh);
  const SMS::Bounded_normal_change_placement<Policies::Get_placement> placement(
      policies.get_placement());
  // A closed triangle mesh has three edges for two faces.
  SMS::edge_collapse(mesh, SMS::Count_stop_predicate<SurfaceMesh>(3 * faces / 2),
                     CGAL::parameters::get_cost(policies.get_cost()).get_placement(placement));
  mesh.collect_garbage();
}

Mesh run_quadrics(const Source& source, std::size_t faces) {
  if (!source.is_mesh()) throw no_answer("needs a mesh");
  SurfaceMesh mesh = to_surface_mesh(welded(source.mesh));
  collapse(mesh, faces);
  return from_surface_mesh(mesh);
}

Mesh run_wrap(const Source& source) {
  std::vector<Point> points;
  for (const Vec3& p : source.is_mesh() ? source.mesh.vertices : source.cloud.points)
    points.emplace_back(p.x(), p.y(), p.z());
  const double diagonal = diagonal_of(source);
  SurfaceMesh wrap;
  if (source.is_mesh())
    CGAL::alpha_wrap_3(points, source.mesh.faces, kWrapShare * diagonal, kOffsetShare * diagonal,
                       wrap);
  else
    CGAL::alpha_wrap_3(points, kWrapShare * diagonal, kOffsetShare * diagonal, wrap);
  return from_surface_mesh(wrap);
}

/// Evenly over the outlines of the largest planes.
std::vector<std::tuple<Point, Kernel::Vector_3, int>> sample_planes(const Planes& planes) {
  const std::size_t count = std::min(kMostPlanes, planes.planes.size());
  double total = 0;
  const auto area = [](const Outline& o, const Face& f) {
    return 0.5 *
           (o.vertices[f[1]] - o.vertices[f[0]]).cross(o.vertices[f[2]] - o.vertices[f[0]]).norm();
  };
  for (std::size_t p = 0; p < count; ++p)
    for (const Face& f : planes.planes[p].outline.triangles)
      total += area(planes.planes[p].outline, f);
  std::vector<std::tuple<Point, Kernel::Vector_3, int>> samples;
  double until = 0;
  for (std::size_t p = 0; p < count; ++p) {
    const Plane& plane = planes.planes[p];
    const Kernel::Vector_3 normal(plane.normal.x(), plane.normal.y(), plane.normal.z());
    for (const Face& f : plane.outline.triangles) {
      until += area(plane.outline, f) / total * kPolyfitPoints;
      const Vec3 &a = plane.outline.vertices[f[0]], &b = plane.outline.vertices[f[1]],
                 &c = plane.outline.vertices[f[2]];
      while (static_cast<double>(samples.size()) + 0.5 < until) {
        const Vec3 x = spread_on_triangle(a, b, c, static_cast<double>(samples.size()));
        samples.emplace_back(Point(x.x(), x.y(), x.z()), normal, static_cast<int>(p));
      }
    }
  }
  return samples;
}

Mesh run_polyfit(const Source& source) {
  const Frame frame = main_frame(source);
  const Planes planes = detect_planes(localize(source, frame));
  const auto samples = sample_planes(planes);
  using Sample = std::tuple<Point, Kernel::Vector_3, int>;
  CGAL::Polygonal_surface_reconstruction<Kernel> method(
      samples, CGAL::Nth_of_tuple_property_map<0, Sample>(),
      CGAL::Nth_of_tuple_property_map<1, Sample>(), CGAL::Nth_of_tuple_property_map<2, Sample>());
  SurfaceMesh model;
  if (!method.reconstruct<CGAL::GLPK_mixed_integer_program_traits<double>>(model))
    throw no_answer(method.error_message());
  PMP::triangulate_faces(model);
  Mesh out = from_surface_mesh(model);
  for (Vec3& v : out.vertices) v = frame.to_world(v);
  return out;
}

Mesh move_vertices(const Source& source) {
  if (!source.is_mesh()) throw no_answer("needs a mesh");
  constexpr double kMost = 1e-4;  // of the diagonal: where bench/quality's means begin to count
  Mesh mesh = welded(source.mesh);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> along(-1, 1);
  const double most = kMost * diagonal_of(source);
  for (Vec3& v : mesh.vertices) {
    Vec3 by;
    do by = Vec3(along(random), along(random), along(random));
    while (by.squaredNorm() > 1);
    v += most * by;
  }
  return mesh;
}

void write_off(const std::string& path, const Mesh& mesh, const Vec3& origin) {
  std::FILE* file = std::fopen(path.c_str(), "w");
  if (!file) throw Error(Stage::kOutput, path, "cannot be written");
  std::fprintf(file, "OFF\n%zu %zu 0\n", mesh.vertices.size(), mesh.faces.size());
  for (const Vec3& v : mesh.vertices)
    std::fprintf(file, "%.17g %.17g %.17g\n", v.x() + origin.x(), v.y() + origin.y(),
                 v.z() + origin.z());
  for (const Face& f : mesh.faces) std::fprintf(file, "3 %d %d %d\n", f[0], f[1], f[2]);
  if (std::fclose(file) != 0) throw Error(Stage::kOutput, path, "cannot be written");
}

/// Without the vertices that no face uses.
Mesh compact(const Mesh& mesh) {
  Mesh out;
  std::vector<int> number(mesh.vertices.size(), -1);
  for (Face f : mesh.faces) {
    for (int& v : f) {
      if (number[v] < 0) {
        number[v] = static_cast<int>(out.vertices.size());
        out.vertices.push_back(mesh.vertices[v]);
      }
      v = number[v];
    }
    out.faces.push_back(f);
  }
  return out;
}

void run(const std::string& peer, const std::string& path, const std::string& out,
         std::size_t faces) {
  Source source = peer == "collapse" ? read_single(path) : read_building(path);
  const Vec3 origin = center(source);
  const Mesh result = peer == "meshopt"   ? run_meshopt(source, faces)
                      : peer == "wrap"    ? run_wrap(source)
                      : peer == "polyfit" ? run_polyfit(source)
                      : peer == "moved"   ? move_vertices(source)
                                          : run_quadrics(source, faces);
  if (result.faces.empty()) throw no_answer("no face");
  write_off(out, compact(result), origin);
}

/// The source from around, by both descriptions.
struct Silhouettes {
  LightFields fields;
  ProgramLightFields program;
};

nlohmann::ordered_json measure(const DistanceGauge& gauge, const LookGauge& looks,
                               const Silhouettes* own, const std::string& path) {
  const Mesh model = read_single(path).mesh;
  const Validity v = check_validity(model);
  const Distances d = gauge.measure_to(model);
  nlohmann::ordered_json json{
      {"vertices", v.vertices},
      {"faces", v.faces},
      {"polygons", v.polygons},
      {"watertight", v.is_watertight},
      {"manifold", v.is_manifold},
      {"self_intersections", v.self_intersections},
      {"least_width", v.least_width},
      {"components", v.components},
      {"enclosed_components", v.enclosed_components},
      {"volume", v.volume},
      {"hausdorff_relative", d.relative},
      {"mean_distance", d.mean_a_to_b},
      {"mean_distance_back", d.mean_b_to_a},
      {"looks", nlohmann::ordered_json::parse(looks_json(looks.look_at(model)))}};
  if (own) {
    json["light_field_distance"] = light_field_distance(own->fields, describe_light_fields(model));
    json["light_field_distance_program"] =
        light_field_distance(own->program, describe_as_program(model));
  }
  return json;
}

void measure_all(const std::string& path, const std::vector<std::string>& models) {
  const Source source = read_building(path);
  const DistanceGauge gauge(source);
  const LookGauge looks(source);
  std::optional<Silhouettes> own;
  if (source.is_mesh())
    own = Silhouettes{describe_light_fields(source.mesh), describe_as_program(source.mesh)};
  nlohmann::ordered_json json = {{"diagonal", diagonal_of(source)},
                                 {"models", nlohmann::json::array()}};
  for (const std::string& model : models) {
    try {
      json["models"].push_back(measure(gauge, looks, own ? &*own : nullptr, model));
    } catch (const Error&) {  // such as two faces without area, which a peer calls an answer
      json["models"].push_back(nullptr);
    }
  }
  std::printf("%s\n", json.dump().c_str());
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Runs other methods, and measures results, for bench/quality");
  app.require_subcommand(1);
  std::string peer, source, out;
  std::vector<std::string> models;
  std::size_t faces = 100;
  CLI::App* run_app = app.add_subcommand("run", "one peer on one building");
  run_app->add_option("PEER", peer)
      ->required()
      ->check(CLI::IsMember({"meshopt", "quadrics", "wrap", "collapse", "polyfit", "moved"}));
  run_app->add_option("SOURCE", source)->required();
  run_app->add_option("OUT", out)->required();
  run_app->add_option("--faces", faces, "wanted")->check(CLI::Range(4, 100000000));
  CLI::App* measure_app = app.add_subcommand("measure", "models against their source");
  measure_app->add_option("SOURCE", source)->required();
  measure_app->add_option("MODEL", models)->required();
  CLI11_PARSE(app, argc, argv);
  try {
    if (run_app->parsed())
      run(peer, source, out, faces);
    else
      measure_all(source, models);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "bench_peers: %s\n", e.what());
    return 1;
  }
  return 0;
}
