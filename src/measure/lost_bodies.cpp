// Based on: own work.
// Differs: the same under both rules.
// Notation: a body is a set of voxels connected over sides.
#include "lost_bodies.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.h"
#include "core/rays.h"
#include "face_samples.h"
#include "grains.h"
#include "solid.h"

namespace colod {
namespace {

constexpr double kLeastShare = 0.005;  // of the whole volume: what is smaller is detail
constexpr double kRoom = 2;            // metres: the depth of a room, a body is as deep …
constexpr double kDeep = 0.25;         // … or this share of the side of a cube of its volume
constexpr double kFar = 0.5;           // of that depth: surface that lies so far off is far
constexpr double kMostly = 0.5;        // of the surface about a body that is far
constexpr double kNearVoxels = 1;      // voxels
constexpr double kReach = 0.5, kReachShare = 0.02;  // metres, of the diagonal: no farther is near
constexpr double kLeastMissed = 0.1;  // of the area: less is noise of outlines and clutter

/// Distance to the layer where it is more than `least`, 0 elsewhere.
double distance_beyond(const RayScene& layer, const Vec3& p, double least) {
  const NearestPoint near = layer.nearest(p, least);
  if (near.triangle >= 0 && near.distance <= least) return 0;
  return layer.nearest(p).distance;
}

struct Body {
  std::vector<std::size_t> voxels;
  double depth = 0;  ///< largest distance to the layer of its voxels
  double area = 0, far_area = 0, farthest = 0;

  double required_depth(double volume, double grain) const {
    return std::max(grain, std::min(kRoom, kDeep * std::cbrt(volume)));
  }
};

/// Sets of voxels that are flagged, connected over sides; `body_of` gets their numbers.
std::vector<Body> connect(const VoxelGrid& g, const std::vector<double>& distance,
                          std::vector<int>& body_of) {
  std::vector<Body> bodies;
  body_of.assign(g.count(), -1);
  for (std::size_t seed = 0; seed < g.count(); ++seed) {
    if (distance[seed] <= 0 || body_of[seed] >= 0) continue;
    const int number = static_cast<int>(bodies.size());
    Body& body = bodies.emplace_back();
    body_of[seed] = number;
    body.voxels = {seed};
    for (std::size_t i = 0; i < body.voxels.size(); ++i) {
      const std::size_t c = body.voxels[i];
      body.depth = std::max(body.depth, distance[c]);
      const int x = static_cast<int>(c % g.nx), y = static_cast<int>(c / g.nx % g.ny),
                z = static_cast<int>(c / g.nx / g.ny);
      for (const auto& [dx, dy, dz] :
           {std::array{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}) {
        if (!g.holds(x + dx, y + dy, z + dz)) continue;
        const std::size_t d = g.number(x + dx, y + dy, z + dz);
        if (distance[d] > 0 && body_of[d] < 0) body_of[d] = number, body.voxels.push_back(d);
      }
    }
  }
  return bodies;
}

struct Beside {
  int body = -1;  ///< −1: none
  bool is_open = false;
};

/// What is about a point of the source's surface: a body, and open space, from where it is seen.
Beside beside(const VoxelGrid& g, const std::vector<char>& is_solid,
              const std::vector<int>& body_of, const Vec3& p) {
  Beside found;
  const Vec3 at = (p - g.origin) / g.size;
  if (!at.allFinite()) return found;
  const int x = static_cast<int>(std::floor(at.x())), y = static_cast<int>(std::floor(at.y())),
            z = static_cast<int>(std::floor(at.z()));
  for (int dz = -1; dz <= 1; ++dz)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        if (!g.holds(x + dx, y + dy, z + dz)) {
          found.is_open = true;
          continue;
        }
        const std::size_t c = g.number(x + dx, y + dy, z + dz);
        found.is_open |= !is_solid[c];
        found.body = std::max(found.body, body_of[c]);
      }
  return found;
}

Box used_box(const Mesh& m) {
  Box box;
  for (const Face& f : m.faces)
    for (const int v : f)
      if (m.vertices[v].allFinite()) box.extend(m.vertices[v]);
  return box;
}

/// Per voxel the distance to the layer of what is solid, outside of it and no longer near it.
std::vector<double> find_missing(const VoxelGrid& grid, const std::vector<char>& is_solid,
                                 const std::vector<char>& is_inside, const RayScene& layer) {
  std::vector<double> distance(grid.count(), 0);
  parallel_ranges(distance.size(), kGrainOfQueries, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (is_solid[i] && !is_inside[i])
        distance[i] = distance_beyond(layer, grid.center(i), kNearVoxels * grid.size);
  });
  return distance;
}

/// A place on the source's surface.
struct Place {
  Beside beside;
  double distance = 0;     ///< to the layer, where it is asked for
  bool is_inside = false;  ///< of the layer, and far from it: a floor that a hole shows
};

/// A place for each sample. How far a body's surface is from the layer is asked always; elsewhere
/// only whether it is farther than `reach`.
std::vector<Place> look_about(const std::vector<SurfaceSample>& samples, const VoxelGrid& grid,
                              const std::vector<char>& is_solid, const std::vector<int>& body_of,
                              const RayScene& layer, double reach) {
  std::vector<Place> places(samples.size());
  parallel_ranges(samples.size(), kGrainOfQueries, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3& p = samples[i].point;
      Place& place = places[i];
      place.beside = beside(grid, is_solid, body_of, p);
      if (!place.beside.is_open) continue;
      place.distance =
          place.beside.body >= 0 ? layer.nearest(p).distance : distance_beyond(layer, p, reach);
      place.is_inside =
          place.distance > reach && layer.first_hit(p, Vec3(0.36, 0.48, 0.8)).is_inside;
    }
  });
  return places;
}

/// What of the surface is about each body.
void measure_bodies(const std::vector<Place>& places, const VoxelGrid& grid, double unit,
                    double grain, std::vector<Body>& bodies) {
  for (const auto& [about, distance, is_inside] : places) {
    if (about.body < 0 || !about.is_open) continue;
    Body& body = bodies[about.body];
    const double volume = static_cast<double>(body.voxels.size()) * grid.volume();
    body.area += unit;
    body.farthest = std::max(body.farthest, distance);
    if (distance > kFar * body.required_depth(volume, grain)) body.far_area += unit;
  }
}

/// What of the surface that is seen from outside is outside of the layer and far from it, lost
/// bodies apart: of open pieces there is no volume to miss.
LeftOut find_missed(const std::vector<Place>& places, double unit, double reach,
                    const std::vector<char>& is_lost) {
  LeftOut out;
  out.reason = LeftOut::Reason::kLost;
  for (const auto& [about, distance, is_inside] : places) {
    if (!about.is_open || distance <= reach || is_inside) continue;
    if (about.body >= 0 && is_lost[about.body]) continue;
    out.area += unit;
    out.farthest = std::max(out.farthest, distance);
  }
  out.share = out.area / (unit * std::max<double>(1, static_cast<double>(places.size())));
  return out;
}

}  // namespace

Holdings weigh_layer(const Surface& source, const Mesh& layer, double grain) {
  const Box box = used_box(source.mesh);
  const VoxelGrid grid = make_grid(box);
  const RayScene layer_scene(layer);
  const std::vector<char> is_solid = find_solid(grid, source.rays);
  const std::vector<char> is_inside = find_inside(grid, layer_scene);
  std::size_t solid = 0, kept = 0;
  for (std::size_t i = 0; i < grid.count(); ++i)
    solid += is_solid[i], kept += is_solid[i] && is_inside[i];
  Holdings out{.solid = static_cast<double>(solid) * grid.volume(),
               .kept = static_cast<double>(kept) * grid.volume(),
               .whole = 0,
               .lost = {}};
  out.whole = std::max(0.0, signed_volume(layer)) + out.solid - out.kept;
  std::vector<int> body_of;
  std::vector<Body> bodies =
      connect(grid, find_missing(grid, is_solid, is_inside, layer_scene), body_of);
  const double reach = std::max(kReach, kReachShare * box.diagonal());
  const std::vector<Place> places =
      look_about(spread_over(source.mesh, grid.size), grid, is_solid, body_of, layer_scene, reach);
  const double unit = grid.size * grid.size, area = unit * static_cast<double>(places.size());
  measure_bodies(places, grid, unit, grain, bodies);
  std::vector<char> is_lost(bodies.size(), 0);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Body& body = bodies[i];
    const double volume = static_cast<double>(body.voxels.size()) * grid.volume();
    if (volume < kLeastShare * out.whole || body.depth < body.required_depth(volume, grain) ||
        body.far_area <= kMostly * body.area)
      continue;
    is_lost[i] = 1;
    out.lost.push_back({.reason = LeftOut::Reason::kLost,
                        .area = body.area,
                        .share = body.area / area,
                        .farthest = body.farthest,
                        .volume = volume,
                        .volume_share = volume / out.whole});
  }
  std::stable_sort(out.lost.begin(), out.lost.end(),
                   [](const LeftOut& a, const LeftOut& b) { return a.volume > b.volume; });
  LeftOut missed = find_missed(places, unit, reach, is_lost);
  if (missed.share > kLeastMissed) out.lost.push_back(missed);
  return out;
}

}  // namespace colod
