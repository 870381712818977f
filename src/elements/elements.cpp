// Based on: nothing published; the planes of a balcony, a loggia and a chimney as scans show them.
// Differs: the paper knows closed segments and alcoves that rays see. Seen from the street a scan
//   has a balcony's outer faces and often its floor, not the inner faces of its parapet, rarely its
//   underside; a loggia's ceiling, cheeks and back, not its floor; a chimney without its top. Rays
//   then escape, or meet a thin wall from its back, and the part is closed over or cut away. Here
//   such parts are told by how their planes stand to each other, and what is missing is added.
// Notation: –
#include "elements.h"

#include <algorithm>

#include "balconies.h"
#include "bays.h"
#include "chimneys.h"
#include "dormers.h"
#include "loggias.h"
#include "panels.h"
#include "windows.h"

namespace colod {
namespace {

using elements::Panel;

struct Detector {
  Rule rule;
  std::vector<Element> (*find)(const std::vector<Panel>&);
  bool is_for_unknown;  ///< what it finds counts only where it is no part of what is known
};

/// In the order in which elements are found, returned and told to other rooms: of two that share
/// planes the earlier one takes them. What is seen from both sides goes before what one side shows.
constexpr Detector kDetectors[] = {{Rule::kBalconies, elements::find_balconies, false},
                                   {Rule::kBalconies, elements::find_balconies_from_below, true},
                                   {Rule::kLoggias, elements::find_loggias, false},
                                   {Rule::kChimneys, elements::find_chimneys, true},
                                   {Rule::kChimneys, elements::find_chimney_corners, true},
                                   {Rule::kBays, elements::find_bays, true},
                                   {Rule::kDormers, elements::find_dormers, false},
                                   {Rule::kWindows, elements::find_windows, false}};

/// A plane of it is one of a known element's, or lies in a known element of the same kind.
bool is_known(const Planes& planes, const std::vector<Element>& known, const Element& part) {
  for (const Element& e : known) {
    Region grown = e.solid;
    for (HalfSpace& side : grown) side.offset += elements::kReach;
    for (const int p : part.planes) {
      if (std::find(e.planes.begin(), e.planes.end(), p) != e.planes.end()) return true;
      if (e.kind == part.kind && contains(grown, planes.planes[p].centroid)) return true;
    }
  }
  return false;
}

void put_in_order(Element& element) {
  if (element.bounds.empty() && !element.is_whole) element.bounds = element.planes;
  for (std::vector<int>* list : {&element.planes, &element.bounds}) {
    std::sort(list->begin(), list->end());
    list->erase(std::unique(list->begin(), list->end()), list->end());
  }
}

}  // namespace

bool contains(const Region& region, const Vec3& x) {
  return std::all_of(region.begin(), region.end(),
                     [&](const HalfSpace& h) { return h.normal.dot(x) <= h.offset; });
}

std::vector<Element> find_elements(const Planes& planes, const std::vector<int>& among,
                                   const RuleSet& rules) {
  const std::vector<Panel> panels = elements::panels_of(planes, among);
  std::vector<Element> found;
  for (const Detector& detector : kDetectors) {
    if (!rules.has(detector.rule)) continue;
    for (Element& e : detector.find(panels))
      if (!detector.is_for_unknown || !is_known(planes, found, e)) found.push_back(std::move(e));
  }
  for (Element& e : found) put_in_order(e);
  return found;
}

}  // namespace colod
