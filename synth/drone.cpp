// *Based on:* what cut-outs of drone photogrammetry show: walls and roofs that bulge over metres,
// melted edges, ground around the foot, trees and neighbours grown in, sides that are not there.
//
// *Differs:* no --rules here. A simulation, to be named as such beside every figure.
//
// *Notation:* none.
#include "drone.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/parallel.h"
#include "core/rays.h"
#include "core/union_find.h"

namespace colod::synth {
namespace {

constexpr double kFine = 0.2;  // m of edges below which the mesh follows the model's own details

/// The plane of the body's underside.
Ground ground_below(const SynthBuilding& building) {
  const Mesh& mesh = building.source.mesh;
  Vec3 normal = Vec3::Zero(), middle = Vec3::Zero();
  double area = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Face& face = mesh.faces[f];
    const Vec3 cross = face_cross(mesh, face);
    if (building.source.face_object[f] != kBody || cross.z() > -0.5 * cross.norm()) continue;
    normal -= cross, area += cross.norm();
    middle += cross.norm() / 3 *
              (mesh.vertices[face[0]] + mesh.vertices[face[1]] + mesh.vertices[face[2]]);
  }
  Ground ground;
  if (area <= 0) return ground;
  middle /= area;
  ground.slope = Vec2(-normal.x(), -normal.y()) / normal.z();
  ground.height = middle.z() - ground.slope.dot(middle.head<2>());
  return ground;
}

/// Faces of other buildings that lie about this one.
void add_neighbours(const std::vector<NumberedModel>& models, int own, Box box, double around,
                    Mesh& soup) {
  box.min -= Vec3::Constant(around), box.max += Vec3::Constant(around);
  for (const auto& [number, model] : models) {
    if (number == own) continue;
    for (const Face& f : model.faces) {
      Box face;
      for (int v : f) face.extend(model.vertices[v]);
      if ((face.min.array() > box.max.array()).any() || (face.max.array() < box.min.array()).any())
        continue;
      const int base = static_cast<int>(soup.vertices.size());
      for (int v : f) soup.vertices.push_back(model.vertices[v]);
      soup.faces.push_back({base, base + 1, base + 2});
    }
  }
}

Vec3 centroid(const Mesh& mesh, const Face& f) {
  return (mesh.vertices[f[0]] + mesh.vertices[f[1]] + mesh.vertices[f[2]]) / 3;
}

/// Nobody sees the ground from below.
void drop_underside(Mesh& mesh, const Ground& ground) {
  std::erase_if(mesh.faces, [&](const Face& f) {
    const Vec3 cross = face_cross(mesh, f), at = centroid(mesh, f);
    return cross.z() < -0.3 * cross.norm() && at.z() < ground.at(at.head<2>()) + 0.05;
  });
}

/// Fine meshes show what a wrap has smoothed over.
void follow_model(Mesh& mesh, const RayScene& model, double within) {
  parallel_for(
      mesh.vertices.size(),
      [&](std::size_t v) {
        const NearestPoint near = model.nearest(mesh.vertices[v], within);
        if (near.triangle >= 0 && near.distance <= within) mesh.vertices[v] = near.point;
      },
      1024);
}

/// The model seen from above, for distances on the ground.
Mesh flattened(const Mesh& mesh) {
  Mesh flat;
  flat.vertices = mesh.vertices;
  for (Vec3& v : flat.vertices) v.z() = 0;
  for (const Face& f : mesh.faces)
    if (face_cross(flat, f).norm() > 1e-4) flat.faces.push_back(f);
  return flat;
}

void cut_skirt(Mesh& mesh, const Mesh& model, double skirt) {
  const RayScene footprint(flattened(model));
  std::vector<char> is_out(mesh.faces.size());
  parallel_for(
      mesh.faces.size(),
      [&](std::size_t f) {
        Vec3 at = centroid(mesh, mesh.faces[f]);
        at.z() = 0;
        const NearestPoint near = footprint.nearest(at, skirt + 1);
        is_out[f] = near.triangle < 0 || near.distance > skirt;
      },
      256);
  std::vector<Face> kept;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    if (!is_out[f]) kept.push_back(mesh.faces[f]);
  mesh.faces = std::move(kept);
}

void cut_missing_sides(Mesh& mesh, const Ground& ground, const Box& box, const Flight& flight) {
  std::erase_if(mesh.faces, [&](const Face& f) {
    const Vec3 normal = face_cross(mesh, f).normalized(), at = centroid(mesh, f);
    const double foot = ground.at(at.head<2>());
    if (at.z() < foot + 0.3 || at.z() > foot + flight.missing_depth * (box.max.z() - foot))
      return false;
    return std::any_of(flight.missing.begin(), flight.missing.end(),
                       [&](const Vec2& side) { return normal.head<2>().dot(side) > 0.75; });
  });
}

/// The largest piece and those of its size stay; vertices without faces go.
void tidy(Mesh& mesh) {
  constexpr std::size_t kLeastShare = 50;  // of the faces, a piece that stays
  UnionFind sets(mesh.vertices.size());
  for (const Face& f : mesh.faces) sets.unite(f[0], f[1]), sets.unite(f[1], f[2]);
  std::map<int, std::size_t> size;
  for (const Face& f : mesh.faces) ++size[sets.find(f[0])];
  const std::size_t all = mesh.faces.size();
  std::erase_if(mesh.faces,
                [&](const Face& f) { return size[sets.find(f[0])] * kLeastShare < all; });
  std::vector<int> index(mesh.vertices.size(), -1);
  std::vector<Vec3> vertices;
  for (Face& f : mesh.faces)
    for (int& v : f) {
      if (index[v] < 0) {
        index[v] = static_cast<int>(vertices.size());
        vertices.push_back(
            mesh.vertices[v].unaryExpr([](double x) { return std::round(x * 1e6) / 1e6; }));
      }
      v = index[v];
    }
  mesh.vertices = std::move(vertices);
}

/// What the nearest part of the model is; −1 for ground and trees.
std::vector<int> name_faces(const Mesh& mesh, const SynthBuilding& building, const RayScene& model,
                            const Ground& ground) {
  constexpr double kFar = 0.9, kOverGround = 0.4;  // m
  std::vector<int> objects(mesh.faces.size(), -1);
  parallel_for(
      objects.size(),
      [&](std::size_t f) {
        const Vec3 at = centroid(mesh, mesh.faces[f]), cross = face_cross(mesh, mesh.faces[f]);
        const bool is_ground =
            cross.z() > 0.7 * cross.norm() && at.z() < ground.at(at.head<2>()) + kOverGround;
        const NearestPoint near = model.nearest(at, kFar);
        if (!is_ground && near.triangle >= 0 && near.distance < kFar)
          objects[f] = building.source.face_object[near.triangle];
      },
      256);
  return objects;
}

/// A closed surface of fine triangles, without the ground's underside.
Mesh make_surface(const Mesh& soup, const RayScene& model, const Ground& ground,
                  const Flight& flight) {
  const double alpha = std::clamp(0.9 * flight.edge, 0.35, 1.2);
  Mesh mesh = wrap_soup(soup, alpha, alpha / 15);
  drop_underside(mesh, ground);
  refine(mesh, flight.edge * (flight.edge < kFine ? 1.2 : 0.6));
  if (flight.edge < kFine) follow_model(mesh, model, alpha);
  smooth(mesh, flight.melt, median_edge(mesh));
  return mesh;
}

/// One program makes all buildings of a street: of every four seeds two give height fields, an odd
/// and an even one.
bool gives_height_field(std::uint64_t seed) { return seed / 2 % 2 == 1; }

void fly_over_building(SynthBuilding& building, int own, const std::vector<NumberedModel>& around,
                       const SynthOptions& options) {
  const std::uint64_t seed = (options.seed * 0x9E3779B97F4A7C15ull + own) ^ 0xd1b54a32d192ed03ull;
  Random random(seed);
  const Flight flight = draw_flight(random, options.scan_edge, gives_height_field(options.seed));
  const Ground ground = ground_below(building);
  const Mesh model = building.source.mesh;
  const Box box = bounding_box(model.vertices);
  const RayScene scene(model);
  Mesh soup = make_soup(model, building.source.face_object, ground, flight, random);
  add_neighbours(around, own, box, flight.skirt, soup);
  Mesh mesh = flight.is_height_field ? make_field(soup, flight, random)
                                     : make_surface(soup, scene, ground, flight);
  bulge(mesh, flight, seed);
  cut_skirt(mesh, model, flight.skirt);
  if (!flight.is_height_field) mesh = thin_to_edge(mesh, flight.edge);
  cut_missing_sides(mesh, ground, box, flight);
  tidy(mesh);
  building.source.face_object = name_faces(mesh, building, scene, ground);
  building.source.mesh = std::move(mesh);
}

}  // namespace

Flight draw_flight(Random& random, double edge, bool is_height_field) {
  const double share = is_height_field ? 0.25 : 0.13;  // of the edge, as real cut-outs bulge
  Flight flight;
  flight.edge = edge;
  flight.is_height_field = is_height_field;
  flight.melt = std::max(0.05, edge * random.uniform(0.6, 1.4));
  flight.bulge = random.uniform(0.25, 1.2) * std::clamp(share * edge, 0.01, 0.3);
  flight.jitter = 0.02 * std::min(1.0, edge);
  flight.skirt = random.uniform(1, kMostSkirt);
  for (double& lean : flight.lean)
    lean = is_height_field ? random.uniform(0, 0.05) : random.uniform(0.05, 0.4);
  for (int i = random.chance(0.35) ? 1 + random.pick(2) : 0; i > 0; --i) {
    const double angle = random.uniform(0, 2 * M_PI);
    flight.missing.emplace_back(std::cos(angle), std::sin(angle));
  }
  flight.missing_depth = random.uniform(0.3, 0.9);
  flight.trees = random.chance(0.5) ? 1 + random.pick(3) : 0;
  return flight;
}

void fly_over(std::vector<SynthBuilding>& buildings, int number,
              const std::vector<NumberedModel>& around, const SynthOptions& options) {
  parallel_for(buildings.size(), [&](std::size_t i) {
    fly_over_building(buildings[i], number + static_cast<int>(i), around, options);
  });
}

}  // namespace colod::synth
