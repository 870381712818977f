// Based on: elements.cpp.
// Differs: a dormer is closed, but on a steep slope it stands out by half a metre and no ray parts
// it
//   from the attic: its roof, a ledge on a steeper slope, then tells it. On such a slope its cheeks
//   are small and often not seen, and are added.
// Notation: T the dormer's own roof, R the roof that it stands out of, d distance from R.
#include "dormers.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "parameters.h"

namespace colod::elements {
namespace {

using namespace parameters::elements::dormers;

/// Distances of a panel's outline from a plane.
Range relief(const Panel& panel, const Plane& host) {
  Range r;
  for (const Vec3& x : panel.points) {
    const double d = host.signed_distance(x);
    r.extend({d, d});
  }
  return r;
}

bool stands_out(const Panel& roof, const Panel& host) {
  const Vec3& n = host.plane->normal;
  if (n.z() < 0.2 || n.z() > kLevel || host.plane->area < kLeastHost * roof.plane->area ||
      n.dot(roof.plane->normal) > kCrossing)
    return false;
  const Range d = relief(roof, *host.plane);
  if (d.low < -0.3 || d.low > kReach || d.high < kLeastRelief) return false;
  const Vec3 across = beside(Vec3(n.x(), n.y(), 0).normalized());
  const Range width = roof.along(across), host_width = host.along(across);
  if (overlap(width, host_width) < 0.7 * width.length()) return false;
  return std::all_of(roof.points.begin(), roof.points.end(), [&](const Vec3& x) {
    return host.plane->signed_distance(x) > kReach ||
           (x.z() > host.box.min.z() - 0.3 && x.z() < host.box.max.z() + 0.5);
  });
}

struct Ledge {
  const Panel *roof, *host;
};

std::vector<Ledge> find_ledges(const std::vector<Panel>& panels) {
  std::vector<Ledge> ledges;
  for (const Panel& p : panels) {
    if (p.plane->normal.z() < 0.3 || p.plane->area < kLeastRoof || p.plane->area > kMostRoof)
      continue;
    const Panel* best = nullptr;
    for (const Panel& host : panels)
      if (is_near(p.box, host.box, kReach) && stands_out(p, host) &&
          (!best || host.plane->area > best->plane->area))
        best = &host;
    if (best) ledges.push_back({&p, best});
  }
  return ledges;
}

/// What planes form a dormer.
struct Dormer {
  const Panel* host;
  std::vector<const Panel*> roofs, walls;
  Vec3 out, across;    ///< down the slope; along the eave
  Range width, depth;  ///< of all roofs along across; of the first along out
  Range height;        ///< as far down as a front may go
};

Dormer dormer_at(const std::vector<Panel>& panels, const std::vector<Ledge>& ledges,
                 const Ledge& first) {
  const Plane& host = *first.host->plane;
  const Vec3 out = Vec3(host.normal.x(), host.normal.y(), 0).normalized();
  Dormer dormer{first.host, {}, {}, out, beside(out), {}, first.roof->along(out), {}};
  Box box;
  for (const Ledge& l : ledges) {
    if (l.roof != first.roof &&
        (l.host != first.host || !is_near(l.roof->box, first.roof->box, 0.1)))
      continue;
    dormer.roofs.push_back(l.roof);
    dormer.width.extend(l.roof->along(dormer.across));
    box.extend(l.roof->box);
  }
  dormer.height = {box.min.z() - 2.5, box.max.z()};
  for (const Panel& p : panels) {
    if (!p.is_wall || p.plane->area > kMostWall || !is_near(p.box, box, 0.25)) continue;
    const Range d = relief(p, host), own = p.along(dormer.across);
    if (d.low > -0.4 && d.high > 0.2 && own.low > dormer.width.low - 0.3 &&
        own.high < dormer.width.high + 0.3 && p.box.max.z() < box.max.z() + 0.2)
      dormer.walls.push_back(&p);
  }
  return dormer;
}

/// Bounds the dormer by its walls on one side; by a rim as deep or as wide as its roof where no
/// scan shows one.
void describe_side(const Dormer& dormer, const Vec3& side, double at, const Range& across,
                   Element& element) {
  bool has_wall = false;
  for (const Panel* w : dormer.walls) {
    if (w->out.dot(side) < 0.8 || std::abs(w->at(side) - at) > kReach) continue;
    element.solid.push_back({w->plane->normal, w->plane->offset + 0.01});
    has_wall = true;
  }
  if (!has_wall) element.rims.push_back(upright_rim(side, at, across, dormer.height));
}

Element describe(const Dormer& dormer) {
  const Plane& host = *dormer.host->plane;
  const auto& [low, high] = dormer.width;
  Element element{.kind = ElementKind::kDormer, .planes = {}};
  for (const auto* parts : {&dormer.roofs, &dormer.walls})
    for (const Panel* p : *parts) element.planes.push_back(p->id);
  for (const Panel* p : dormer.roofs) element.solid.push_back({p->plane->normal, p->plane->offset});
  element.solid.push_back({-host.normal, -host.offset});
  element.solid.push_back({dormer.across, high});
  element.solid.push_back({-dormer.across, -low});
  element.solid.push_back({-Vec3::UnitZ(), -dormer.height.low});
  element.solid.push_back({dormer.out, dormer.depth.high + 0.02});
  element.is_whole = host.normal.z() > kSteep;
  if (element.is_whole) return element;
  for (const auto& [side, at] : {std::pair{dormer.across, high}, {Vec3(-dormer.across), -low}}) {
    const bool is_along = beside(side).dot(dormer.out) > 0;
    describe_side(dormer, side, at,
                  is_along ? dormer.depth : Range{-dormer.depth.high, -dormer.depth.low}, element);
  }
  describe_side(dormer, dormer.out, dormer.depth.high, dormer.width, element);
  return element;
}

}  // namespace

std::vector<Element> find_dormers(const std::vector<Panel>& panels) {
  const std::vector<Ledge> ledges = find_ledges(panels);
  std::vector<Element> dormers;
  for (const Ledge& l : ledges) {
    const bool is_known = std::any_of(dormers.begin(), dormers.end(), [&](const Element& h) {
      return std::find(h.planes.begin(), h.planes.end(), l.roof->id) != h.planes.end();
    });
    if (!is_known) dormers.push_back(describe(dormer_at(panels, ledges, l)));
  }
  return dormers;
}

}  // namespace colod::elements
