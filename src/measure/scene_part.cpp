// Based on: own work.
// Differs: --rules robust only; the paper is given buildings.
// Notation: tops, sides: faces of a mesh that look up, by less than 60° from the vertical, and
// those that are upright.
#include "scene_part.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>
#include <utility>

#include "core/parallel.h"
#include "core/rays.h"
#include "face_samples.h"
#include "grains.h"
#include "parameters.h"

namespace colod {
namespace {

using namespace parameters::scene_part;

constexpr double kLevel = 0.5;            // upright component of a top's normal at least
constexpr double kSamplesOfLayer = 3000;  // of a layer
constexpr double kRadian_deg = 57.29577951308232;

/// Length of the edges that faces use more often one way than the other.
double border_length(const Mesh& mesh) {
  std::vector<std::array<int, 3>> uses;  // of an edge: its ends, rising, and which way it is used
  uses.reserve(3 * mesh.faces.size());
  for (const Face& f : mesh.faces)
    for (int k = 0; k < 3; ++k) {
      const int a = f[k], b = f[(k + 1) % 3];
      uses.push_back({std::min(a, b), std::max(a, b), a < b ? 1 : -1});
    }
  std::sort(uses.begin(), uses.end());
  double length = 0;
  for (std::size_t i = 0, end = 0; i < uses.size(); i = end) {
    int balance = 0;
    for (; end < uses.size() && uses[end][0] == uses[i][0] && uses[end][1] == uses[i][1]; ++end)
      balance += uses[end][2];
    const double one = (mesh.vertices[uses[i][0]] - mesh.vertices[uses[i][1]]).norm();
    if (balance != 0 && std::isfinite(one)) length += one;
  }
  return length;
}

void survey_source(const Mesh& source, SceneFacts& facts) {
  double area = 0, upright = 0;
  for (const Face& f : source.faces) {
    const Vec3 cross = face_cross(source, f);
    const double twice = cross.norm();
    if (!std::isfinite(twice)) continue;
    area += twice / 2;
    if (std::abs(cross.z()) < kLevel * twice) upright += twice / 2;
  }
  facts.upright = area > 0 ? upright / area : 0;
  facts.is_open = border_length(source) > kOpenBorder * std::sqrt(area);
}

/// Samples of a layer, and how many of them are farther from the source than `reach`: of tops, of
/// sides, and of what looks down.
struct Invention {
  std::array<double, 3> area{}, far{};

  double share(int kind) const { return area[kind] > 0 ? far[kind] / area[kind] : 0; }
  double share() const {
    const double all = area[0] + area[1] + area[2];
    return all > 0 ? (far[0] + far[1] + far[2]) / all : 0;
  }
};

Invention measure_invention(const RayScene& source, double reach, const Mesh& layer) {
  const double spacing = std::sqrt(surface_area(layer) / kSamplesOfLayer);
  const std::vector<SurfaceSample> samples = spread_over(layer, spacing);
  std::vector<char> is_far(samples.size());
  parallel_ranges(samples.size(), kGrainOfRays, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const NearestPoint near = source.nearest(samples[i].point, reach);
      is_far[i] = near.triangle < 0 || near.distance > reach;
    }
  });
  Invention all;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Vec3 cross = face_cross(layer, layer.faces[samples[i].face]);
    const double z = cross.z() / std::max(1e-300, cross.norm());
    const int kind = z >= kLevel ? 0 : z > -kLevel ? 1 : 2;
    all.area[kind] += 1;
    all.far[kind] += is_far[i];
  }
  return all;
}

bool is_invented(double tops, double sides) { return tops > kFalseTops && sides > kFalseSides; }

double reach_of(const Surface& source) {
  return std::max(kReach, kReachShare * bounding_box(source.mesh.vertices).diagonal());
}

/// How the tops meet.
void survey_tops(const PolygonMesh& layer, SceneFacts& facts) {
  const auto is_top = [&](int facet) { return layer.facets[facet].normal.z() >= kLevel; };
  std::map<std::pair<int, int>, std::size_t> triangle_of;  // by directed edge
  std::set<int> tops;
  for (std::size_t t = 0; t < layer.triangles.size(); ++t) {
    if (is_top(layer.facet_of_triangle[t])) tops.insert(layer.facet_of_triangle[t]);
    for (int k = 0; k < 3; ++k)
      triangle_of[{layer.triangles[t][k], layer.triangles[t][(k + 1) % 3]}] = t;
  }
  double length = 0, gentle = 0, concave = 0;
  for (const auto& [edge, t] : triangle_of) {
    const auto other = triangle_of.find({edge.second, edge.first});
    if (edge.first > edge.second || other == triangle_of.end()) continue;
    const int f = layer.facet_of_triangle[t], g = layer.facet_of_triangle[other->second];
    if (f == g || !is_top(f) || !is_top(g)) continue;
    const Vec3 &n = layer.facets[f].normal, &m = layer.facets[g].normal;
    const double angle_deg = kRadian_deg * std::acos(std::clamp(n.dot(m), -1.0, 1.0));
    if (angle_deg < kCoplanar_deg) continue;
    const Vec3 along = layer.vertices[edge.second] - layer.vertices[edge.first];
    length += along.norm();
    if (angle_deg < kGentle_deg) gentle += along.norm();
    if (n.cross(m).dot(along) < 0) concave += along.norm();  // the edge runs with its left face n
  }
  facts.tops = static_cast<int>(tops.size());
  facts.gentle = length > 0 ? gentle / length : 0;
  facts.concave = length > 0 ? concave / length : 0;
}

}  // namespace

SceneFacts survey_layer(const Surface& source, const PolygonMesh& finest, double solid) {
  SceneFacts facts;
  const Mesh layer = finest.mesh();
  const double volume = signed_volume(layer), area = surface_area(layer);
  facts.enclosed = volume > 0 ? solid / volume : 0;
  facts.extent = std::sqrt(area);
  facts.thickness = area > 0 ? 2 * volume / area : 0;
  survey_source(source.mesh, facts);
  if (!facts.is_open) return facts;
  facts.reach = reach_of(source);
  const Invention invention = measure_invention(source.rays, facts.reach, layer);
  facts.invented = invention.share();
  facts.invented_tops = invention.share(0);
  facts.invented_sides = invention.share(1);
  survey_tops(finest, facts);
  return facts;
}

std::vector<InventedShare> invented_shares(const Surface& source, const std::vector<Mesh>& layers) {
  std::vector<InventedShare> shares;
  for (const Mesh& layer : layers) {
    const Invention invention = measure_invention(source.rays, reach_of(source), layer);
    shares.push_back({invention.share(), is_invented(invention.share(0), invention.share(1))});
  }
  return shares;
}

std::string judge_scene(const SceneFacts& f) {
  if (!f.is_open) return "";
  char text[240];
  if (f.upright < kNotUpright && f.tops >= kManyTops && f.gentle > kMostlyGentle &&
      f.concave > kManyValleys) {
    std::snprintf(
        text, sizeof text,
        "terrain: nothing of it is upright, and its %d pieces meet gently, %.0f %% of the "
        "edges in valleys",
        f.tops, 100 * f.concave);
    return text;
  }
  const bool is_bare_wall = f.upright > kAllUpright && f.enclosed < kHardlyEnclosed;
  if (is_bare_wall && f.thickness < kThin && f.thickness < kThinShare * f.extent) {
    std::snprintf(text, sizeof text,
                  "a wall: %.0f %% of it is upright, it encloses nothing, and its layer is %.2f m "
                  "thick",
                  100 * f.upright, f.thickness);
    return text;
  }
  if (is_invented(f.invented_tops, f.invented_sides)) {
    std::snprintf(text, sizeof text,
                  "%.0f %% of the roofs and %.0f %% of the walls that would close it are invented, "
                  "more than %.1f m from any of its surface",
                  100 * f.invented_tops, 100 * f.invented_sides, f.reach);
    return text;
  }
  return "";
}

}  // namespace colod
