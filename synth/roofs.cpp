// *Based on:* straight skeletons as roofs (Aichholzer, Aurenhammer, Alberts, Gärtner, "A novel type
// of skeleton for polygons", 1995), with CGAL's construction. A hip becomes a gable, or steeper, by
// pulling its apex along the ridge, which stays on both neighbouring slopes.
//
// *Differs:* no --rules here.
//
// *Notation:* a, b: an edge of the eaves; p: the apex over it.
#include "roofs.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_with_holes_2.h>
#include <CGAL/create_straight_skeleton_from_polygon_with_holes_2.h>

#include <algorithm>
#include <cmath>

namespace colod::synth {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Polygon = CGAL::Polygon_2<Kernel>;

constexpr double kSame = 1e-5;  // m, skeleton nodes nearer than this are one

struct Slope {
  std::vector<int> nodes;  ///< the edge's two ends first
};

/// The skeleton's faces; z of a node is its distance from the eaves.
struct Skeleton {
  std::vector<Vec3> nodes;
  std::vector<Slope> slopes;

  int index(const Vec3& p) {
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if ((nodes[i] - p).norm() < kSame) return static_cast<int>(i);
    nodes.push_back(p);
    return static_cast<int>(nodes.size()) - 1;
  }
};

Polygon to_polygon(const std::vector<Vec2>& ring) {
  Polygon polygon;
  for (const Vec2& p : ring) polygon.push_back({p.x(), p.y()});
  return polygon;
}

Skeleton make_skeleton(const Plan& plan) {
  CGAL::Polygon_with_holes_2<Kernel> polygon(to_polygon(plan.outer));
  if (plan.has_court()) polygon.add_hole(to_polygon(plan.court));
  const auto made = CGAL::create_interior_straight_skeleton_2(polygon, Kernel());
  Skeleton skeleton;
  for (auto face = made->faces_begin(); face != made->faces_end(); ++face) {
    std::vector<int> nodes;
    auto h = face->halfedge();
    do {
      const auto v = h->vertex();
      const int i = skeleton.index({v->point().x(), v->point().y(), v->time()});
      if (nodes.empty() || (nodes.back() != i && nodes.front() != i)) nodes.push_back(i);
      h = h->next();
    } while (h != face->halfedge());
    const auto on_eaves = [&](int i) { return skeleton.nodes[i].z() < kSame; };
    for (std::size_t k = 0; k < nodes.size(); ++k)
      if (on_eaves(nodes[0]) && on_eaves(nodes[1]))
        break;
      else
        std::rotate(nodes.begin(), nodes.begin() + 1, nodes.end());
    if (nodes.size() >= 3) skeleton.slopes.push_back({nodes});
  }
  return skeleton;
}

/// Whether the slope is a hip whose apex ends a ridge at right angles to its edge.
bool ends_ridge(const Skeleton& s, const Slope& hip) {
  if (hip.nodes.size() != 3) return false;
  const int apex = hip.nodes[2];
  const Vec3 edge = s.nodes[hip.nodes[1]] - s.nodes[hip.nodes[0]];
  int faces = 0;
  bool is_straight = true;
  for (const Slope& other : s.slopes) {
    if (std::find(other.nodes.begin(), other.nodes.end(), apex) == other.nodes.end()) continue;
    ++faces;
    const Vec3 along = s.nodes[other.nodes[1]] - s.nodes[other.nodes[0]];
    if (&other != &hip)
      is_straight = is_straight && std::abs(along.dot(edge)) < 1e-6 * along.norm() * edge.norm();
  }
  return faces == 3 && is_straight;
}

struct End {
  int a, b, apex;
  double pull;  ///< 0: as the skeleton has it, 1: a gable
};

/// The wall over a gable, its top in steps, from the roof's plane outwards by the thickness.
class SteppedGable {
 public:
  SteppedGable(House& house, const Vec3& a, const Vec3& b, const Vec3& apex, const HippedRoof& roof)
      : house_(house), a_(a), b_(b), apex_(apex) {
    const Vec2 out = outward({a.x(), a.y()}, {b.x(), b.y()});
    inward_ = -roof.step_thickness * Vec3(out.x(), out.y(), 0);
    const double rise = apex.z() - a.z(), over = 0.25 + 0.03 * rise;
    profile_.push_back(a);
    for (int i = 0; i < roof.steps; ++i)
      add_step(i / (roof.steps + 0.5), (i + 1) / (roof.steps + 0.5), rise, over);
    const std::vector<Vec3> rising = profile_;
    for (std::size_t i = rising.size(); i-- > 0;) {
      const double share = (rising[i] - a).head<2>().norm() / (b - a).head<2>().norm();
      const Vec3 mirrored = a + (1 - share) * (b - a);
      profile_.push_back({mirrored.x(), mirrored.y(), rising[i].z()});
    }
    lift_middle(rising.size(), rise, over);
  }

  /// Returns the outer face.
  int build(int part) {
    Solid& solid = house_.solid;
    std::vector<Vec3> outer = profile_;
    std::reverse(outer.begin(), outer.end());  // from b back to a
    outer.pop_back();
    outer.insert(outer.begin(), a_);
    const int face = solid.add(outer, kBody);
    std::vector<Vec3> inner;
    for (const Vec3& p : profile_) inner.push_back(p + inward_);
    inner.push_back(apex_ + inward_);
    solid.add(inner, part);
    for (std::size_t i = 0; i + 1 < profile_.size(); ++i)
      solid.add({profile_[i], profile_[i + 1], profile_[i + 1] + inward_, profile_[i] + inward_},
                part);
    return face;
  }

 private:
  /// From one share of the half width to the next, above the roof at its higher end.
  void add_step(double from, double to, double rise, double over) {
    const Vec3 low = a_ + from / 2 * (b_ - a_), high = a_ + to / 2 * (b_ - a_);
    const double z = a_.z() + to * rise + over;
    profile_.push_back({low.x(), low.y(), z});
    profile_.push_back({high.x(), high.y(), z});
  }
  /// The step across the middle.
  void lift_middle(std::size_t half, double rise, double over) {
    const double z = a_.z() + rise + over;
    Vec3 left = profile_[half - 1], right = profile_[half];
    left.z() = right.z() = z;
    profile_.insert(profile_.begin() + static_cast<std::ptrdiff_t>(half), {left, right});
  }

  House& house_;
  Vec3 a_, b_, apex_, inward_;
  std::vector<Vec3> profile_;  ///< from a up and down to b
};

std::vector<End> choose_ends(House& house, const Skeleton& skeleton, const HippedRoof& roof) {
  std::vector<End> ends;
  for (const Slope& s : skeleton.slopes) {
    if (!ends_ridge(skeleton, s)) continue;
    double pull = 0;
    if (house.random.chance(roof.gable_share))
      pull = 1;
    else if (house.random.chance(roof.steep_share))
      pull = house.random.uniform(0.2, 0.75);
    ends.push_back({s.nodes[0], s.nodes[1], s.nodes[2], pull});
  }
  return ends;
}

}  // namespace

RoofFacets add_hipped_roof(House& house, const Plan& eaves, double z, const HippedRoof& roof) {
  Skeleton skeleton = make_skeleton(eaves);
  const std::vector<End> ends = choose_ends(house, skeleton, roof);
  for (const End& e : ends) {
    const Vec3 middle = (skeleton.nodes[e.a] + skeleton.nodes[e.b]) / 2;
    skeleton.nodes[e.apex].head<2>() += e.pull * (middle - skeleton.nodes[e.apex]).head<2>();
  }
  std::vector<Vec3> nodes;
  for (const Vec3& p : skeleton.nodes) nodes.emplace_back(p.x(), p.y(), z + roof.slope * p.z());
  RoofFacets facets;
  const int part = roof.step_thickness > 0
                       ? house.new_part(ElementKind::kParapet, "stepped_gable", roof.step_thickness)
                       : -1;
  std::vector<Vec3> shift(nodes.size(), Vec3::Zero());
  bool has_steps = false;
  for (const End& e : ends) {
    if (e.pull < 1) continue;
    if (part < 0) {
      facets.gables.push_back(
          house.solid.add({nodes[e.a], nodes[e.b], nodes[e.apex]}, roof.gable_object));
      continue;
    }
    has_steps = true;
    facets.gables.push_back(
        SteppedGable(house, nodes[e.a], nodes[e.b], nodes[e.apex], roof).build(part));
    const Vec2 out = outward(nodes[e.a].head<2>(), nodes[e.b].head<2>());
    for (int i : {e.a, e.b, e.apex}) shift[i] -= roof.step_thickness * Vec3(out.x(), out.y(), 0);
  }
  if (part >= 0 && !has_steps) house.parts.pop_back();
  for (const Slope& s : skeleton.slopes) {
    const bool is_gable = std::any_of(ends.begin(), ends.end(), [&](const End& e) {
      return e.pull == 1 && e.a == s.nodes[0] && e.b == s.nodes[1];
    });
    if (is_gable) continue;
    std::vector<Vec3> corners;
    for (int i : s.nodes) corners.push_back(nodes[i] + shift[i]);
    facets.slopes.push_back(house.solid.add(corners, kRoof));
  }
  return facets;
}

namespace {

/// Where sheets have their creases, and how much they rise there.
std::vector<Vec2> wave_of(const ProfileRoof& roof, double width) {
  if (roof.wave_length <= 0) return {{0, 0}, {width, 0}};
  const int creases = std::max(2, static_cast<int>(std::lround(2 * width / roof.wave_length)));
  std::vector<Vec2> wave;
  for (int i = 0; i <= creases; ++i)
    wave.emplace_back(width * i / creases, i % 2 ? roof.wave_height : 0);
  return wave;
}

}  // namespace

ProfileBody add_profile_body(House& house, const ProfileRoof& roof) {
  Solid& solid = house.solid;
  const double L = house.width, D = house.depth;
  const std::vector<Vec2> wave = wave_of(roof, L);
  const auto top = [&](const Vec2& w, const Vec2& p) { return Vec3(w.x(), p.x(), p.y() + w.y()); };
  const auto foot = [&](double x, double y) { return house.ground.on({x, y}); };
  solid.add({foot(0, 0), foot(0, D), foot(L, D), foot(L, 0)}, kBody);
  std::vector<Vec3> front = {foot(0, 0), foot(L, 0)}, back = {foot(L, D), foot(0, D)};
  for (std::size_t i = wave.size(); i-- > 0;) front.push_back(top(wave[i], roof.profile.front()));
  for (const Vec2& w : wave) back.push_back(top(w, roof.profile.back()));
  std::vector<Vec3> right = {foot(L, 0), foot(L, D)}, left = {foot(0, D), foot(0, 0)};
  for (std::size_t k = roof.profile.size(); k-- > 0;)
    right.push_back(top(wave.back(), roof.profile[k]));
  for (const Vec2& p : roof.profile) left.push_back(top(wave.front(), p));
  ProfileBody body;
  body.front = solid.add(front, kBody), body.right = solid.add(right, kBody);
  body.back = solid.add(back, kBody), body.left = solid.add(left, kBody);
  for (std::size_t k = 0; k + 1 < roof.profile.size(); ++k)
    for (std::size_t i = 0; i + 1 < wave.size(); ++i) {
      const Vec2 &p = roof.profile[k], &q = roof.profile[k + 1];
      const int facet = solid.add(
          {top(wave[i], p), top(wave[i + 1], p), top(wave[i + 1], q), top(wave[i], q)}, kRoof);
      if (roof.wave_length <= 0) body.roofs.push_back(facet);
    }
  return body;
}

}  // namespace colod::synth
