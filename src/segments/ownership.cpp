// Based on: elements/elements.h.
// Differs: robust rules only. Rays give a balcony's floor or one of its walls to the body, a
//   loggia's ceiling and cheeks to the body or to several small segments. The planes of a balcony,
//   a loggia or a recess become one segment: the one that has most of them and little else, or a
//   new one. Chimneys are parted by rays: they get their name, so that small and large ones are
//   one kind.
// Notation: –
#include "ownership.h"

#include <algorithm>

#include "elements/elements.h"
#include "parameters.h"

namespace colod {
namespace {

using namespace parameters::segments;

double area_of(const Planes& planes, const std::vector<int>& which) {
  double sum = 0;
  for (const int p : which) sum += planes.planes[p].area;
  return sum;
}

std::int64_t voxels_in(const HitGrid& grid, const Region& air) {
  std::int64_t count = 0;
  for (std::size_t v = 0; v < grid.is_valid.size(); ++v) count += contains(air, grid.center(v));
  return count;
}

bool is_alcove(ElementKind kind) {
  return kind == ElementKind::kLoggia || kind == ElementKind::kWindow;
}

std::vector<int> segments_by_plane(std::size_t planes, const SegmentDraft& draft) {
  std::vector<int> of(planes, -1);
  for (std::size_t s = 0; s < draft.segments.size(); ++s)
    for (const int p : draft.segments[s].planes) of[p] = static_cast<int>(s);
  return of;
}

/// The segment that the element's planes go to, or −1: a new one. `taken` are those that earlier
/// elements took.
int home_of(const Planes& planes, const SegmentDraft& draft, const Element& element,
            const std::vector<int>& segment_of_plane, const std::vector<char>& is_taken,
            const std::vector<int>& free) {
  const double area = area_of(planes, element.planes);
  std::vector<double> share(draft.segments.size(), 0), free_share(draft.segments.size(), 0);
  for (const int p : element.planes)
    if (const int s = segment_of_plane[p]; s >= 0)
      (is_taken[p] ? share : free_share)[s] += planes.planes[p].area;
  const auto most = std::max_element(share.begin(), share.end());
  if (most != share.end() && *most >= kSameElement * area)
    return static_cast<int>(most - share.begin());
  int best = -1;
  for (std::size_t s = 0; s < draft.segments.size(); ++s) {
    if (free_share[s] <= 0 || (best >= 0 && free_share[s] <= free_share[best])) continue;
    double others = 0;
    for (const int p : draft.segments[s].planes)
      if (std::find(free.begin(), free.end(), p) == free.end()) others += planes.planes[p].area;
    if (others <= kMostOthers * free_share[s] && others <= area) best = static_cast<int>(s);
  }
  return best;
}

bool may_own(const Planes& planes, const Element& element, double alcove_area) {
  if (is_alcove(element.kind))
    return std::all_of(element.planes.begin(), element.planes.end(),
                       [&](int p) { return planes.planes[p].area < alcove_area; });
  return element.kind != ElementKind::kChimney;
}

/// Most of the segment's area is one chimney's.
bool is_chimney(const Planes& planes, const Segment& segment,
                const std::vector<Element>& elements) {
  const double area = area_of(planes, segment.planes);
  return is_whole_chimney(planes, segment.planes) ||
         std::any_of(elements.begin(), elements.end(), [&](const Element& e) {
           const bool is_its = std::includes(segment.planes.begin(), segment.planes.end(),
                                             e.planes.begin(), e.planes.end());
           return e.kind == ElementKind::kChimney && is_its &&
                  area <= (1 + kMostOthers) * area_of(planes, e.planes);
         });
}

}  // namespace

void give_to_elements(const Planes& planes, const HitGrid& grid, const SegmentOptions& options,
                      SegmentDraft& draft) {
  if (!options.rules.has(Rule::kElementSegments)) return;
  std::vector<int> every(planes.planes.size());
  for (std::size_t p = 0; p < every.size(); ++p) every[p] = static_cast<int>(p);
  std::vector<char> is_taken(planes.planes.size(), 0);
  const std::vector<Element> elements = find_elements(planes, every, options.rules);
  for (const Element& element : elements) {
    if (!may_own(planes, element, options.alcove_area)) continue;
    std::vector<int> of = segments_by_plane(planes.planes.size(), draft), free;
    for (const int p : element.planes)
      if (!is_taken[p]) free.push_back(p);
    if (free.empty()) continue;
    int home = home_of(planes, draft, element, of, is_taken, free);
    if (home < 0) {
      home = static_cast<int>(draft.segments.size());
      draft.segments.emplace_back();
      draft.segments.back().voxels =
          voxels_in(grid, element.air.empty() ? element.solid : element.air);
      draft.segments.back().volume =
          static_cast<double>(draft.segments.back().voxels) * grid.voxel_volume();
    }
    Segment& segment = draft.segments[home];
    if (segment.kind == ElementKind::kPlain) {
      segment.kind = element.kind;
      segment.is_alcove |= is_alcove(element.kind);
    }
    for (const int p : free) {
      is_taken[p] = 1;
      if (of[p] == home) continue;
      if (of[p] >= 0) std::erase(draft.segments[of[p]].planes, p);
      segment.planes.push_back(p);
    }
    std::sort(segment.planes.begin(), segment.planes.end());
    for (Segment& s : draft.segments)
      if (s.planes.empty() && &s != &segment) {
        segment.voxels += s.voxels, segment.volume += s.volume;
        s.voxels = 0, s.volume = 0;
      }
  }
  std::erase_if(draft.segments, [](const Segment& s) { return s.planes.empty(); });
  if (!options.rules.has(Rule::kChimneys)) return;
  for (Segment& s : draft.segments)
    if (s.kind == ElementKind::kPlain && is_chimney(planes, s, elements))
      s.kind = ElementKind::kChimney;
}

}  // namespace colod
