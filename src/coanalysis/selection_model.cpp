// Based on: Co-LOD section 3.2, eq. 2–5.
//
// Differs: both rules: f_r > bound is loss ≤ (1 − bound)(1 − 1e-9), so that a share exactly at the
// bound is refused whatever its rounding. Buildings without a segment do not count as "other
// buildings". Shares are divided by their sum. A building of which no voxel is enclosed has f_r = 1
// as long as it keeps any segment. Similarities are rounded to float once, here: bound and
// objective mean the same numbers.
//
// Notation: selection_model.h.
#include "selection_model.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>

#include "core/parallel.h"
#include "parameters.h"

namespace colod::selection {

namespace {

using namespace parameters::coanalysis;

constexpr double kStrict = 1e-9;

double sane(double x) { return std::isfinite(x) && x > 0 ? x : 0; }

// Enclosed voxels by the exact set of segments that enclose them; shares sum to 1, never empty.
std::map<std::vector<int>, double> merged_coverage(const SelectionBuilding& building) {
  std::map<std::vector<int>, double> terms;
  double sum = 0;
  for (const Coverage& c : building.coverage) {
    std::vector<int> set = c.segments;
    std::sort(set.begin(), set.end());
    set.erase(std::unique(set.begin(), set.end()), set.end());
    assert(set.empty() ||
           (set.front() >= 0 && set.back() < static_cast<int>(building.segments.size())));
    if (sane(c.share) == 0) continue;
    sum += c.share;
    if (!set.empty()) terms[set] += c.share;
  }
  if (sum == 0) {
    std::vector<int> all(building.segments.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
    return {{all, 1.0}};
  }
  for (auto& [set, share] : terms) share /= sum;
  return terms;
}

// What dropping the segment alone loses.
std::vector<double> lone_losses(const SelectionBuilding& building,
                                const std::map<std::vector<int>, double>& terms) {
  std::vector<double> loss(building.segments.size(), 0.0);
  for (const auto& [set, share] : terms)
    if (set.size() == 1) loss[set.front()] += share;
  return loss;
}

void add_building(const SelectionBuilding& building, int number, const SelectionOptions& options,
                  double similarity_weight, Model& model) {
  const int n = static_cast<int>(building.segments.size());
  const double bound = options.rules.has(Rule::kStrictBound) ? kRobustBound : kPaperBound;
  Block block;
  block.first = model.size();
  block.capacity = (1 - bound) * (1 - kStrict);

  double area = 0;
  for (const Descriptor& d : building.segments) area += sane(d.area);
  block.constant = 1 - (area > 0 ? options.beta : 0);

  const auto terms = merged_coverage(building);
  const std::vector<double> lone = lone_losses(building, terms);
  std::vector<int> item_of(n, -1);
  for (int s = 0; s < n; ++s) {
    if (lone[s] > block.capacity) continue;
    const double share = area > 0 ? sane(building.segments[s].area) / area : 0;
    item_of[s] = model.size();
    const double weight = similarity_weight * (options.rules.has(Rule::kAreaShares) ? share : 1);
    model.items.push_back({static_cast<int>(model.blocks.size()), number, s, options.beta * share,
                           weight, weight, model.size()});
  }
  for (const auto& [set, share] : terms) {
    Term term{{}, share};
    for (const int s : set) term.items.push_back(item_of[s]);
    if (term.items.front() >= 0 &&
        std::find(term.items.begin(), term.items.end(), -1) == term.items.end())
      block.terms.push_back(std::move(term));  // with a segment that stays, nothing is ever lost
  }
  block.count = model.size() - block.first;
  model.blocks.push_back(std::move(block));
}

void fill_similarities(const std::vector<SelectionBuilding>& buildings, double eta, Model& model) {
  const std::size_t n = model.items.size();
  model.prototypes = n;
  model.sim.assign(n * n, 0.0f);
  const auto descriptor = [&](std::size_t k) -> const Descriptor& {
    return buildings[model.items[k].building].segments[model.items[k].segment];
  };
  parallel_for(
      n,
      [&](std::size_t a) {
        for (std::size_t b = 0; b < n; ++b) {
          if (model.items[a].block == model.items[b].block) continue;
          // The smaller index first: both halves get the same bits.
          const double s =
              segment_similarity(descriptor(std::min(a, b)), descriptor(std::max(a, b)), eta);
          model.sim[a * n + b] = std::isfinite(s) ? static_cast<float>(s) : 0.0f;
        }
      },
      8);
}

// With a prior f_co is linear: each item is worth its mean similarity to the prior's buildings.
void add_prior_gains(const std::vector<SelectionBuilding>& buildings, const Prior& prior,
                     double eta, Model& model) {
  std::vector<std::vector<const Descriptor*>> beyond;  // layer 0, per building that has segments
  for (const Prior::PriorBuilding& b : prior.buildings) {
    if (b.segments.empty()) continue;
    beyond.emplace_back();
    for (std::size_t s = 0; s < b.segments.size(); ++s)
      if (b.layer[s] > 0) beyond.back().push_back(&b.segments[s]);
  }
  parallel_for(model.items.size(), [&](std::size_t k) {
    Item& item = model.items[k];
    const Descriptor& own = buildings[item.building].segments[item.segment];
    double sum = 0;
    for (const auto& building : beyond) {
      double best = 0;
      for (const Descriptor* other : building) {
        const double s = segment_similarity(own, *other, eta);
        if (s > best) best = s;  // not for what is not a number
      }
      sum += best;
    }
    item.gain += item.weight * sum;
    item.weight = item.weight_high = 0;
    item.prototype = 0;
  });
  model.prototypes = 1;
  model.sim.assign(model.items.size(), 0.0f);
}

Model add_buildings(const std::vector<SelectionBuilding>& buildings,
                    const SelectionOptions& options) {
  Model model;
  const auto has_segments = [](const auto& b) { return !b.segments.empty(); };
  const auto counted = std::count_if(buildings.begin(), buildings.end(), has_segments) - 1;
  const auto in_prior = options.prior ? std::count_if(options.prior->buildings.begin(),
                                                      options.prior->buildings.end(), has_segments)
                                      : counted;
  const auto others = static_cast<double>(std::max<std::ptrdiff_t>(1, in_prior));
  const double weight =
      options.rules.has(Rule::kAreaShares) ? options.lambda / others : options.lambda;
  for (std::size_t i = 0; i < buildings.size(); ++i)
    if (!buildings[i].segments.empty())
      add_building(buildings[i], static_cast<int>(i), options, weight, model);
  return model;
}

}  // namespace

const float* Model::rows(const Block& block, std::vector<float>& room) const {
  const std::size_t begin = static_cast<std::size_t>(block.first) * prototypes;
  if (is_exact) return sim.data() + begin;
  const std::uint16_t* coarse = coarse_sim.data() + begin;
  room.resize(static_cast<std::size_t>(block.count) * prototypes);
  for (std::size_t i = 0; i < room.size(); ++i) room[i] = kSimUnit * static_cast<float>(coarse[i]);
  return room.data();
}

const float* Model::rows_high(const Block& block, std::vector<float>& room) const {
  if (is_exact) return rows(block, room);
  const std::uint16_t* coarse =
      coarse_sim.data() + static_cast<std::size_t>(block.first) * prototypes;
  room.resize(static_cast<std::size_t>(block.count) * prototypes);
  for (std::size_t i = 0; i < room.size(); ++i)
    room[i] = kSimUnit * static_cast<float>(coarse[i] + 1);
  return room.data();
}

Model build_model(const std::vector<SelectionBuilding>& buildings,
                  const SelectionOptions& options) {
  Model model = add_buildings(buildings, options);
  if (options.prior)
    add_prior_gains(buildings, *options.prior, options.eta, model);
  else if (model.size() <= options.exact_similarities)
    fill_similarities(buildings, options.eta, model);
  else
    share_prototypes(buildings, options.eta, options.prototypes, model);
  return model;
}

double block_loss(const Block& block, const Choice& x) {
  double loss = 0;
  for (const Term& t : block.terms)
    if (std::all_of(t.items.begin(), t.items.end(), [&](int k) { return x[k]; })) loss += t.share;
  return loss;
}

bool is_feasible(const Model& model, const Choice& x) {
  return std::all_of(model.blocks.begin(), model.blocks.end(),
                     [&](const Block& b) { return block_loss(b, x) <= b.capacity; });
}

double objective(const Model& model, const Choice& x) {
  double e = 0;
  for (const Block& b : model.blocks) {
    const double loss = block_loss(b, x);
    if (loss > b.capacity) return -std::numeric_limits<double>::infinity();
    e += b.constant - loss;
  }
  // best[q]: the block's dropped item that is most similar to q; total: over all blocks.
  constexpr std::size_t kTogether = 256;  // blocks, so that memory does not grow with their number
  const std::size_t width = model.prototypes;
  std::vector<float> best(std::min(kTogether, model.blocks.size()) * width);
  std::vector<float> own(model.items.size());  // per item: what its block offers to its prototype
  std::vector<double> total(width, 0.0);
  for (std::size_t first = 0; first < model.blocks.size(); first += kTogether) {
    const std::size_t count = std::min(kTogether, model.blocks.size() - first);
    parallel_for(
        count,
        [&](std::size_t i) {
          const Block& b = model.blocks[first + i];
          float* most = best.data() + i * width;
          std::vector<float> room;
          std::fill(most, most + width, 0.0f);
          const float* sim = model.rows(b, room);
          for (int t = b.first; t < b.first + b.count; ++t, sim += width) {
            if (!x[t]) continue;
            for (std::size_t q = 0; q < width; ++q) most[q] = std::max(most[q], sim[q]);
          }
          for (int k = b.first; k < b.first + b.count; ++k) own[k] = most[model.items[k].prototype];
        },
        8);
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t q = 0; q < width; ++q) total[q] += best[i * width + q];
  }
  for (int k = 0; k < model.size(); ++k) {
    if (!x[k]) continue;
    const Item& item = model.items[k];
    const double others = total[item.prototype] - own[k];
    e += item.gain + item.weight * others;
  }
  return e;
}

}  // namespace colod::selection
