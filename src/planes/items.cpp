// Based on: the input side of region growing (Rabbani et al. 2006; paper section 3.1); floaters as
// measured on simulated photogrammetry in November 2026.
// Differs: floaters are dropped under --rules robust only; the paper has
// no such step.
// Notation: k nearest neighbours of a point; everything else by name.
#include "items.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Orthogonal_k_neighbor_search.h>
#include <CGAL/Search_traits_3.h>
#include <CGAL/Search_traits_adapter.h>
#include <CGAL/property_map.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/flat.h"
#include "core/parallel.h"
#include "core/rays.h"
#include "parameters.h"

namespace colod::regions {
namespace {

using namespace parameters::planes;

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
constexpr int kNearest = 14;  // neighbours of a point

struct EdgeUse {
  int low, high, face;
  bool is_forward;
  friend bool operator<(const EdgeUse& a, const EdgeUse& b) {
    return std::tie(a.low, a.high, a.face, a.is_forward) <
           std::tie(b.low, b.high, b.face, b.is_forward);
  }
};

std::vector<EdgeUse> edge_uses(const Items& items) {
  const auto& faces = items.source->mesh.faces;
  std::vector<EdgeUse> uses;
  uses.reserve(3 * faces.size());
  for (int f = 0; f < items.size(); ++f)
    for (int k = 0; items.is_used[f] && k < 3; ++k) {
      const int a = faces[f][k], b = faces[f][(k + 1) % 3];
      uses.push_back({std::min(a, b), std::max(a, b), f, a < b});
    }
  std::sort(uses.begin(), uses.end());
  return uses;
}

struct Link {
  int from, to;
  signed char way;
};

void set_neighbors(Items& items, std::vector<Link>& links) {
  std::sort(links.begin(), links.end(), [](const Link& a, const Link& b) {
    return std::tie(a.from, a.to) < std::tie(b.from, b.to);
  });
  links.erase(
      std::unique(links.begin(), links.end(),
                  [](const Link& a, const Link& b) { return a.from == b.from && a.to == b.to; }),
      links.end());
  items.first.assign(items.size() + 1, 0);
  for (const Link& l : links) ++items.first[l.from + 1];
  std::partial_sum(items.first.begin(), items.first.end(), items.first.begin());
  for (const Link& l : links) items.neighbor.push_back(l.to), items.way.push_back(l.way);
}

void link_faces(Items& items) {
  const std::vector<EdgeUse> uses = edge_uses(items);
  constexpr std::size_t kMostAtEdge = 8;  // an edge of hundreds of faces is no neighbourhood
  std::vector<Link> links;
  links.reserve(uses.size());
  for (std::size_t i = 0, end; i < uses.size(); i = end) {
    for (end = i;
         end < uses.size() && uses[end].low == uses[i].low && uses[end].high == uses[i].high;)
      ++end;
    const std::size_t stop = std::min(end, i + kMostAtEdge);
    for (std::size_t a = i; a < stop; ++a)
      for (std::size_t b = i; b < stop; ++b)
        if (uses[a].face != uses[b].face)
          links.push_back(
              {uses[a].face, uses[b].face,
               static_cast<signed char>(uses[a].is_forward != uses[b].is_forward ? 1 : -1)});
  }
  set_neighbors(items, links);
}

void add_faces(Items& items) {
  const Mesh& mesh = items.source->mesh;
  for (const Face& f : mesh.faces) {
    const Vec3 cross = face_cross(mesh, f);
    const double length = cross.norm();
    const bool is_good = std::isfinite(length) && length > 1e-12;
    items.center.push_back(
        is_good ? Vec3((mesh.vertices[f[0]] + mesh.vertices[f[1]] + mesh.vertices[f[2]]) / 3)
                : Vec3(Vec3::Zero()));
    items.normal.push_back(is_good ? Vec3(cross / length) : Vec3(Vec3::Zero()));
    items.area.push_back(is_good ? 0.5 * length : 0);
    items.is_used.push_back(is_good);
  }
  link_faces(items);
}

/// The nearest used points of every used point, by rising (distance, index), without itself.
std::vector<std::vector<std::pair<double, int>>> nearest_points(const Items& items) {
  using PointIndex = std::pair<Kernel::Point_3, int>;
  using Traits =
      CGAL::Search_traits_adapter<PointIndex, CGAL::First_of_pair_property_map<PointIndex>,
                                  CGAL::Search_traits_3<Kernel>>;
  using Search = CGAL::Orthogonal_k_neighbor_search<Traits>;
  const auto to_cgal = [](const Vec3& p) { return Kernel::Point_3(p.x(), p.y(), p.z()); };
  Search::Tree tree;
  for (int i = 0; i < items.size(); ++i)
    if (items.is_used[i]) tree.insert({to_cgal(items.center[i]), i});
  std::vector<std::vector<std::pair<double, int>>> result(items.size());
  if (tree.empty()) return result;
  tree.build();
  parallel_for(
      items.size(),
      [&](std::size_t i) {
        if (!items.is_used[i]) return;
        Search search(tree, to_cgal(items.center[i]), kNearest + 1);
        for (const auto& [point, squared] : search)
          if (point.second != static_cast<int>(i))
            result[i].emplace_back(std::sqrt(squared), point.second);
        std::sort(result[i].begin(), result[i].end());
      },
      256);
  return result;
}

void add_points(Items& items) {
  const PointCloud& cloud = items.source->cloud;
  const bool has_normals = cloud.normals.size() == cloud.points.size();
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Vec3 n = has_normals ? cloud.normals[i] : Vec3(Vec3::Zero());
    const bool is_good = cloud.points[i].allFinite() && n.allFinite() && n.norm() > 1e-6;
    items.center.push_back(cloud.points[i].allFinite() ? cloud.points[i] : Vec3(Vec3::Zero()));
    items.normal.push_back(is_good ? Vec3(n.normalized()) : Vec3(Vec3::Zero()));
    items.is_used.push_back(is_good);
  }
  const auto nearest = nearest_points(items);
  std::vector<double> reach, spacing;
  for (const auto& list : nearest)
    if (!list.empty())
      reach.push_back(list.back().first), spacing.push_back(list[list.size() / 4].first);
  items.spacing = upper_median(spacing);
  const double most = 3 * upper_median(reach);
  std::vector<Link> links;
  items.area.assign(items.size(), 0);
  for (int i = 0; i < items.size(); ++i) {
    if (nearest[i].empty()) continue;
    const double r = std::min(nearest[i].back().first, most);
    items.area[i] = std::max(1e-12, M_PI * r * r / (nearest[i].size() + 1));
    for (const auto& [d, j] : nearest[i])
      if (d <= most) links.push_back({i, j, 0}), links.push_back({j, i, 0});
  }
  set_neighbors(items, links);
}

struct Components {
  std::vector<int> of_item;  // −1: unused
  std::vector<double> area;
};

Components connected_components(const Items& items) {
  Components c{std::vector<int>(items.size(), -1), {}};
  std::vector<int> stack;
  for (int i = 0; i < items.size(); ++i) {
    if (!items.is_used[i] || c.of_item[i] >= 0) continue;
    const int id = static_cast<int>(c.area.size());
    c.area.push_back(0);
    c.of_item[i] = id;
    stack.push_back(i);
    while (!stack.empty()) {
      const int at = stack.back();
      stack.pop_back();
      c.area[id] += items.area[at];
      for (int k = items.first[at]; k < items.first[at + 1]; ++k)
        if (c.of_item[items.neighbor[k]] < 0)
          c.of_item[items.neighbor[k]] = id, stack.push_back(items.neighbor[k]);
    }
  }
  return c;
}

/// Per component: whether it is a small one that hangs in the air, as reconstructions leave them
/// around antennas, wires and in front of the sky.
std::vector<char> hanging_ones(const Items& items, const Components& components, double total) {
  std::vector<double> lowest(components.area.size(), INFINITY);
  double foot = INFINITY;
  for (int i = 0; i < items.size(); ++i) {
    const int c = components.of_item[i];
    if (c < 0) continue;
    lowest[c] = std::min(lowest[c], items.center[i].z());
    foot = std::min(foot, items.center[i].z());
  }
  const double most = std::min(kHangingArea, kHangingShare * total);
  std::vector<char> out;
  for (std::size_t c = 0; c < lowest.size(); ++c)
    out.push_back(components.area[c] < most && lowest[c] > foot + kHangingHeight);
  return out;
}

/// Adds to the kept components those that come near a kept one, round by round. `reach`: metres,
/// per component.
void keep_close_ones(const Items& items, const Components& components,
                     const std::vector<double>& reach, std::vector<char>& is_kept) {
  const Mesh& mesh = items.source->mesh;
  constexpr int kRounds = 6;
  std::vector<char> is_new = is_kept;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Face> faces;
    std::vector<int> open;
    for (int i = 0; i < items.size(); ++i) {
      const int c = components.of_item[i];
      if (c < 0) continue;
      if (is_new[c]) faces.push_back(mesh.faces[i]);
      if (!is_kept[c]) open.push_back(i);
    }
    if (faces.empty() || open.empty()) return;
    const RayScene scene(mesh.vertices, faces);
    std::vector<char> is_close(open.size(), 0);
    parallel_for(
        open.size(),
        [&](std::size_t k) {
          std::array<Vec3, 3> corner;
          const int n = items.corners(open[k], corner);
          for (int j = 0; j < n && !is_close[k]; ++j)
            is_close[k] = scene.nearest(corner[j]).distance <= reach[components.of_item[open[k]]];
        },
        64);
    std::fill(is_new.begin(), is_new.end(), 0);
    bool is_any = false;
    for (std::size_t k = 0; k < open.size(); ++k)
      if (is_close[k]) is_new[components.of_item[open[k]]] = is_any = true;
    if (!is_any) return;
    for (std::size_t c = 0; c < is_kept.size(); ++c) is_kept[c] |= is_new[c];
  }
}

}  // namespace

int Items::corners(int item, std::array<Vec3, 3>& out) const {
  if (!is_mesh()) {
    out[0] = center[item];
    return 1;
  }
  for (int k = 0; k < 3; ++k) out[k] = source->mesh.vertices[source->mesh.faces[item][k]];
  return 3;
}

Items collect_items(const Source& source) {
  Items items;
  items.source = &source;
  if (source.is_mesh())
    add_faces(items);
  else
    add_points(items);
  items.is_floater.assign(items.is_used.size(), 0);
  return items;
}

void drop_floaters(Items& items, std::vector<std::string>& warnings) {
  const Components components = connected_components(items);
  const double total = std::accumulate(components.area.begin(), components.area.end(), 0.0);
  const double least = std::min(kFloaterArea, kFloaterShare * total);
  std::vector<char> is_kept(components.area.size(), 0), hangs(is_kept);
  if (items.is_mesh()) hangs = hanging_ones(items, components, total);
  std::vector<double> reach;
  double kept = 0;
  for (std::size_t c = 0; c < is_kept.size(); ++c) {
    const double area = components.area[c];
    reach.push_back(hangs[c] && area > kFloaterArea ? kHangingDistance : kFloaterDistance);
    if (area >= least && !hangs[c]) is_kept[c] = 1, kept += area;
  }
  if (kept < 0.5 * total) return;  // a soup of small pieces: no component says anything
  if (items.is_mesh()) keep_close_ones(items, components, reach, is_kept);
  const auto dropped = std::count(is_kept.begin(), is_kept.end(), 0);
  if (dropped == 0) return;
  for (int i = 0; i < items.size(); ++i)
    if (components.of_item[i] >= 0 && !is_kept[components.of_item[i]])
      items.is_used[i] = 0, items.is_floater[i] = 1;
  warnings.push_back("dropped " + std::to_string(dropped) +
                     " small components far from the building");
}

}  // namespace colod::regions
