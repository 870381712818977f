// *Based on:* a mesh's own Laplacian; noise as a sum of plane waves of a band; quadric collapse
// (Garland and Heckbert 1997, by meshoptimizer), as photogrammetry programs thin their meshes.
//
// *Differs:* no --rules here.
//
// *Notation:* none.
#include <algorithm>
#include <cmath>
#include <map>

#include "core/meshopt.h"
#include "core/parallel.h"
#include "drone.h"

namespace colod::synth {
namespace {

double edge_length(const Mesh& mesh, int a, int b) {
  return (mesh.vertices[a] - mesh.vertices[b]).norm();
}

/// Both directions of every edge, sorted by where they begin.
std::vector<std::pair<int, int>> directed_edges(const Mesh& mesh) {
  std::vector<std::pair<int, int>> edges;
  edges.reserve(6 * mesh.faces.size());
  for (const Face& f : mesh.faces)
    for (int k = 0; k < 3; ++k) {
      edges.push_back({f[k], f[(k + 1) % 3]});
      edges.push_back({f[(k + 1) % 3], f[k]});
    }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

std::vector<Vec3> vertex_normals(const Mesh& mesh) {
  std::vector<Vec3> normals(mesh.vertices.size(), Vec3::Zero());
  for (const Face& f : mesh.faces)
    for (int v : f) normals[v] += face_cross(mesh, f);
  for (Vec3& n : normals) n = n.norm() > 0 ? Vec3(n.normalized()) : Vec3(Vec3::UnitZ());
  return normals;
}

/// A face with some of its sides halved, as the two, three or four that it becomes. `middle[k]`:
/// of the side from corner k on; −1: whole.
void split_face(const Face& f, const std::array<int, 3>& middle, std::vector<Face>& faces) {
  const auto halved = std::count_if(middle.begin(), middle.end(), [](int m) { return m >= 0; });
  if (halved == 0) return faces.push_back(f);
  if (halved == 3) {
    for (int k = 0; k < 3; ++k) faces.push_back({f[k], middle[k], middle[(k + 2) % 3]});
    return faces.push_back({middle[0], middle[1], middle[2]});
  }
  int k = 0;  // the first halved side after a whole one
  while (middle[k] < 0 || middle[(k + 2) % 3] >= 0) k = (k + 1) % 3;
  const int a = f[k], b = f[(k + 1) % 3], c = f[(k + 2) % 3], m = middle[k];
  const int n = middle[(k + 1) % 3];
  faces.push_back({a, m, c});
  if (halved == 1) return faces.push_back({m, b, c});
  faces.push_back({m, b, n});
  faces.push_back({m, n, c});
}

struct Wave {
  Vec3 direction;  ///< times 2π over the wave's length
  double phase;
};

/// No shorter than what the mesh's edges can show.
std::vector<Wave> draw_waves(Random& random, double edge) {
  constexpr int kWaves = 24;
  constexpr double kLongest = 5;  // m
  const double shortest = std::clamp(1.5 * edge, 1.0, 2.5);
  std::vector<Wave> waves;
  for (int i = 0; i < kWaves; ++i) {
    const double length = shortest * std::pow(kLongest / shortest, random.uniform(0, 1));
    const double z = random.uniform(-1, 1), angle = random.uniform(0, 2 * M_PI);
    const double r = std::sqrt(1 - z * z);
    waves.push_back({2 * M_PI / length * Vec3(r * std::cos(angle), r * std::sin(angle), z),
                     random.uniform(0, 2 * M_PI)});
  }
  return waves;
}

}  // namespace

double median_edge(const Mesh& mesh) {
  std::vector<double> lengths;
  for (const Face& f : mesh.faces)
    for (int k = 0; k < 3; ++k)
      if (f[k] < f[(k + 1) % 3]) lengths.push_back(edge_length(mesh, f[k], f[(k + 1) % 3]));
  if (lengths.empty()) return 0;
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle;
}

void refine(Mesh& mesh, double longest) {
  constexpr int kMostRounds = 12;
  for (int round = 0; round < kMostRounds; ++round) {
    std::vector<std::pair<int, int>> edges = directed_edges(mesh);
    std::erase_if(edges, [&](const auto& e) {
      return e.first > e.second || edge_length(mesh, e.first, e.second) <= longest;
    });
    if (edges.empty()) return;
    const int base = static_cast<int>(mesh.vertices.size());
    for (const auto& [a, b] : edges)
      mesh.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]) / 2);
    std::vector<Face> faces;
    faces.reserve(4 * mesh.faces.size());
    for (const Face& f : mesh.faces) {
      std::array<int, 3> middle;
      for (int k = 0; k < 3; ++k) {
        const auto edge = std::minmax(f[k], f[(k + 1) % 3]);
        const auto found = std::lower_bound(edges.begin(), edges.end(),
                                            std::pair<int, int>(edge.first, edge.second));
        const bool is_halved =
            found != edges.end() && found->first == edge.first && found->second == edge.second;
        middle[k] = is_halved ? base + static_cast<int>(found - edges.begin()) : -1;
      }
      split_face(f, middle, faces);
    }
    mesh.faces = std::move(faces);
  }
}

void smooth(Mesh& mesh, double radius, double edge) {
  constexpr int kMostRounds = 60;
  constexpr double kStep = 0.5;
  const double steps = radius / edge;
  const int rounds = std::clamp(static_cast<int>(std::lround(steps * steps)), 1, kMostRounds);
  const auto edges = directed_edges(mesh);
  std::vector<std::size_t> begin(mesh.vertices.size() + 1, 0);
  for (const auto& [a, b] : edges) ++begin[a + 1];
  for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
  for (int round = 0; round < rounds; ++round) {
    std::vector<Vec3> moved(mesh.vertices.size());
    parallel_for(
        moved.size(),
        [&](std::size_t v) {
          Vec3 sum = Vec3::Zero();
          for (std::size_t e = begin[v]; e < begin[v + 1]; ++e)
            sum += mesh.vertices[edges[e].second];
          const double n = static_cast<double>(begin[v + 1] - begin[v]);
          moved[v] =
              n > 0 ? Vec3((1 - kStep) * mesh.vertices[v] + kStep / n * sum) : mesh.vertices[v];
        },
        4096);
    mesh.vertices = std::move(moved);
  }
}

void bulge(Mesh& mesh, const Flight& flight, std::uint64_t seed) {
  Random random(seed ^ 0x9e3779b9ull);
  const std::vector<Wave> waves = draw_waves(random, flight.edge);
  const std::vector<Vec3> normals = flight.is_height_field
                                        ? std::vector<Vec3>(mesh.vertices.size(), Vec3::UnitZ())
                                        : vertex_normals(mesh);
  const double scale = flight.bulge * std::sqrt(2.0 / static_cast<double>(waves.size()));
  std::vector<double> chance(mesh.vertices.size());
  for (double& c : chance)  // the sum of three even draws is bell-shaped enough
    c = random.uniform(-1, 1) + random.uniform(-1, 1) + random.uniform(-1, 1);
  parallel_for(
      mesh.vertices.size(),
      [&](std::size_t v) {
        double sum = 0;
        for (const Wave& w : waves) sum += std::sin(w.direction.dot(mesh.vertices[v]) + w.phase);
        mesh.vertices[v] += (scale * sum + flight.jitter * chance[v]) * normals[v];
      },
      1024);
}

Mesh thin_to_edge(const Mesh& mesh, double edge) {
  constexpr int kMostRounds = 4;
  constexpr double kNearEnough = 0.05;  // of the length asked for
  const IndexedMesh m(mesh);
  double faces = surface_area(mesh) / (0.5 * edge * edge);
  Mesh thin = mesh;
  for (int round = 0; round < kMostRounds; ++round) {
    const auto wanted = static_cast<std::size_t>(std::max(20.0, faces));
    thin.vertices = mesh.vertices;
    thin.faces = faces_of(simplify_indices(m.positions, m.indices, 3 * wanted));
    const double ratio = median_edge(thin) / edge;
    if (std::abs(ratio - 1) < kNearEnough || faces * ratio * ratio > mesh.faces.size()) break;
    faces *= ratio * ratio;
  }
  return thin;
}

}  // namespace colod::synth
