// Based on: k-means++ (Arthur, Vassilvitskii, 2007) for the prototypes. That 1 − Σ min / Σ max is a
// metric: Ružička's form of the Jaccard distance (Levandowsky, Winter, "Distance between sets",
// 1971; Späth, "The minisum location problem for the Jaccard metric", 1981).
//
// f_co compares every segment with every other building, near or far in descriptor space, so
// leaving out all but a segment's nearest neighbours would leave out nearly all of it. Instead the
// segments that ask are grouped: sim(k, t) is replaced by sim(q_k, t), where q_k is one of a few
// hundred prototypes and t stays what it is. Time and memory are segments × prototypes.
//
// What is lost. With dis = η ‖h − h'‖₂ + B, where B = ‖v − v'‖₁ / (‖v‖₁ + ‖v'‖₁):
// - the first term is a metric: |η‖h_k − h_t‖ − η‖h_q − h_t‖| ≤ η‖h_k − h_q‖;
// - B is none, but J = 2B / (1 + B) = 1 − Σ min(v, v') / Σ max(v, v') is (v ≥ 0), and B = J / (2 −
//   J) rises with J. With r = J(k, q): |J(k, t) − J(q, t)| ≤ r, and since the slope of B, 2 / (2 −
//   J)², is largest at J = 1, |B(k, t) − B(q, t)| ≤ 1 − B(1 − r) = 2r / (1 + r).
// Hence |dis(k, t) − dis(q, t)| ≤ ρ_k = η‖h_k − h_q‖ + 2r / (1 + r), and sim(q, t) / e^ρ ≤ sim(k,
// t) ≤ sim(q, t) · e^ρ for every t. e^ρ_k is the item's spread: E_0 with weights divided by it is
// never more than the true E_0 of a choice, and the bound on the program with weights multiplied by
// it never less than the true optimum. The difference is part of the reported gap.
//
// Elements of one kind are at distance 0 from each other; ρ holds where k and q are both of the
// kind, or neither of any, so that others are kUnlike.
//
// Differs: the paper compares all pairs.
//
// Notation: k, t items, q prototype, h histogram, v eigenvalues, ρ as above.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <set>

#include "core/parallel.h"
#include "selection_model.h"

namespace colod::selection {
namespace {

constexpr int kSample = 4096;  // items from which prototypes are found
constexpr int kLloydRounds = 4;
constexpr double kLeastEigenvalue = 1e-9;  // m², for logarithms
constexpr double kFloatRounding = 1e-6;
constexpr double kUnlike = 50;  // ρ of what a prototype must not stand for: it weighs nothing

// ρ of the proof. Not finite where a descriptor is not.
double spread_exponent(const Descriptor& k, const Descriptor& q, double eta) {
  if (is_one_kind(k, q)) return 0;
  if (has_kind(k) || has_kind(q)) return kUnlike;
  const double sum = k.eigenvalues.lpNorm<1>() + q.eigenvalues.lpNorm<1>();
  const double b = sum > 0 ? (k.eigenvalues - q.eigenvalues).lpNorm<1>() / sum : 0;
  return eta * shape_distance(k, q) + 4 * b / (1 + 3 * b);
}

bool is_finite(const Descriptor& d) {
  return d.eigenvalues.allFinite() && (d.eigenvalues.array() >= 0).all() &&
         std::all_of(d.d2.begin(), d.d2.end(), [](double x) { return std::isfinite(x); });
}

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

// Which centre is nearest by ρ, the first of equals, and its ρ.
struct Nearest {
  int centre = 0;
  double rho = 0;
};

Nearest nearest_centre(const Descriptor& d, const std::vector<Descriptor>& centres, double eta) {
  Nearest best{0, spread_exponent(d, centres[0], eta)};
  for (std::size_t c = 1; c < centres.size(); ++c)
    if (const double rho = spread_exponent(d, centres[c], eta); rho < best.rho)
      best = {static_cast<int>(c), rho};
  return best;
}

// Each next one with a probability in proportion to ρ² to those before.
std::vector<Descriptor> first_centres(const std::vector<const Descriptor*>& sample, double eta,
                                      int most) {
  std::mt19937_64 random(1);
  std::vector<Descriptor> centres;
  std::vector<double> squared(sample.size(), 1.0);
  for (int c = 0; c < most; ++c) {
    double sum = 0;
    for (const double s : squared) sum += s;
    if (!(sum > 0)) break;  // everything is a prototype
    double left = unit(random) * sum;
    std::size_t pick = 0;
    while (pick + 1 < sample.size() && left >= squared[pick]) left -= squared[pick++];
    centres.push_back(*sample[pick]);
    parallel_for(
        sample.size(),
        [&](std::size_t i) {
          const double rho = spread_exponent(*sample[i], centres.back(), eta);
          squared[i] = c == 0 ? rho * rho : std::min(squared[i], rho * rho);
        },
        64);
  }
  return centres;
}

// Mean histogram, geometric mean of the eigenvalues.
Descriptor mean_of(const std::vector<const Descriptor*>& members) {
  Descriptor mean;
  mean.kind = members.front()->kind;
  Vec3 logs = Vec3::Zero();
  for (const Descriptor* d : members) {
    for (std::size_t b = 0; b < mean.d2.size(); ++b) mean.d2[b] += d->d2[b];
    logs += d->eigenvalues.cwiseMax(kLeastEigenvalue).array().log().matrix();
  }
  const auto count = static_cast<double>(members.size());
  for (double& share : mean.d2) share /= count;
  mean.eigenvalues = (logs / count).array().exp();
  return mean;
}

std::vector<Descriptor> find_centres(const std::vector<const Descriptor*>& items, double eta,
                                     int most) {
  std::vector<const Descriptor*> sample;
  const std::size_t wanted = std::min<std::size_t>(items.size(), kSample);
  for (std::size_t i = 0; i < wanted; ++i) sample.push_back(items[i * items.size() / wanted]);
  std::set<ElementKind> kinds;  // none without a prototype
  for (const Descriptor* d : items)
    if (has_kind(*d) && kinds.insert(d->kind).second) sample.push_back(d);
  std::vector<Descriptor> centres = first_centres(sample, eta, most);
  for (int round = 0; round < kLloydRounds; ++round) {
    std::vector<Nearest> nearest(sample.size());
    parallel_for(
        sample.size(),
        [&](std::size_t i) { nearest[i] = nearest_centre(*sample[i], centres, eta); }, 16);
    std::vector<std::vector<const Descriptor*>> members(centres.size());
    for (std::size_t i = 0; i < sample.size(); ++i) members[nearest[i].centre].push_back(sample[i]);
    for (std::size_t c = 0; c < centres.size(); ++c)
      if (!members[c].empty()) centres[c] = mean_of(members[c]);
  }
  return centres;
}

}  // namespace

void share_prototypes(const std::vector<SelectionBuilding>& buildings, double eta, int most,
                      Model& model) {
  std::vector<const Descriptor*> all, items;  // what is not finite is like nothing
  for (const Item& item : model.items) {
    all.push_back(&buildings[item.building].segments[item.segment]);
    if (is_finite(*all.back())) items.push_back(all.back());
  }
  const std::vector<Descriptor> centres =
      items.empty() ? std::vector<Descriptor>(1) : find_centres(items, eta, most);
  model.is_exact = false;
  model.prototypes = centres.size();
  model.coarse_sim.assign(all.size() * centres.size(), 0);
  parallel_for(
      all.size(),
      [&](std::size_t k) {
        Item& item = model.items[k];
        item.prototype = 0;
        if (!is_finite(*all[k])) {
          item.weight = item.weight_high = 0;
          return;
        }
        const Nearest nearest = nearest_centre(*all[k], centres, eta);
        const double spread = std::exp(nearest.rho) * (1 + kFloatRounding);
        item.prototype = nearest.centre;
        item.weight /= spread, item.weight_high *= spread;
        for (std::size_t q = 0; q < centres.size(); ++q)
          model.coarse_sim[k * centres.size() + q] = static_cast<std::uint16_t>(
              std::min(65535.0, segment_similarity(*all[k], centres[q], eta) / kSimUnit));
      },
      16);
}

}  // namespace colod::selection
