// Based on: Cover, Hart, "Nearest neighbor pattern classification", 1967, with a distance beyond
// which nothing counts.
// Differs: the paper compares shape and scale alone and knows no kinds. Detectors have limits in
// metres, so that a dormer of a hall or a chimney of a hut is told by none of them; what repeats
// their shape at the same height of its building is of their kind all the same.
// Notation: –
#include "likeness.h"

#include <algorithm>
#include <map>
#include <utility>

#include "core/parallel.h"
#include "parameters.h"

namespace colod {
namespace {

using namespace parameters::coanalysis;

constexpr std::size_t kSamples = 64;  // elements of a kind that are compared with, spread evenly

std::vector<const Descriptor*> examples(const std::vector<Descriptor>& segments) {
  std::map<ElementKind, std::vector<const Descriptor*>> of_kind;
  for (const Descriptor& d : segments)
    if (has_kind(d)) of_kind[d.kind].push_back(&d);
  std::vector<const Descriptor*> chosen;
  for (const auto& [kind, all] : of_kind) {
    const std::size_t n = std::min(all.size(), kSamples);
    for (std::size_t i = 0; i < n; ++i) chosen.push_back(all[i * all.size() / n]);
  }
  return chosen;
}

ElementKind vote(const Descriptor& segment, const std::vector<const Descriptor*>& examples,
                 double eta) {
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t i = 0; i < examples.size(); ++i) {
    const Descriptor& e = *examples[i];
    const double distance = eta * shape_distance(segment, e) + (segment.context - e.context).norm();
    if (distance <= kLike) near.push_back({distance, i});
  }
  const auto end = near.begin() + std::min<std::ptrdiff_t>(kLikeVoters, std::ssize(near));
  std::partial_sort(near.begin(), end, near.end());
  std::map<ElementKind, int> votes;
  for (auto n = near.begin(); n != end; ++n)
    if (const ElementKind kind = examples[n->second]->kind; ++votes[kind] >= kLikeVotes)
      return kind;
  return ElementKind::kPlain;
}

}  // namespace

std::vector<ElementKind> likely_kinds(const std::vector<Descriptor>& segments, double eta) {
  const std::vector<const Descriptor*> known = examples(segments);
  std::vector<ElementKind> kinds(segments.size());
  parallel_for(segments.size(), [&](std::size_t s) {
    const Descriptor& d = segments[s];
    kinds[s] = has_kind(d) ? d.kind : vote(d, known, eta);
  });
  return kinds;
}

}  // namespace colod
