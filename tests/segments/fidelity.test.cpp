#include <catch2/catch.hpp>

#include "core/parallel.h"
#include "segments/rules.h"
#include "segments_helpers.h"

using namespace colod;
using namespace colod::test;

namespace {

/// A body of 12 × 10 × 6 m with a pane in its front, a wing of 6 × 10 × 6 m that is open to it, and
/// a spire of 2 × 2 × 6 m on it: names end in the segment.
NamedPlanes church() {
  NamedPlanes s;
  s.add("front 0", {wall_y(0, 4, 0, 6, 0), wall_y(6, 12, 0, 6, 0), wall_y(4, 6, 0, 2, 0),
                    wall_y(4, 6, 4, 6, 0)});
  s.add("back 0", wall_y(0, 12, 0, 6, 10, false));
  s.add("left 0", wall_x(0, 10, 0, 6, 0));
  s.add("floor 0", slab(0, 12, 0, 10, 0, false));
  s.add("roof 0",
        {slab(0, 5, 0, 10, 6), slab(7, 12, 0, 10, 6), slab(5, 7, 0, 4, 6), slab(5, 7, 6, 10, 6)});
  s.add("wing front 1", wall_y(12, 18, 0, 6, 0));
  s.add("wing back 1", wall_y(12, 18, 0, 6, 10, false));
  s.add("wing right 1", wall_x(0, 10, 0, 6, 18, false));
  s.add("wing floor 1", slab(12, 18, 0, 10, 0, false));
  s.add("wing roof 1", slab(12, 18, 0, 10, 6));
  s.add("spire front 2", wall_y(5, 7, 6, 12, 4));
  s.add("spire back 2", wall_y(5, 7, 6, 12, 6, false));
  s.add("spire left 2", wall_x(4, 6, 6, 12, 5));
  s.add("spire right 2", wall_x(4, 6, 6, 12, 7, false));
  s.add("spire top 2", slab(5, 7, 4, 6, 12));
  s.add("pane 3", wall_y(4, 6, 2, 4, 0));
  return s;
}

Segments as_named(const NamedPlanes& scene) {
  Segments s;
  s.segments.resize(4);
  for (std::size_t p = 0; p < scene.names.size(); ++p) {
    const int of = scene.names[p].back() - '0';
    s.segment_of_plane.push_back(of);
    s.segments[of].planes.push_back(static_cast<int>(p));
  }
  return s;
}

std::vector<Coverage> coverage_of(const NamedPlanes& scene, int ns) {
  VisibilityOptions options;
  options.ns = ns, options.nr = 72;
  return fidelity_coverage(cast_visibility(as_planes(scene.planes), options), as_named(scene));
}

/// What goes with these segments together.
double loss(const std::vector<Coverage>& coverage, const std::set<int>& dropped) {
  double sum = 0;
  for (const Coverage& c : coverage)
    if (!c.segments.empty() && std::all_of(c.segments.begin(), c.segments.end(),
                                           [&](int s) { return dropped.count(s) > 0; }))
      sum += c.share;
  return sum;
}

}  // namespace

TEST_CASE("a pane is worth nothing, a wing its volume, a spire its outline") {
  for (const int ns : {24, 48}) {
    INFO(ns << " voxels a side");
    const std::vector<Coverage> coverage = coverage_of(church(), ns);
    double sum = 0;
    for (const Coverage& c : coverage) sum += c.share;
    CHECK(sum == Approx(1));
    CHECK(loss(coverage, {3}) < 0.005);
    // The wing has 360 of 1104 m³; voxels at its opening see the body as much.
    CHECK(loss(coverage, {1}) > 0.2);
    CHECK(loss(coverage, {1}) < 0.36);
    // The spire has 24 of 1104 m³, and 12 of 120 and of 72 m² of two of three outlines.
    CHECK(loss(coverage, {2}) > 1.3 * 24 / 1104);
    CHECK(loss(coverage, {2}) < 0.07);
    CHECK(loss(coverage, {0}) > 0.4);
    CHECK(loss(coverage, {1, 2, 3}) <= 1 - loss(coverage, {0}));
    CHECK(loss(coverage, {0, 1, 2, 3}) == Approx(1));
  }
}

TEST_CASE("the fidelity is the same with one thread and with more") {
  const std::vector<Coverage> many = coverage_of(church(), 24);
  limit_threads(1);
  const std::vector<Coverage> one = coverage_of(church(), 24);
  limit_threads(0);
  REQUIRE(one.size() == many.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    CHECK(one[i].segments == many[i].segments);
    CHECK(one[i].share == many[i].share);
  }
}
