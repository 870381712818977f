#include "coanalysis/selection.h"

#include <catch2/catch.hpp>

#include "coanalysis/selection_model.h"
#include "core/parallel.h"
#include "selection_helpers.h"

using namespace colod;
using namespace colod::test;
using Choices = std::vector<std::vector<char>>;

namespace {

int segment_count(const std::vector<SelectionBuilding>& buildings) {
  int n = 0;
  for (const auto& b : buildings) n += static_cast<int>(b.segments.size());
  return n;
}

// E_0 straight from the paper's formulas: no model, no reduction.
double plain_objective(const std::vector<SelectionBuilding>& buildings, const Choices& keep,
                       const SelectionOptions& o) {
  double e = 0;
  for (std::size_t i = 0; i < buildings.size(); ++i) {
    const auto& b = buildings[i];
    double fr = 0, kept_area = 0, area = 0, fco = 0;
    for (const Coverage& c : b.coverage)
      for (const int s : c.segments)
        if (keep[i][s]) {
          fr += c.share;
          break;
        }
    for (std::size_t s = 0; s < b.segments.size(); ++s)
      area += b.segments[s].area, kept_area += keep[i][s] ? b.segments[s].area : 0;
    for (std::size_t s = 0; s < b.segments.size(); ++s) {
      if (keep[i][s]) continue;
      for (std::size_t j = 0; j < buildings.size(); ++j) {
        double best = 0;
        for (std::size_t t = 0; t < buildings[j].segments.size() && j != i; ++t)
          if (!keep[j][t])
            best =
                std::max(best, segment_similarity(b.segments[s], buildings[j].segments[t], o.eta));
        const double others = static_cast<double>(buildings.size()) - 1;
        fco += o.rules.is_none() ? best : best * b.segments[s].area / area / std::max(1.0, others);
      }
    }
    if (fr <= (o.rules.is_none() ? 0.8 : 0.95)) return -std::numeric_limits<double>::infinity();
    e += fr - o.beta * kept_area / area + o.lambda * fco;
  }
  return e;
}

double enumerated_optimum(const std::vector<SelectionBuilding>& buildings,
                          const SelectionOptions& o) {
  const int n = segment_count(buildings);
  double best = -std::numeric_limits<double>::infinity();
  for (unsigned mask = 0; mask < 1u << n; ++mask) {
    Choices keep;
    int bit = 0;
    for (const auto& b : buildings) {
      keep.emplace_back();
      for (std::size_t s = 0; s < b.segments.size(); ++s) keep.back().push_back(mask >> bit++ & 1);
    }
    best = std::max(best, plain_objective(buildings, keep, o));
  }
  return best;
}

SelectionOptions rules(bool is_paper, int exact_segments) {
  SelectionOptions o;
  o.rules = is_paper ? RuleSet::none() : RuleSet::all(), o.exact_segments = exact_segments;
  return o;
}

}  // namespace

TEST_CASE("lp_solve, and the ascent under its bound, against enumeration") {
  for (const bool is_paper : {false, true})
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
      const RandomScene shape{.buildings = 3, .segments = 4, .body = seed % 2 ? 0.6 : 0.93};
      const auto scene = random_scene(shape, seed);
      const double best = enumerated_optimum(scene, rules(is_paper, 0));
      const Selection exact = select_layer0(scene, rules(is_paper, 40));
      const Selection ascent = select_layer0(scene, rules(is_paper, 0));
      CHECK(exact.status == SelectionStatus::kOptimal);
      CHECK(exact.objective == Approx(best).epsilon(1e-6));
      CHECK(ascent.bound >= best - 1e-6);
      CHECK(ascent.objective <= best + 1e-6);
      CHECK(ascent.objective >= best * 0.995);
      CHECK(ascent.gap < 0.05);
      CHECK(plain_objective(scene, ascent.is_layer0, rules(is_paper, 0)) ==
            Approx(ascent.objective).epsilon(1e-6));
    }
}

TEST_CASE("E_0 of any choice is the paper's formula, and a broken bound is minus infinity") {
  const auto scene = random_scene({.buildings = 3, .segments = 5}, 7);
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 60; ++trial) {
    Choices keep;
    for (const auto& b : scene) {
      keep.emplace_back();
      for (std::size_t s = 0; s < b.segments.size(); ++s) keep.back().push_back(random() % 4 != 0);
    }
    for (const bool is_paper : {false, true}) {
      const double expected = plain_objective(scene, keep, rules(is_paper, 0));
      const double got = selection_objective(scene, keep, rules(is_paper, 0));
      if (std::isfinite(expected))
        CHECK(got == Approx(expected).epsilon(1e-6));
      else
        CHECK(got == expected);
    }
  }
}

TEST_CASE("prototypes: objective and bound enclose what comparing all pairs finds") {
  for (const bool is_paper : {false, true})
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
      const auto scene = random_scene({.buildings = 12, .segments = 8}, seed);
      SelectionOptions all = rules(is_paper, 0), few = all;
      few.exact_similarities = 0, few.prototypes = 24;
      const Selection exact = select_layer0(scene, all);
      const Selection shared = select_layer0(scene, few);
      CHECK(!shared.is_exact);
      CHECK(exact.is_exact);
      // E_0 of the choice lies above what is said of it, the optimum below the bound.
      CHECK(selection_objective(scene, shared.is_layer0, all) >= shared.objective - 1e-6);
      CHECK(shared.bound >= exact.objective - 1e-6);
      CHECK(shared.gap >= exact.gap - 1e-6);
    }
}

TEST_CASE("prototypes: what the bound counts of a pair is no less than what is between them") {
  const auto scene = random_scene({.buildings = 20, .segments = 10}, 5);
  SelectionOptions few = rules(false, 0);
  few.exact_similarities = 0, few.prototypes = 12;
  const selection::Model model = selection::build_model(scene, few);
  std::vector<float> room, high_room;
  int compared = 0;
  for (const selection::Block& of : model.blocks) {
    const float* low = model.rows(of, room);
    const float* high = model.rows_high(of, high_room);
    for (int t = 0; t < of.count; ++t)
      for (const selection::Item& asks : model.items) {
        const selection::Item& has = model.items[of.first + t];
        const double true_sim =
            segment_similarity(scene[asks.building].segments[asks.segment],
                               scene[has.building].segments[has.segment], few.eta);
        const double plain = few.lambda * asks.gain / few.beta / 19;
        const std::size_t at = t * model.prototypes + asks.prototype;
        REQUIRE(asks.weight * low[at] <= plain * true_sim * (1 + 1e-9));
        REQUIRE(asks.weight_high * high[at] >= plain * true_sim * (1 - 1e-9));
        ++compared;
      }
  }
  CHECK(compared > 1000);
}

TEST_CASE("as many prototypes as segments lose next to nothing") {
  const auto scene = random_scene({.buildings = 6, .segments = 6}, 2);
  SelectionOptions all = rules(false, 0), few = all;
  few.exact_similarities = 0, few.prototypes = 1000;
  CHECK(select_layer0(scene, few).objective ==
        Approx(select_layer0(scene, all).objective).epsilon(0.02));
}

TEST_CASE("prototypes: nothing finite, all alike, one building") {
  SelectionOptions few = rules(false, 0);
  few.exact_similarities = 0;
  std::mt19937_64 random(1);
  SelectionBuilding bad, alike;
  bad.segments.resize(30), alike.segments.assign(30, random_descriptor(2, random));
  for (Descriptor& d : bad.segments) d.eigenvalues[0] = std::numeric_limits<double>::quiet_NaN();
  for (int s = 0; s < 30; ++s)
    bad.coverage.push_back({{s}, 1.0 / 30}), alike.coverage.push_back({{s}, 1.0 / 30});
  for (const auto& scene : std::vector<std::vector<SelectionBuilding>>{
           {bad, bad}, {alike, alike, alike}, {alike}, {bad, alike}}) {
    const Selection s = select_layer0(scene, few);
    CHECK(std::isfinite(s.objective));
    CHECK(s.bound >= s.objective);
    CHECK(s.gap < 0.01);
  }
}

TEST_CASE("a gap that is good enough stops early and holds") {
  const auto scene = random_scene({.buildings = 12, .segments = 10}, 4);
  SelectionOptions loose = rules(false, 0), tight = loose;
  loose.gap = 0.05, tight.gap = 0;
  const Selection a = select_layer0(scene, loose), b = select_layer0(scene, tight);
  CHECK(a.gap <= 0.05);
  CHECK(a.starts < b.starts);
  CHECK(b.gap <= a.gap);
  CHECK(a.bound >= b.objective - 1e-9);
}

TEST_CASE("up to 15 binaries: the optimum, called so, whatever gap is good enough") {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const RandomScene shape{.buildings = 2 + static_cast<int>(seed % 4), .segments = 3};
    const auto scene = random_scene(shape, 100 + seed);
    SelectionOptions o = rules(seed % 2, 40);
    o.gap = 0.05;
    const Selection s = select_layer0(scene, o);
    CHECK(s.status == SelectionStatus::kOptimal);
    CHECK(s.objective == Approx(enumerated_optimum(scene, o)).epsilon(1e-6));
  }
}

TEST_CASE("a block's branch and bound against enumeration, alone and with an offer") {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto scene = random_scene({.buildings = 2, .segments = 9, .body = 0.7}, seed);
    const selection::Model model = selection::build_model(scene, rules(seed % 2, 0));
    const selection::Block& block = model.blocks[0];
    std::mt19937_64 random(seed);
    std::vector<double> profit(model.size());
    for (double& p : profit) p = 0.1 * uniform(random);
    selection::Offer offer{model.sim.data(), 0, std::vector<double>(model.size(), 0.0)};
    for (int t = block.count; t < model.size(); ++t) offer.weights[t] = 0.02 * uniform(random);
    for (const selection::Offer* o : {static_cast<const selection::Offer*>(nullptr),
                                      static_cast<const selection::Offer*>(&offer)}) {
      double best = -1e9;
      for (unsigned mask = 0; mask < 1u << block.count; ++mask) {
        selection::Choice x(model.size(), 0);
        std::vector<int> set;
        double value = 0;
        for (int k = 0; k < block.count; ++k)
          if (mask >> k & 1) x[k] = 1, set.push_back(k), value += profit[k];
        const double loss = block_loss(block, x);
        if (loss <= block.capacity) best = std::max(best, value - loss + (o ? o->value(set) : 0));
      }
      const auto solution = selection::solve_block(block, profit, o, 100000);
      CHECK(solution.value == Approx(best).margin(1e-9));
      CHECK(solution.bound >= best - 1e-12);
      CHECK(solution.bound <= best + 1e-8);
      CHECK(selection::solve_block(block, profit, o, 2).bound >= best - 1e-12);
    }
  }
}

TEST_CASE("the bound stands above the optimum that lp_solve proves") {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const auto scene = random_scene({.buildings = 4, .segments = 7, .body = 0.8}, seed);
    const Selection exact = select_layer0(scene, rules(seed % 2, 40));
    const Selection ascent = select_layer0(scene, rules(seed % 2, 0));
    REQUIRE(exact.status == SelectionStatus::kOptimal);
    CHECK(ascent.bound >= exact.objective - 1e-7);
    CHECK(ascent.objective <= exact.objective + 1e-7);
    CHECK(ascent.objective >= 0.99 * exact.objective);
  }
}

TEST_CASE("the same answer every time and with any number of threads") {
  const auto scene = random_scene({.buildings = 8, .segments = 10}, 3);
  limit_threads(1);
  const Selection one = select_layer0(scene);
  limit_threads(0);
  const Selection many = select_layer0(scene);
  CHECK(one.is_layer0 == many.is_layer0);
  CHECK(one.bound == many.bound);
  CHECK(one.objective == many.objective);
}

TEST_CASE("permuting the buildings permutes the answer") {
  auto scene = random_scene({.buildings = 4, .segments = 6}, 5);
  const Selection a = select_layer0(scene);
  std::reverse(scene.begin(), scene.end());
  Selection b = select_layer0(scene);
  std::reverse(b.is_layer0.begin(), b.is_layer0.end());
  CHECK(a.is_layer0 == b.is_layer0);
  CHECK(a.objective == Approx(b.objective));
}

TEST_CASE("robust: where most elements of a kind leave, the last one does, and is told of") {
  // Four houses with a balcony; that of the last is worth more than its area.
  std::vector<SelectionBuilding> street;
  for (int i = 0; i < 4; ++i) {
    SelectionBuilding house;
    std::mt19937_64 random(i);
    for (const double area : {90.0, 10.0}) {
      house.segments.push_back(random_descriptor(area > 50 ? 1 : 2, random));
      house.segments.back().area = area;
    }
    house.segments[1].kind = ElementKind::kBalcony;
    const double worth = i == 3 ? 0.045 : 0.001;
    house.coverage = {{{0}, 1 - worth}, {{1}, worth}};
    street.push_back(house);
  }
  SelectionOptions options;
  options.beta = 0.1, options.lambda = 0.1;
  const Selection result = select_layer0(street, options);
  for (const auto& kept : result.is_layer0) CHECK(kept == std::vector<char>{1, 0});
  REQUIRE(result.overruled.size() == 1);
  CHECK(result.overruled[0].building == 3);
  CHECK(result.overruled[0].segment == 1);
  street[3].coverage = {{{0}, 0.9}, {{1}, 0.1}};  // more than f_r may lose
  CHECK(select_layer0(street, options).is_layer0[3] == std::vector<char>{1, 1});
}

TEST_CASE("lambda lets repeated parts leave, one after the other") {
  const auto scene = random_scene({.buildings = 8, .segments = 6}, 3);
  std::size_t last = std::numeric_limits<std::size_t>::max();
  for (const double lambda : {0.0, 0.4, 4.0}) {
    SelectionOptions options;
    options.lambda = lambda;
    std::size_t kept = 0;
    for (const auto& b : select_layer0(scene, options).is_layer0)
      kept += static_cast<std::size_t>(std::count(b.begin(), b.end(), 1));
    CHECK(kept <= last);
    last = kept;
  }
}

TEST_CASE("no building, no segment") {
  CHECK(select_layer0({}).status == SelectionStatus::kEmpty);
  const Selection s = select_layer0({{}, {}});
  CHECK(s.status == SelectionStatus::kEmpty);
  CHECK(s.is_layer0 == Choices{{}, {}});
}

TEST_CASE("one building alone has no f_co and is solved to proof") {
  for (const int exact : {0, 40}) {
    const auto scene = random_scene({.buildings = 1, .segments = 12}, 4);
    const Selection s = select_layer0(scene, rules(true, exact));
    CHECK(s.status == SelectionStatus::kOptimal);
    CHECK(s.objective == Approx(enumerated_optimum(scene, rules(true, 0))));
    SelectionOptions other = rules(true, exact);
    other.lambda = 7;
    CHECK(select_layer0(scene, other).is_layer0 == s.is_layer0);
  }
}

TEST_CASE("two identical buildings keep the same, and their f_co is that of each to the other") {
  const SelectionBuilding b = random_scene({.buildings = 1, .segments = 6}, 4)[0];
  for (const bool is_paper : {false, true})
    for (const int exact : {0, 40}) {
      const Selection s = select_layer0({b, b}, rules(is_paper, exact));
      CHECK(s.is_layer0[0] == s.is_layer0[1]);
      CHECK(s.objective == Approx(enumerated_optimum({b, b}, rules(is_paper, 0))).epsilon(2e-3));
      CHECK(s.bound >= s.objective - 1e-9);
    }
}

TEST_CASE("a building keeps what it has: one segment, no coverage, no area, NaN") {
  SelectionBuilding lone, bare;
  std::mt19937_64 random(1);
  lone.segments = {random_descriptor(1, random)};
  lone.coverage = {{{0}, 0.3}};  // shares that do not sum to 1 are scaled
  bare.segments.resize(3);
  bare.segments[1].area = std::numeric_limits<double>::quiet_NaN();
  bare.segments[2].eigenvalues[0] = std::numeric_limits<double>::quiet_NaN();
  for (const bool is_paper : {false, true})
    for (const int exact : {0, 40}) {
      const Selection s = select_layer0({lone, bare, {}}, rules(is_paper, exact));
      CHECK(s.is_layer0[0] == std::vector<char>{1});
      CHECK(std::count(s.is_layer0[1].begin(), s.is_layer0[1].end(), 1) >= 1);
      CHECK(std::isfinite(s.objective));
      CHECK(std::isfinite(s.bound));
      CHECK(s.gap >= 0);
    }
}

TEST_CASE("identical segments: ties are broken, not looped over") {
  std::mt19937_64 random(1);
  SelectionBuilding b;
  b.segments.assign(12, random_descriptor(2, random));
  for (int s = 0; s < 12; ++s) b.coverage.push_back({{s}, 1.0 / 12});
  const Selection s = select_layer0({b, b, b, b}, rules(true, 0));
  for (const auto& kept : s.is_layer0) CHECK(std::count(kept.begin(), kept.end(), 1) >= 10);
  CHECK(s.bound >= s.objective);
}

TEST_CASE("a hundred buildings in seconds, within a few percent of the bound") {
  const auto scene = random_scene({.buildings = 60, .segments = 9, .body = 0.9}, 9);
  const Selection s = select_layer0(scene);
  CHECK(s.gap < 0.05);
  CHECK(s.gap >= 0);
}
