// Based on: rounds/rounds.h. Differs: --rules robust only. The sides of a round shape are planes of
// their own from the start: grown like walls they join in patches, and what is left of them has no
// plane. Notation: –
#include "round.h"

#include <algorithm>
#include <cmath>

#include "parameters.h"
#include "rounds/reduce.h"
#include "rounds/rounds.h"

namespace colod::regions {
namespace {

using namespace parameters::planes;

Region side_region(const Items& items, const RoundShape& shape, const RoundShape::Side& side) {
  Region r;
  for (const int i : side.faces)
    if (items.is_used[i]) r.items.push_back(i), r.moments.add_item(items, i);
  r.area = r.moments.weight;
  r.normal = shape.normal(side.row, side.column);
  r.offset = shape.offset(side.row, side.column);
  return r;
}

}  // namespace

std::vector<Region> round_regions(const Items& items, const RuleSet& rules) {
  std::vector<Region> regions;
  for (const RoundShape& shape : find_rounds(*items.source, rules)) {
    const bool is_fine = shape.sides.size() <= kMostSides;
    const RoundShape drawn = is_fine ? shape : reduce_round(shape, turn_within(shape, kFinest));
    for (const RoundShape::Side& side : drawn.sides)
      if (Region r = side_region(items, drawn, side); !r.items.empty())
        regions.push_back(std::move(r));
  }
  return regions;
}

}  // namespace colod::regions
