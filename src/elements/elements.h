// Shared by `segments` and `extraction`: what planes enclose only in part: balconies, loggias and
// shop fronts, chimneys whose top no scan shows; and bays, dormers and the recesses of windows and
// doors, which rays do not always part from what is behind them.
#pragma once

#include <vector>

#include "core/element_kind.h"
#include "core/rules.h"
#include "planes/planes.h"

namespace colod {

/// normal · x ≤ offset.
struct HalfSpace {
  Vec3 normal;
  double offset;  ///< metres
};
using Region = std::vector<HalfSpace>;  ///< convex: what lies in all of them

bool contains(const Region& region, const Vec3& x);

struct Element {
  ElementKind kind;
  std::vector<int> planes = {};  ///< rising
  std::vector<int> bounds = {};  ///< those of them that end it, rising: the mesh cannot do without
  Region air = {};               ///< outside the building, whatever rays see; a chimney has none
  Region solid = {};             ///< inside it: a balcony's floor, a chimney; a loggia has none
  std::vector<Region> sheets = {};  ///< thin walls: rays say nothing of them

  /// Nothing of it is missing that rays would need: bays, recesses, dormers on roofs that are not
  /// steep.
  bool is_whole = false;

  /// A face that must be there although no plane shows it.
  struct Rim {
    Vec3 normal;             ///< unit, out of the solid
    double offset;           ///< metres
    std::vector<Vec3> hull;  ///< on it
    int like = -1;           ///< the plane whose back it is; −1: none
  };
  std::vector<Rim> rims = {};
};

/// Those that the planes `among` (indices, rising) form; a plane may be part of several. Balconies
/// first, then loggias, chimneys, bays, dormers and recesses, by lowest planes. Cheap: pairs of
/// small planes that are near. Of the rules each kind's own is asked.
std::vector<Element> find_elements(const Planes& planes, const std::vector<int>& among,
                                   const RuleSet& rules = RuleSet::all());

/// These planes (indices) are those of a chimney that is seen from all sides: most of their area
/// are walls that look away from each other, in two directions, and they begin above the building's
/// foot. find_elements leaves such chimneys out: nothing of them is missing.
bool is_whole_chimney(const Planes& planes, const std::vector<int>& which);

}  // namespace colod
