#include "coanalysis/clustering.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <functional>
#include <random>

#include "coanalysis/clustering_neighbours.h"
#include "coanalysis/kinds.h"
#include "core/parallel.h"
#include "selection_helpers.h"
#include "similarity_helpers.h"

using namespace colod;
using namespace colod::test;

namespace {

// A segment of a kind: its own histogram and, by `spread`, a little noise.
Descriptor of_kind(int kind, double extent, std::mt19937_64& random, double spread = 0.02) {
  const auto noise = [&] {
    return 1 + spread * (static_cast<double>(random() >> 11) * 0x1p-53 - 0.5);
  };
  Descriptor d;
  d.d2[8 * kind + 4] = 0.5 * noise();
  d.d2[8 * kind + 6] = 1 - d.d2[8 * kind + 4];
  d.extent = extent * noise();
  d.eigenvalues = d.extent * d.extent * Vec3(1, 0.5, 0.3);
  d.volume = d.extent * d.extent * d.extent;
  return d;
}

// Kinds 0, 1, …: extents 4, 1, 1/4, …; `each` of them, mixed.
std::vector<Descriptor> kinds(int count, int each) {
  std::mt19937_64 random(1);
  std::vector<Descriptor> segments;
  for (int i = 0; i < count * each; ++i)
    segments.push_back(of_kind(i % count, 4 * std::pow(0.25, i % count), random));
  return segments;
}

// Two boxes a metre apart, a strip of no segment that touches the first, and one that touches none.
struct TwoBoxes {
  Planes planes;
  Segments segments;

  TwoBoxes() {
    add_segment(box_mesh({0, 0, 0}, {4, 4, 4}), planes, segments);
    add_segment(box_mesh({5, 0, 0}, {6, 1, 1}), planes, segments);
    add_loose({{4.2, 2, 1}, {4.2, 3, 1}, {4.2, 3, 2}});
    add_loose({{4, 9, 9}, {5, 9, 9}, {5, 10, 9}});
    add_loose({{6, 1.1, 0}, {6, 1.1, 1}, {7, 1.1, 1}});
  }
  void add_loose(const std::vector<Vec3>& corners) {
    planes.planes.push_back(plane_of_faces({corners, {{0, 1, 2}}}, 0, 1));
    segments.segment_of_plane.push_back(-1);
  }
};

}  // namespace

TEST_CASE("elements of a kind are on one layer, whatever their size") {
  for (const std::uint64_t seed : {1, 2, 3}) {
    std::mt19937_64 random(seed);
    std::vector<Descriptor> segments;
    const auto add = [&](ElementKind kind, int shape, double extent) {
      segments.push_back(of_kind(shape, extent, random));
      segments.back().kind = kind;
    };
    for (const double extent : {0.4, 0.9, 2.5, 4.0, 0.5}) add(ElementKind::kBalcony, 1, extent);
    for (const double extent : {0.3, 1.2, 3.5}) add(ElementKind::kDormer, 2, extent);
    for (int i = 0; i < 12; ++i) add(ElementKind::kPlain, 3, 3.0);   // parts of roofs
    for (int i = 0; i < 20; ++i) add(ElementKind::kPlain, 5, 0.35);  // chimneys
    const Clustering c = cluster_segments(segments, {.seed = seed});
    for (int i = 1; i < 5; ++i) CHECK(c.layer[i] == c.layer[0]);
    for (int i = 6; i < 8; ++i) CHECK(c.layer[i] == c.layer[5]);
    for (int i = 8; i < 20; ++i) CHECK(c.layer[i] == 1);
    for (int i = 20; i < 40; ++i) CHECK(c.layer[i] == 2);
    CHECK(c.kinds.size() >= 4);
    std::size_t members = 0;
    for (const KindFacts& k : c.kinds) members += k.segments;
    CHECK(members == segments.size());
  }
}

TEST_CASE("where a part sits tells kinds of one shape and size apart") {
  std::mt19937_64 random(4);
  std::vector<Descriptor> segments;
  for (int i = 0; i < 24; ++i) {
    segments.push_back(of_kind(1, 0.6, random, 0.005));
    segments.back().context = i % 2 ? Vec3(0.2, 0.9, 1) : Vec3(0, 0, 0.1);  // chimneys and steps
  }
  for (int i = 0; i < 12; ++i) segments.push_back(of_kind(4, 3, random, 0.005));
  const Clustering c = cluster_segments(segments, {.layers = 4});
  for (int i = 2; i < 24; ++i) CHECK(c.layer[i] == c.layer[i % 2]);
  CHECK(c.layer[0] != c.layer[1]);
}

TEST_CASE("kinds that differ are told apart and ordered by size") {
  for (const bool is_paper : {false, true})
    for (const int count : {2, 3, 4}) {
      const auto segments = kinds(count, 7);
      const Clustering c = cluster_segments(
          segments,
          {.rules = is_paper ? RuleSet::none() : RuleSet::all(), .layers = count + 1, .eta = 20});
      for (std::size_t i = 0; i < segments.size(); ++i)
        CHECK(c.layer[i] == 1 + static_cast<int>(i) % count);
      CHECK(c.warnings.empty());
      CHECK(c.eigenvalues[0] == Approx(0).margin(1e-9));
      CHECK(std::is_sorted(c.eigenvalues.begin(), c.eigenvalues.end()));
    }
}

TEST_CASE("where layers end hardly hangs on how large kinds come out") {
  // Median extents of the kinds of 20 made-up houses, of which each house less moves some by a few
  // per cent. Two steps of their sizes are about equal, from 2.03 to 0.91 and from 0.72 to 0.46:
  // which is the larger one must not decide where the three kinds between them belong.
  constexpr std::array kSizes{2.03, 0.91, 0.79, 0.72, 0.46, 0.40, 0.40, 0.35};
  for (const int each : {3, 10, 30}) {
    std::mt19937_64 random(1);
    for (int draw = 0; draw < 50; ++draw) {
      std::vector<Descriptor> segments;
      std::vector<int> kind;
      for (int k = 0; k < std::ssize(kSizes); ++k) {
        const double size = of_kind(0, kSizes[k], random, 0.06).extent;
        for (int i = 0; i < each; ++i)
          segments.push_back(of_kind(0, size, random, 0)), kind.push_back(k);
      }
      const std::vector<int> classes = classes_of_kinds(segments, kind, 2);
      for (std::size_t i = 0; i < segments.size(); ++i) CHECK(classes[i] == (kind[i] >= 2));
    }
  }
}

TEST_CASE("no layer is without a kind, however sizes lie") {
  for (const std::vector<double>& sizes :
       {std::vector<double>{8, 0.3, 0.29, 0.28}, {3, 2.9, 2.8, 0.1}, {1, 1, 1, 1}}) {
    std::mt19937_64 random(1);
    std::vector<Descriptor> segments;
    for (std::size_t i = 0; i < 10 * sizes.size(); ++i)
      segments.push_back(
          of_kind(static_cast<int>(i % sizes.size()), sizes[i % sizes.size()], random));
    const Clustering c = cluster_segments(segments, {.layers = 4, .eta = 20});
    for (const int layer : {1, 2, 3})
      CHECK(std::find(c.layer.begin(), c.layer.end(), layer) != c.layer.end());
  }
}

TEST_CASE("Lanczos and the full solver agree on many segments") {
  const auto segments = kinds(3, 150);  // more than the full solver takes
  const Clustering many = cluster_segments(segments, {.layers = 4, .eta = 20});
  for (std::size_t i = 0; i < segments.size(); ++i)
    CHECK(many.layer[i] == 1 + static_cast<int>(i) % 3);
  CHECK(many.eigenvalues.size() >= 10);
}

TEST_CASE("beyond the dense limit nearest neighbours keep the kinds") {
  const auto segments = kinds(2, 1600);
  const Clustering c = cluster_segments(segments, {.layers = 3, .eta = 4});
  int wrong = 0;
  for (std::size_t i = 0; i < segments.size(); ++i)
    wrong += c.layer[i] != 1 + static_cast<int>(i) % 2;
  CHECK(wrong == 0);
}

TEST_CASE("nearest neighbours: nearly those that comparing all pairs finds, once each") {
  std::mt19937_64 random(5);
  std::vector<Descriptor> segments;
  for (int i = 0; i < 600; ++i) segments.push_back(random_descriptor(i % 6, random));
  const auto near = nearest_neighbours(segments, 20, 4, segment_similarity);
  int found = 0;
  for (int i = 0; i < 600; ++i) {
    std::vector<double> all;
    for (int j = 0; j < 600; ++j)
      if (j != i) all.push_back(segment_similarity(segments[i], segments[j], 4));
    std::sort(all.rbegin(), all.rend());
    REQUIRE(near[i].size() == 20);
    CHECK(std::adjacent_find(near[i].begin(), near[i].end(), std::greater_equal()) ==
          near[i].end());
    for (const int n : near[i]) {
      CHECK(n != i);
      found += segment_similarity(segments[i], segments[n], 4) >= all[19] - 1e-12;
    }
  }
  CHECK(found > 0.7 * 600 * 20);
}

TEST_CASE("nearest neighbours: one, none, all alike, not a number") {
  std::mt19937_64 random(6);
  CHECK(nearest_neighbours({}, 5, 4, kind_similarity).empty());
  std::vector<Descriptor> segments(1, of_kind(1, 2, random));
  CHECK(nearest_neighbours(segments, 5, 4, kind_similarity)[0].empty());
  segments.assign(300, segments[0]);
  segments[7].eigenvalues[1] = std::numeric_limits<double>::quiet_NaN();
  const auto near = nearest_neighbours(segments, 5, 4, kind_similarity);
  CHECK(near[8].size() == 5);
}

TEST_CASE("adding segments of known kinds moves no other") {
  std::vector<Descriptor> segments = kinds(4, 10);
  const std::vector<int> before = cluster_segments(segments).layer;
  std::mt19937_64 random(7);
  for (int i = 0; i < 8; ++i) segments.push_back(of_kind(i % 4, 4 * std::pow(0.25, i % 4), random));
  const std::vector<int> after = cluster_segments(segments).layer;
  CHECK(std::equal(before.begin(), before.end(), after.begin()));
  for (int i = 0; i < 8; ++i) CHECK(after[40 + i] == before[i]);
}

TEST_CASE("by size: one absolute threshold a layer") {
  std::mt19937_64 random(1);
  std::vector<Descriptor> segments;
  for (const double extent : {2.0, 0.9, 0.7, 0.1}) segments.push_back(of_kind(0, extent, random));
  CHECK(cluster_segments(segments, {.layering = Layering::kSize, .layers = 3}).layer ==
        std::vector<int>{1, 1, 2, 2});
  CHECK(cluster_segments(segments, {.layering = Layering::kSize, .layers = 4}).layer ==
        std::vector<int>{1, 2, 2, 3});
}

TEST_CASE("none, one, fewer than clusters, identical, flat only, no extent") {
  std::mt19937_64 random(1);
  CHECK(cluster_segments({}).layer.empty());
  const Descriptor big = of_kind(0, 3, random), small = of_kind(1, 0.2, random);
  CHECK(cluster_segments({big}).layer == std::vector<int>{1});
  CHECK(cluster_segments({small}).layer == std::vector<int>{2});
  CHECK(cluster_segments({big, small}, {.layers = 1}).layer == std::vector<int>{0, 0});
  CHECK(cluster_segments({big, small}, {.layers = 2}).layer == std::vector<int>{1, 1});
  CHECK(cluster_segments({big, small}, {.layers = 5}).layer[0] == 1);
  CHECK(cluster_segments({big, small}, {.layers = 6}).layer[0] == 1);
  CHECK(cluster_segments(std::vector<Descriptor>(9, small)).layer == std::vector<int>(9, 2));
  Descriptor nothing;
  nothing.is_flat = true;
  CHECK(cluster_segments({nothing, nothing, nothing}).layer == std::vector<int>{2, 2, 2});
  nothing.eigenvalues[0] = std::numeric_limits<double>::quiet_NaN();
  CHECK(cluster_segments({nothing, big, small}, {.rules = RuleSet::none()}).layer.size() == 3);
}

TEST_CASE("layers stay within 1 and l_n − 1, whatever the numbers") {
  std::mt19937_64 random(8);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<Descriptor> segments;
    for (int i = 0; i < 12; ++i) {
      segments.push_back(of_kind(static_cast<int>(random() % 8), 0.1 + random() % 5, random, 1));
      segments.back().is_flat = random() % 3 == 0;
    }
    const ClusteringOptions options{.rules = trial % 2 == 0 ? RuleSet::none() : RuleSet::all(),
                                    .layers = 2 + trial % 4};
    for (const int layer : cluster_segments(segments, options).layer) {
      CHECK(layer >= 1);
      CHECK(layer < options.layers);
    }
  }
}

TEST_CASE("a permutation of the segments permutes the layers; threads change nothing") {
  const auto segments = kinds(3, 8);
  const auto layer = cluster_segments(segments, {.layers = 4, .eta = 20}).layer;
  std::vector<Descriptor> reversed(segments.rbegin(), segments.rend());
  auto back = cluster_segments(reversed, {.layers = 4, .eta = 20}).layer;
  std::reverse(back.begin(), back.end());
  CHECK(back == layer);
  limit_threads(1);
  const Clustering one = cluster_segments(kinds(3, 150), {.seed = 5});
  limit_threads(0);
  const Clustering all = cluster_segments(kinds(3, 150), {.seed = 5});
  CHECK(one.layer == all.layer);
  CHECK(one.eigenvalues == all.eigenvalues);
}

TEST_CASE("a layer's planes: its segments' and the loose ones that touch them") {
  const TwoBoxes t;
  const std::vector<int> layer{0, 1};
  std::vector<int> first(12), both(24);
  for (int i = 0; i < 24; ++i) (i < 12 ? first[i] = i : 0), both[i] = i;
  first.push_back(24);
  both.insert(both.end(), {24, 26});
  CHECK(layer_planes(t.planes, t.segments, layer, 0) == first);
  CHECK(layer_planes(t.planes, t.segments, layer, 1) == both);
  CHECK(layer_planes(t.planes, t.segments, layer, 9) == both);
  CHECK(layer_planes(t.planes, t.segments, {1, 2}, 0).empty());
}

TEST_CASE("a roof of a relief has its walls, of whatever segment, and no others") {
  // A slab on layer 0, of which another segment on layer 2 has a wall, and a block upon it.
  Planes planes;
  Segments segments;
  add_segment(box_mesh({0, 0, 0}, {8, 8, 4}), planes, segments, 1, 2);
  add_segment(box_mesh({2, 2, 4}, {4, 4, 6}), planes, segments, 1, 2);
  const auto wall = std::find_if(planes.planes.begin(), planes.planes.end(),
                                 [](const Plane& p) { return p.normal.x() > 0.9; });
  const int moved = static_cast<int>(wall - planes.planes.begin());
  std::erase(segments.segments[0].planes, moved);
  segments.segments[1].planes.push_back(moved);
  segments.segment_of_plane[moved] = 1;
  const auto planes_at = [&](int k) { return layer_planes(planes, segments, {0, 2}, k); };
  CHECK(planes_at(0).size() == 5);
  planes.plane_of_item = {kAround, 0};
  const std::vector<int> coarse = planes_at(0);
  CHECK(coarse.size() == 6);
  CHECK(std::count(coarse.begin(), coarse.end(), moved) == 1);
  CHECK(planes_at(2).size() == 12);
}

TEST_CASE("a roof over a tenth of a relief's plan is on each layer, with its walls") {
  for (const double side : {1.0, 5.0}) {  // of a block on the finest layer, upon 10 × 10 m
    Planes planes;
    Segments segments;
    add_segment(box_mesh({0, 0, 0}, {10, 10, 4}), planes, segments, 1, 2);
    add_segment(box_mesh({2, 2, 4}, {2 + side, 2 + side, 6}), planes, segments, 1, 2);
    const auto planes_at = [&](int k) { return layer_planes(planes, segments, {0, 2}, k); };
    CHECK(planes_at(0).size() == 6);
    planes.plane_of_item = {kAround, 0};
    CHECK(planes_at(0).size() == (side > 4 ? 11u : 6u));  // its roof and four walls; no underside
    CHECK(planes_at(2).size() == 12);
  }
}

TEST_CASE("touching reaches as far as twice the planes' distance, and through crossings") {
  TwoBoxes t;
  t.planes.distance = 3;
  CHECK(layer_planes(t.planes, t.segments, {0, 1}, 0).size() == 12 + 2);
  TwoBoxes crossed;  // a blade whose corners are all far from the wall it cuts
  crossed.add_loose({{-5, 2, 2.01}, {9, 2, 2}, {-5, 2, 2.02}});
  const auto planes = layer_planes(crossed.planes, crossed.segments, {0, 1}, 0);
  CHECK(planes.back() == 27);
}

TEST_CASE("robust: the smallest planes of layer 0 wait for the finest layer") {
  Planes planes;
  Segments segments;
  const auto add = [&](double area, int segment) {
    Plane p;
    p.area = area;
    p.outline.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    p.outline.triangles = {{0, 1, 2}};
    if (segment >= 0) segments.segments[segment].planes.push_back(int(planes.planes.size()));
    planes.planes.push_back(p);
  };
  segments.segments.resize(2);
  for (const double area : {60.0, 37.0, 2.0, 1.0}) add(area, 0);
  for (const double area : {1.5, 0.5}) add(area, 1);
  for (const double area : {2.5, 1.9}) add(area, -1);
  const std::vector<int> layer{0, 1};
  const auto at = [&](int k) {
    return layer_planes(planes, segments, layer, k, {RuleSet::all(), 3});
  };
  CHECK(at(0).size() == 6);  // so few that none has to
  for (int i = 0; i < 9; ++i) add(60, 0);
  const auto at_large = [&](int k) {
    std::vector<int> result = at(k);
    CHECK(std::count_if(result.begin(), result.end(), [](int p) { return p >= 8; }) == 9);
    std::erase_if(result, [](int p) { return p >= 8; });
    return result;
  };
  CHECK(at_large(0) == std::vector<int>{0, 1, 6});
  CHECK(at_large(1) == std::vector<int>{0, 1, 4, 5, 6});
  CHECK(at_large(2).size() == 8);
  CHECK(layer_planes(planes, segments, layer, 0).size() == 6 + 9);  // the paper's
  CHECK(layer_planes(planes, segments, {0, 0}, 0, {RuleSet::all(), 1}).size() == 8 + 9);
  add(10, 0);  // small enough with the others, but not by itself
  CHECK(at(0).back() == 17);
}

TEST_CASE("spares are the larger planes that layer 0 lacks, a set a plain segment") {
  Planes planes;
  Segments segments;
  segments.segments.resize(4);
  const auto add = [&](double area, int segment) {
    Plane p;
    p.area = area;
    if (segment >= 0) segments.segments[segment].planes.push_back(int(planes.planes.size()));
    segments.segment_of_plane.push_back(segment);
    planes.planes.push_back(p);
  };
  for (const double area : {50.0, 20.0, 5.0}) add(area, 0);  // the last one waits
  for (const double area : {8.0, 0.3, 6.0}) add(area, 1);
  add(4, 2), add(0.9, 3), add(5.8, -1);
  segments.segments[2].kind = ElementKind::kBay;
  const auto spares = spare_planes(planes, segments, {0, 1, 1, 2}, {0, 1});
  CHECK(spares == std::vector<std::vector<int>>{{3, 5}, {2, 8}});
  CHECK(spare_planes(planes, segments, {0, 1, 1, 2}, {0, 1, 2, 3, 5, 8}).empty());
}

TEST_CASE("the planes of a layer are among those of the next") {
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 10; ++trial) {
    Planes planes;
    Segments segments;
    std::vector<int> layer;
    const auto at = [&] { return static_cast<double>(random() % 60) / 10; };
    for (int i = 0; i < 12; ++i) {
      const Vec3 corner(at(), at(), at());
      if (i % 3 == 0) {
        planes.planes.push_back(plane_of_faces(
            {{corner, corner + Vec3(1, 0, 0), corner + Vec3(0, 1, 0)}, {{0, 1, 2}}}, 0, 1));
        segments.segment_of_plane.push_back(-1);
      } else {
        add_segment(box_mesh(corner, corner + Vec3(1, 1, 1)), planes, segments);
        layer.push_back(static_cast<int>(random() % 3));
      }
    }
    for (int k = 0; k < 6; ++k) {
      const LayerPlanesOptions options{k < 3 ? RuleSet::none() : RuleSet::all(), 4};
      const auto a = layer_planes(planes, segments, layer, k % 3, options);
      const auto b = layer_planes(planes, segments, layer, k % 3 + 1, options);
      CHECK(std::is_sorted(a.begin(), a.end()));
      CHECK(std::includes(b.begin(), b.end(), a.begin(), a.end()));
    }
  }
}
