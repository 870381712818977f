// *Based on:* what cameras above see: walls only aslant, trees as lumps.
//
// *Differs:* no --rules here.
//
// *Notation:* none.
#include <algorithm>
#include <cmath>

#include "drone.h"

namespace colod::synth {
namespace {

constexpr double kSteep = 0.3;  // upright or nearly: |z| of a unit normal

Vec3 normal_of_face(const Mesh& mesh, const Face& f) { return face_cross(mesh, f).normalized(); }

void add_quad(Mesh& mesh, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const int base = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {a, b, c, d});
  mesh.faces.push_back({base, base + 1, base + 2});
  mesh.faces.push_back({base, base + 2, base + 3});
}

/// By which rise over run walls of this direction lean, between the eighths of the circle.
double lean_towards(const Flight& flight, const Vec3& normal) {
  const double eighth = std::atan2(normal.y(), normal.x()) / (M_PI / 4) + 8;
  const int i = static_cast<int>(std::floor(eighth));
  const double t = eighth - i;
  return (1 - t) * flight.lean[i % 8] + t * flight.lean[(i + 1) % 8];
}

/// How high the walls of one direction reach.
struct DroneSide {
  Vec3 normal;
  double top;
};

DroneSide& side_of(std::vector<DroneSide>& sides, const Vec3& normal) {
  constexpr double kAlike = 0.95;  // cosine
  for (DroneSide& side : sides)
    if (side.normal.dot(normal) > kAlike) return side;
  return sides.emplace_back(DroneSide{normal, -std::numeric_limits<double>::infinity()});
}

/// Walls' vertices move outwards the more, the lower they are; corners with both their walls.
std::vector<Vec3> leaned(const Mesh& building, const std::vector<int>& face_object,
                         const Flight& flight) {
  std::vector<DroneSide> sides;
  std::vector<std::vector<Vec3>> walls(building.vertices.size());
  for (std::size_t f = 0; f < building.faces.size(); ++f) {
    const Vec3 normal = normal_of_face(building, building.faces[f]);
    if (face_object[f] != kBody || std::abs(normal.z()) > kSteep) continue;
    DroneSide& side = side_of(sides, normal);
    for (int v : building.faces[f]) {
      side.top = std::max(side.top, building.vertices[v].z());
      if (std::none_of(walls[v].begin(), walls[v].end(),
                       [&](const Vec3& other) { return other.dot(normal) > 0.8; }))
        walls[v].push_back(normal);
    }
  }
  std::vector<Vec3> moved = building.vertices;
  for (std::size_t v = 0; v < moved.size(); ++v)
    for (const Vec3& normal : walls[v])
      moved[v] += lean_towards(flight, normal) *
                  (side_of(sides, normal).top - building.vertices[v].z()) *
                  Vec3(normal.x(), normal.y(), 0);
  return moved;
}

/// A lumpy crown that reaches down to the ground, so near that it grows into the walls.
void add_tree(const Mesh& building, const Ground& ground, Random& random, Mesh& soup) {
  constexpr int kRings = 6, kSides = 9;
  const Vec3 foot = building.vertices[random.pick(static_cast<int>(building.vertices.size()))];
  const Vec3 middle = bounding_box(building.vertices).center();
  const Vec2 away = (foot - middle).head<2>().normalized();
  const double radius = random.uniform(0.8, 2.6), height = random.uniform(2, 7);
  const Vec2 center = foot.head<2>() + random.uniform(0.1, 0.9) * radius * away;
  const double floor = ground.at(center);
  const int base = static_cast<int>(soup.vertices.size());
  for (int i = 0; i <= kRings; ++i)
    for (int k = 0; k < kSides; ++k) {
      const double share = static_cast<double>(i) / kRings, angle = 2 * M_PI * k / kSides;
      const double r = radius * random.uniform(0.7, 1.15) *
                       std::sin(M_PI * std::min(0.999, 0.25 + 0.75 * share));
      soup.vertices.emplace_back(center.x() + r * std::cos(angle), center.y() + r * std::sin(angle),
                                 floor + share * height);
    }
  for (int i = 0; i < kRings; ++i)
    for (int k = 0; k < kSides; ++k) {
      const int a = base + i * kSides + k, b = base + i * kSides + (k + 1) % kSides;
      soup.faces.push_back({a, b, b + kSides});
      soup.faces.push_back({a, b + kSides, a + kSides});
    }
}

/// A plate so wide that nothing of its border is left when the skirt is cut.
void add_ground(const Box& box, const Ground& ground, double around, Mesh& soup) {
  const Vec2 low = box.min.head<2>() - Vec2(around, around);
  const Vec2 high = box.max.head<2>() + Vec2(around, around);
  add_quad(soup, ground.on(low), ground.on({high.x(), low.y()}), ground.on(high),
           ground.on({low.x(), high.y()}));
}

}  // namespace

Mesh make_soup(const Mesh& building, const std::vector<int>& face_object, const Ground& ground,
               const Flight& flight, Random& random) {
  Mesh soup = building;
  soup.vertices = leaned(building, face_object, flight);
  const int base = static_cast<int>(soup.vertices.size());
  soup.vertices.insert(soup.vertices.end(), building.vertices.begin(), building.vertices.end());
  for (const Face& f : building.faces)
    soup.faces.push_back({f[0] + base, f[1] + base, f[2] + base});
  for (int i = 0; i < flight.trees; ++i) add_tree(building, ground, random, soup);
  add_ground(bounding_box(soup.vertices), ground, flight.skirt + 2 * flight.edge, soup);
  return soup;
}

}  // namespace colod::synth
