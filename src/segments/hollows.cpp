// Based on: elements/elements.h.
// Differs: robust rules only. Rays give a balcony's floor or one of its walls to the body, a
//   loggia's ceiling and cheeks to the body or to several small segments. The planes of a tray, a
//   niche or a recess become one segment: the one that has most of them and little else, or a new
//   one. A chimney of which a scan shows a corner only may share a detail's segment with something
//   larger; its planes then become a segment, too.
// Notation: –
#include <algorithm>

#include "elements/elements.h"
#include "parameters.h"
#include "rules.h"

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

bool is_alcove(Hollow::Kind kind) {
  return kind == Hollow::Kind::kNiche || kind == Hollow::Kind::kRecess;
}

Form form_of(Hollow::Kind kind) {
  if (kind == Hollow::Kind::kTray) return Form::kTray;
  if (kind == Hollow::Kind::kNiche) return Form::kNiche;
  if (kind == Hollow::Kind::kRecess) return Form::kRecess;
  return kind == Hollow::Kind::kBay ? Form::kBay : Form::kDormer;
}

std::vector<int> segments_by_plane(std::size_t planes, const SegmentDraft& draft) {
  std::vector<int> of(planes, -1);
  for (std::size_t s = 0; s < draft.segments.size(); ++s)
    for (const int p : draft.segments[s].planes) of[p] = static_cast<int>(s);
  return of;
}

/// The segment that the hollow's planes go to, or −1: a new one. `taken` are those that earlier
/// hollows took.
int home_of(const Planes& planes, const SegmentDraft& draft, const Hollow& hollow,
            const std::vector<int>& segment_of_plane, const std::vector<char>& is_taken,
            const std::vector<int>& free) {
  const double area = area_of(planes, hollow.planes);
  std::vector<double> share(draft.segments.size(), 0), free_share(draft.segments.size(), 0);
  for (const int p : hollow.planes)
    if (const int s = segment_of_plane[p]; s >= 0)
      (is_taken[p] ? share : free_share)[s] += planes.planes[p].area;
  const auto most = std::max_element(share.begin(), share.end());
  if (most != share.end() && *most >= kSameHollow * area)
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

bool may_own(const Planes& planes, const Hollow& hollow, double alcove_area) {
  if (is_alcove(hollow.kind))
    return std::all_of(hollow.planes.begin(), hollow.planes.end(),
                       [&](int p) { return planes.planes[p].area < alcove_area; });
  return hollow.kind != Hollow::Kind::kShaft;
}

/// A shaft whose walls lie in one segment that is mostly something else leaves it.
void part_shaft(const Planes& planes, const HitGrid& grid, const Hollow& shaft,
                const std::vector<char>& is_taken, SegmentDraft& draft) {
  const std::vector<int> of = segments_by_plane(planes.planes.size(), draft);
  const int home = of[shaft.planes.front()];
  std::int64_t voxels = 0;
  for (const Segment& s : draft.segments) voxels += s.voxels;
  if (home < 0 || kMostShare * draft.segments[home].voxels > voxels ||
      std::any_of(shaft.planes.begin(), shaft.planes.end(),
                  [&](int p) { return is_taken[p] || of[p] != home; }))
    return;
  Region grown = shaft.solid;
  for (HalfSpace& side : grown) side.offset += kShaftReach;
  Segment own, rest = draft.segments[home];
  for (const int p : rest.planes)
    if (contains(grown, planes.planes[p].centroid) ||
        std::find(shaft.planes.begin(), shaft.planes.end(), p) != shaft.planes.end())
      own.planes.push_back(p);
  std::erase_if(rest.planes,
                [&](int p) { return std::binary_search(own.planes.begin(), own.planes.end(), p); });
  if (area_of(planes, rest.planes) <= area_of(planes, own.planes)) return;
  own.voxels = std::min(rest.voxels, voxels_in(grid, shaft.solid));
  own.volume = static_cast<double>(own.voxels) * grid.voxel_volume();
  rest.voxels -= own.voxels, rest.volume -= own.volume;
  draft.segments[home] = std::move(rest);
  draft.segments.push_back(std::move(own));
}

}  // namespace

void give_to_hollows(const Planes& planes, const HitGrid& grid, const SegmentOptions& options,
                     SegmentDraft& draft) {
  const bool has_forms = options.rules.has(Rule::kForms);
  if (!has_forms && !options.rules.has(Rule::kShafts)) return;
  std::vector<int> every(planes.planes.size());
  for (std::size_t p = 0; p < every.size(); ++p) every[p] = static_cast<int>(p);
  std::vector<char> is_taken(planes.planes.size(), 0);
  const std::vector<Hollow> hollows = find_hollows(planes, every);
  for (const Hollow& hollow : hollows) {
    if (!has_forms || !may_own(planes, hollow, options.alcove_area)) continue;
    std::vector<int> of = segments_by_plane(planes.planes.size(), draft), free;
    for (const int p : hollow.planes)
      if (!is_taken[p]) free.push_back(p);
    if (free.empty()) continue;
    int home = home_of(planes, draft, hollow, of, is_taken, free);
    if (home < 0) {
      home = static_cast<int>(draft.segments.size());
      draft.segments.emplace_back();
      draft.segments.back().voxels =
          voxels_in(grid, hollow.air.empty() ? hollow.solid : hollow.air);
      draft.segments.back().volume =
          static_cast<double>(draft.segments.back().voxels) * grid.voxel_volume();
    }
    Segment& segment = draft.segments[home];
    if (segment.form == Form::kPlain) {
      segment.form = form_of(hollow.kind);
      segment.is_alcove |= is_alcove(hollow.kind);
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
  for (const Hollow& hollow : hollows)  // others may have taken a shaft's walls: a dormer's cheeks
    if (options.rules.has(Rule::kShafts) && hollow.kind == Hollow::Kind::kShaft)
      part_shaft(planes, grid, hollow, is_taken, draft);
  std::erase_if(draft.segments, [](const Segment& s) { return s.planes.empty(); });
}

}  // namespace colod
