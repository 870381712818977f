// *Based on:* footprints of wings around corners and courts, as towns have them.
//
// *Differs:* no --rules here.
//
// *Notation:* a, b: the ends of an edge of the plan, with the house on its left.
#include "shaped.h"

#include <algorithm>
#include <cmath>

namespace colod::synth {
namespace {

Vec3 at_height(const Vec2& p, double z) { return {p.x(), p.y(), z}; }

/// Builds walls edge by edge.
class WallBuilder {
 public:
  WallBuilder(House& house, double eaves) : house_(house), eaves_(eaves) {}

  int add(const Vec2& a, const Vec2& b, double top_a, double top_b, int object) {
    return house_.solid.add(
        {house_.ground.on(a), house_.ground.on(b), at_height(b, top_b), at_height(a, top_a)},
        object);
  }

  void add_ring(const std::vector<Vec2>& ring, bool is_court, const std::vector<Block>& blocks,
                ShapedBody& body) {
    const std::size_t n = ring.size();
    for (std::size_t i = 0; i < n; ++i) {
      const Vec2 &a = ring[i], &b = ring[(i + 1) % n];
      Wall wall;
      wall.top = eaves_;
      wall.is_court = is_court;
      wall.is_street = !is_court && outward(a, b).y() < -0.5;
      wall.is_corner_start = turns_left(ring[(i + n - 1) % n], a, b);
      wall.is_corner_end = turns_left(a, b, ring[(i + 2) % n]);
      const auto block = std::find_if(blocks.begin(), blocks.end(), [&](const Block& one) {
        return !is_court && one.edge == static_cast<int>(i);
      });
      if (block == blocks.end()) {
        wall.facet = add(a, b, eaves_, eaves_, kBody);
        body.walls.push_back(wall);
      } else {
        add_with_block(a, b, *block, wall, body);
      }
    }
  }

 private:
  static bool turns_left(const Vec2& a, const Vec2& b, const Vec2& c) {
    const Vec2 u = b - a, v = c - b;
    return u.x() * v.y() - u.y() * v.x() > 0;
  }

  void add_with_block(const Vec2& a, const Vec2& b, const Block& block, Wall wall,
                      ShapedBody& body) {
    const Vec2 along = (b - a).normalized();
    const Vec2 from = a + block.start * along, to = from + block.width * along;
    wall.is_whole = false;
    Wall left = wall, right = wall;
    left.is_corner_end = right.is_corner_start = false;
    left.facet = add(a, from, eaves_, eaves_, kBody);
    right.facet = add(to, b, eaves_, eaves_, kBody);
    body.walls.push_back(left);
    body.walls.push_back(right);
    add_block(from, to, block, body);
  }

  std::vector<Vec2> block_ring(const Vec2& from, const Vec2& to, const Block& block) const {
    const Vec2 out = outward(from, to);
    if (block.sides == 4) return {from, from + block.depth * out, to + block.depth * out, to};
    std::vector<Vec2> ring;  // half of a polygon, narrower than deep where it is flattened
    const Vec2 middle = (from + to) / 2, half = (to - from) / 2;
    for (int i = 0; i <= block.sides; ++i) {
      const double angle = M_PI * i / block.sides;
      ring.push_back(i == 0             ? from
                     : i == block.sides ? to
                                        : Vec2(middle - std::cos(angle) * half +
                                               std::sin(angle) * block.depth * out));
    }
    return ring;
  }

  void add_block(const Vec2& from, const Vec2& to, const Block& block, ShapedBody& body) {
    const bool is_tower = block.height > eaves_;
    const int part = is_tower ? house_.new_part(ElementKind::kSpire, "", block.width)
                              : house_.new_part(ElementKind::kAnnex, "", block.depth);
    const auto ring = block_ring(from, to, block);
    const Vec2 out = outward(from, to);
    const auto top = [&](const Vec2& p) {
      return block.height - block.slope * (p - from).dot(out);
    };
    std::vector<Vec3> floor, roof;
    for (const Vec2& p : ring) {
      floor.push_back(house_.ground.on(p));
      roof.push_back(at_height(p, top(p)));
    }
    house_.solid.add(reversed(floor), part);
    for (std::size_t i = 0; i + 1 < ring.size(); ++i) {
      Wall wall;
      wall.facet = add(ring[i], ring[i + 1], top(ring[i]), top(ring[i + 1]), part);
      wall.is_corner_start = i > 0, wall.is_corner_end = i + 2 < ring.size();
      wall.is_street = outward(ring[i], ring[i + 1]).y() < -0.9;
      wall.is_whole = false;
      wall.top = std::min(top(ring[i]), top(ring[i + 1]));
      body.block_walls.push_back(wall);
    }
    add_block_roof(roof, block, part, body);
    const double h = block.height;
    if (is_tower)
      house_.solid.add(
          {at_height(to, eaves_), at_height(from, eaves_), at_height(from, h), at_height(to, h)},
          part);
    else
      house_.solid.add(
          {at_height(from, h), at_height(to, h), at_height(to, eaves_), at_height(from, eaves_)},
          kBody);
  }

  void add_block_roof(const std::vector<Vec3>& ring, const Block& block, int part,
                      ShapedBody& body) {
    const int object = block.height > eaves_ ? kRoof : part;
    if (block.spire <= 0) {
      const int deck = house_.solid.add(ring, object);
      // What stood on an annex would run into the eaves above it.
      if (block.slope == 0 && block.height > eaves_) body.decks.push_back(deck);
      return;
    }
    Vec3 apex = Vec3::Zero();
    for (const Vec3& p : ring) apex += p / static_cast<double>(ring.size());
    apex.z() += block.spire;
    for (std::size_t i = 0; i < ring.size(); ++i)
      house_.solid.add({ring[i], ring[(i + 1) % ring.size()], apex}, object);
  }

  House& house_;
  double eaves_;
};

/// Upright quadrangles over the plan's rings from one height to another; `is_outside`: seen from
/// outside of the plan.
void add_band(Solid& solid, const Plan& plan, double z0, double z1, bool is_outside, int object) {
  for (const auto& ring : plan.rings())
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vec2 &a = ring[i], &b = ring[(i + 1) % ring.size()];
      const std::vector<Vec3> quad = {at_height(a, z0), at_height(b, z0), at_height(b, z1),
                                      at_height(a, z1)};
      solid.add(is_outside ? quad : reversed(quad), object);
    }
}

void add_flat_roof(House& house, const Plan& plan, double z, const ShapedRoof& roof,
                   ShapedBody& body) {
  Solid& solid = house.solid;
  if (roof.overhang > 0 || roof.parapet <= 0) {
    body.decks.push_back(add_level(solid, plan, z, true, kRoof));
    return;
  }
  const int part = house.new_part(ElementKind::kParapet, "parapet", roof.parapet);
  const Plan inner = plan.grown(-roof.parapet_width);
  add_rim(solid, plan, inner, z, true, part);
  add_band(solid, inner, z - roof.parapet, z, false, part);
  body.decks.push_back(add_level(solid, inner, z - roof.parapet, true, kRoof));
}

void add_mansard_roof(House& house, const Plan& plan, double z, const ShapedRoof& roof,
                      ShapedBody& body) {
  const Plan upper = plan.grown(-roof.run);
  const double top = z + roof.hips.slope * roof.run;
  const auto low = plan.rings(), high = upper.rings();
  for (std::size_t r = 0; r < low.size(); ++r)
    for (std::size_t i = 0; i < low[r].size(); ++i) {
      const std::size_t j = (i + 1) % low[r].size();
      body.roof.slopes.push_back(
          house.solid.add({at_height(low[r][i], z), at_height(low[r][j], z),
                           at_height(high[r][j], top), at_height(high[r][i], top)},
                          kRoof));
    }
  if (roof.upper_slope > 0)
    add_hipped_roof(house, upper, top, {.slope = roof.upper_slope});
  else
    body.decks.push_back(add_level(house.solid, upper, top, true, kRoof));
}

}  // namespace

ShapedBody add_shaped_body(House& house, const Plan& plan, double eaves, const ShapedRoof& roof,
                           const std::vector<Block>& blocks) {
  Solid& solid = house.solid;
  ShapedBody body;
  std::vector<Vec3> floor;
  for (const Vec2& p : plan.outer) floor.push_back(house.ground.on(p));
  const int bottom = solid.add(reversed(floor), kBody);
  if (plan.has_court()) {
    Ring hole;
    for (const Vec2& p : plan.court)
      hole.push_back(solid.facet(bottom).project(house.ground.on(p)));
    if (signed_area(hole) < 0) std::reverse(hole.begin(), hole.end());
    solid.cut(bottom, hole);
  }
  WallBuilder walls(house, eaves);
  walls.add_ring(plan.outer, false, blocks, body);
  if (plan.has_court()) walls.add_ring(plan.court, true, {}, body);
  Plan edge = plan;
  double z = eaves;
  if (roof.overhang > 0) {
    edge = plan.grown(roof.overhang);
    add_rim(solid, edge, plan, eaves, false, kRoof);
    z += roof.thickness;
    add_band(solid, edge, eaves, z, true, kRoof);
  }
  if (roof.kind == RoofKind::kFlat)
    add_flat_roof(house, edge, z, roof, body);
  else if (roof.kind == RoofKind::kMansard)
    add_mansard_roof(house, edge, z, roof, body);
  else
    body.roof = add_hipped_roof(house, edge, z, roof.hips);
  return body;
}

}  // namespace colod::synth
