#include "segments/segments.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>
#include <random>

#include "core/parallel.h"
#include "meshes.h"
#include "segments/aggregation.h"
#include "segments/assignment.h"
#include "segments/rules.h"
#include "segments_helpers.h"

using namespace colod;
using namespace colod::test;
using Names = std::set<std::string>;

namespace {

SegmentOptions coarse(bool is_paper = false, int ns = 32) {
  SegmentOptions options;
  options.rules = is_paper ? RuleSet::none() : RuleSet::all();
  options.visibility.ns = ns;
  options.visibility.nr = 72;
  return options;
}

Segments segments_of(const NamedPlanes& scene, const SegmentOptions& options = coarse()) {
  return build_segments(as_planes(scene.planes), options);
}

/// What holds for every result.
void check_invariants(const Planes& planes, const Segments& s) {
  REQUIRE(!s.segments.empty());
  REQUIRE(s.segment_of_plane.size() == planes.planes.size());
  std::vector<int> of_plane(planes.planes.size(), -1);
  for (std::size_t i = 0; i < s.segments.size(); ++i) {
    const Segment& segment = s.segments[i];
    REQUIRE(!segment.planes.empty());
    REQUIRE(std::is_sorted(segment.planes.begin(), segment.planes.end()));
    if (i > 0) REQUIRE(segment.volume <= s.segments[i - 1].volume);
    double area = 0;
    for (int p : segment.planes) {
      REQUIRE(of_plane[p] == -1);
      of_plane[p] = static_cast<int>(i);
      area += planes.planes[p].area;
    }
    REQUIRE(segment.area == Approx(area));
  }
  REQUIRE(of_plane == s.segment_of_plane);
  double sum = 0;
  for (const Coverage& c : s.coverage) {
    REQUIRE(std::is_sorted(c.segments.begin(), c.segments.end()));
    REQUIRE((c.segments.empty() || c.segments.back() < static_cast<int>(s.segments.size())));
    REQUIRE(c.share > 0);
    sum += c.share;
  }
  REQUIRE(sum == Approx(1));
}

std::vector<int> merged_row(const std::vector<VoxelHits>& row, MergeRule rule) {
  const HitGrid grid = row_grid(static_cast<int>(row.size()), row);
  const VoxelGroups groups = merge_groups(grid, group_voxels(grid), rule);
  return {groups.group_of_voxel.begin(),
          groups.group_of_voxel.begin() + static_cast<std::ptrdiff_t>(row.size())};
}

}  // namespace

TEST_CASE("voxels that see the same planes start as one group, wherever they lie") {
  const HitGrid grid = row_grid(5, {{{0, 9}, {1, 1}}, {{2, 5}}, {{0, 1}, {1, 9}}, {}, {{0, 3}}});
  const VoxelGroups g = group_voxels(grid);
  REQUIRE(g.groups.size() == 3);
  REQUIRE(std::vector<int>(g.group_of_voxel.begin(), g.group_of_voxel.begin() + 5) ==
          std::vector<int>{0, 1, 0, -1, 2});
  REQUIRE(g.groups[0].voxels == 2);
  REQUIRE(g.groups[0].total == 20);
  REQUIRE(g.groups[0].hits[0].hits == 10);
  REQUIRE(adjacent_groups(grid, g) == std::vector<GroupPair>{{0, 1}});
}

TEST_CASE("overlaps by both rules") {
  const auto group = [](std::vector<PlaneHits> hits) {
    VoxelGroup g{std::move(hits), 0, 1};
    for (const PlaneHits& h : g.hits) g.total += h.hits;
    return g;
  };
  const VoxelGroup a = group({{0, 60}, {1, 40}}), b = group({{0, 2}, {2, 8}}),
                   c = group({{0, 6}, {1, 4}});
  REQUIRE(group_overlap(a, b, MergeRule::kHistogram) == Approx(0.2));
  REQUIRE(group_overlap(b, a, MergeRule::kHistogram) == Approx(0.2));
  REQUIRE(group_overlap(a, b, MergeRule::kMembership) == Approx(0.2));  // 60 of 100, but 2 of 10
  REQUIRE(group_overlap(a, c, MergeRule::kHistogram) == Approx(1));
  const VoxelGroup stray = group({{0, 1}, {1, 1}, {2, 98}}), walls = group({{1, 50}, {2, 50}});
  REQUIRE(group_overlap(stray, walls, MergeRule::kMembership) == Approx(0.99));
  REQUIRE(group_overlap(stray, walls, MergeRule::kHistogram) == Approx(0.51));
}

TEST_CASE("one stray hit joins groups by the paper's rule, not by the histogram") {
  // Between a room of planes 0, 1 and one of planes 2, 3, each sees one ray of the other.
  const std::vector<VoxelHits> row = {{{0, 50}, {1, 48}, {2, 1}, {3, 1}},
                                      {{0, 1}, {1, 1}, {2, 50}, {3, 48}}};
  REQUIRE(merged_row(row, MergeRule::kMembership) == std::vector<int>{0, 0});
  REQUIRE(merged_row(row, MergeRule::kHistogram) == std::vector<int>{0, 0});  // one plane set
  std::vector<VoxelHits> other = row;
  other[0][4] = 1, other[1][5] = 1;
  REQUIRE(merged_row(other, MergeRule::kMembership) == std::vector<int>{0, 0});
  REQUIRE(merged_row(other, MergeRule::kHistogram) == std::vector<int>{0, 1});
}

TEST_CASE("only face neighbours merge, and the condition is strict") {
  const std::vector<VoxelHits> apart = {{{0, 10}}, {}, {{0, 9}, {1, 1}}};
  REQUIRE(merged_row(apart, MergeRule::kHistogram) == std::vector<int>{0, -1, 1});
  const std::vector<VoxelHits> half = {{{0, 10}, {1, 10}}, {{1, 10}, {2, 10}}};
  REQUIRE(merged_row(half, MergeRule::kHistogram) == std::vector<int>{0, 1});
  REQUIRE(merged_row(half, MergeRule::kMembership) == std::vector<int>{0, 1});
}

TEST_CASE("the best pair merges first") {
  // 1 could go with 0 (0.55) or 2 (0.9); with 2 first, the pair is too unlike 0.
  const std::vector<VoxelHits> row = {
      {{0, 45}, {1, 55}}, {{1, 55}, {2, 45}, {3, 1}}, {{1, 45}, {2, 55}}};
  REQUIRE(merged_row(row, MergeRule::kHistogram) == std::vector<int>{0, 1, 1});
}

TEST_CASE("the partition does not depend on the groups' numbers") {
  std::mt19937_64 random(7);
  std::vector<VoxelHits> row(12);
  for (VoxelHits& voxel : row)
    for (int k = 0; k < 4; ++k) voxel[static_cast<int>(random() % 6)] += 1 + random() % 1000;
  const HitGrid grid = row_grid(12, row);
  const VoxelGroups groups = group_voxels(grid);
  const VoxelGroups expected = merge_groups(grid, groups, MergeRule::kHistogram);
  std::vector<int> order(groups.groups.size());
  std::iota(order.begin(), order.end(), 0);
  for (int round = 0; round < 20; ++round) {
    std::shuffle(order.begin(), order.end(), random);
    VoxelGroups shuffled = groups;
    for (std::size_t g = 0; g < order.size(); ++g) shuffled.groups[order[g]] = groups.groups[g];
    for (int& g : shuffled.group_of_voxel)
      if (g >= 0) g = order[g];
    const VoxelGroups merged = merge_groups(grid, shuffled, MergeRule::kHistogram);
    for (std::size_t v = 0; v < 12; ++v)
      for (std::size_t w = 0; w < 12; ++w)
        REQUIRE((merged.group_of_voxel[v] == merged.group_of_voxel[w]) ==
                (expected.group_of_voxel[v] == expected.group_of_voxel[w]));
  }
}

TEST_CASE("groups that are not kept join their best neighbour, reaching over each other") {
  const HitGrid grid =
      row_grid(6, {{{0, 9}}, {{0, 5}, {1, 4}}, {{1, 9}}, {{1, 2}, {2, 7}}, {}, {{1, 8}, {3, 1}}});
  std::vector<int> target;
  VoxelGroups g = join_groups(grid, group_voxels(grid), {1, 0, 0, 1, 0}, false, &target);
  REQUIRE(target == std::vector<int>{0, 0, 1, 1, 2});
  REQUIRE(g.groups[0].voxels == 2);
  g = join_groups(grid, group_voxels(grid), {1, 0, 0, 1, 0}, true, &target);
  REQUIRE(target == std::vector<int>{0, 0, 1, 1, 1});
  g = join_groups(grid, group_voxels(grid), {0, 0, 0, 0, 0}, true, &target);
  REQUIRE(g.groups.size() == 5);
}

TEST_CASE("details that share much of a surface are one, as long as they stay small") {
  const HitGrid grid = row_grid(5, {{{0, 9}}, {{0, 9}}, {{1, 9}}, {{2, 9}}, {{2, 9}}});
  const auto joined = [&](std::int64_t most, double contact) {
    const VoxelGroups g = join_details(grid, group_voxels(grid), most, contact);
    return std::vector<int>(g.group_of_voxel.begin(), g.group_of_voxel.begin() + 5);
  };
  REQUIRE(joined(2, 0) == std::vector<int>{0, 0, 1, 2, 2});
  REQUIRE(joined(3, 0.1) == std::vector<int>{0, 0, 0, 1, 1});  // 1 of 6 faces; the tie by ids
  REQUIRE(joined(5, 0.1) == std::vector<int>{0, 0, 0, 0, 0});
  REQUIRE(joined(5, 0.2) == std::vector<int>{0, 0, 1, 2, 2});
}

TEST_CASE("robust: chimney, bay and recess are segments of their own") {
  const NamedPlanes house = detailed_house();
  const Segments s = segments_of(house);
  check_invariants(as_planes(house.planes), s);
  REQUIRE(mates(house, s, "chimney top") ==
          Names{"chimney front", "chimney back", "chimney left", "chimney right", "chimney top"});
  REQUIRE(mates(house, s, "bay front") ==
          Names{"bay front", "bay left", "bay right", "bay floor", "bay roof"});
  REQUIRE(mates(house, s, "recess back") ==
          Names{"recess back", "recess left", "recess right", "recess floor", "recess ceiling"});
  REQUIRE(mates(house, s, "front") == Names{"front", "back", "left", "right", "floor"});
  REQUIRE(mates(house, s, "roof back") == Names{"roof front", "roof back"});
  for (const Segment& segment : s.segments)
    REQUIRE(segment.is_alcove ==
            (s.segment_of_plane[house.index("recess back")] == &segment - s.segments.data()));
}

TEST_CASE("robust: without alcove area a recess belongs to what is behind it") {
  const NamedPlanes house = detailed_house();
  SegmentOptions options = coarse();
  options.alcove_area = 0;
  const Segments s = segments_of(house, options);
  check_invariants(as_planes(house.planes), s);
  REQUIRE(mates(house, s, "recess back").count("front") == 1);
}

TEST_CASE("paper: Algorithm 1 takes the recess in its first pass and overlaps what it leaves") {
  const NamedPlanes house = detailed_house();
  const Segments s = segments_of(house, coarse(true));
  check_invariants(as_planes(house.planes), s);
  const int recess = s.segment_of_plane[house.index("recess back")];
  REQUIRE(recess >= 0);
  REQUIRE(s.segments[recess].is_alcove);
  REQUIRE(mates(house, s, "recess back").count("recess left") == 1);
  REQUIRE(mates(house, s, "recess back").count("recess right") == 1);
  REQUIRE(s.segment_of_plane[house.index("floor")] == -1);  // horizontal: no hits, no segment
}

TEST_CASE("paper: without alcove area nothing is turned and nothing is an alcove") {
  const NamedPlanes house = detailed_house();
  SegmentOptions options = coarse(true);
  options.alcove_area = 0;
  const Segments s = segments_of(house, options);
  check_invariants(as_planes(house.planes), s);
  for (const Segment& segment : s.segments) REQUIRE(!segment.is_alcove);
  for (const Coverage& c : s.coverage) REQUIRE(c.segments.size() == 1);
}

TEST_CASE("the order of the planes and a mirror change nothing") {
  const NamedPlanes house = detailed_house();
  const auto expected = partition_of(house, segments_of(house));
  REQUIRE(partition_of(mirrored(house), segments_of(mirrored(house))) == expected);
  std::mt19937_64 random(3);
  std::vector<int> order(house.planes.size());
  std::iota(order.begin(), order.end(), 0);
  for (int round = 0; round < 3; ++round) {
    std::shuffle(order.begin(), order.end(), random);
    const NamedPlanes other = permuted(house, order);
    REQUIRE(partition_of(other, segments_of(other)) == expected);
  }
}

TEST_CASE("one and several threads give the same segments") {
  for (bool is_paper : {false, true}) {
    const NamedPlanes house = detailed_house();
    limit_threads(1);
    const Segments one = segments_of(house, coarse(is_paper));
    limit_threads(4);
    const Segments four = segments_of(house, coarse(is_paper));
    limit_threads(0);
    REQUIRE(one.segment_of_plane == four.segment_of_plane);
    REQUIRE(one.coverage.size() == four.coverage.size());
    for (std::size_t i = 0; i < one.coverage.size(); ++i) {
      REQUIRE(one.coverage[i].segments == four.coverage[i].segments);
      REQUIRE(one.coverage[i].share == four.coverage[i].share);
    }
    for (std::size_t i = 0; i < one.segments.size(); ++i)
      REQUIRE(one.segments[i].volume == four.segments[i].volume);
  }
}

TEST_CASE("a box is one segment with all its sides") {
  const Planes box = as_planes(box_planes({0, 0, 0}, {10, 8, 6}));
  const Segments s = build_segments(box, coarse(false, 16));
  check_invariants(box, s);
  REQUIRE(s.segments.size() == 1);
  REQUIRE(s.segments[0].planes.size() == 6);
  REQUIRE(s.segments[0].volume == Approx(480).epsilon(0.01));
}

TEST_CASE("where nothing is enclosed all planes are one segment, with a warning") {
  for (bool is_paper : {false, true}) {
    Planes bare = as_planes({wall_y(0, 10, 0, 6, 0)});
    bare.planes[0].outline = {};
    const Planes sheet = as_planes({slab(0, 10, 0, 6, 0)});
    const Planes open = as_planes({slab(0, 10, 0, 8, 0), slab(0, 9, 0, 8, 4)});
    for (const Planes& planes : {bare, sheet, open}) {
      SegmentOptions options = coarse(is_paper, 12);
      options.alcove_area = 0;
      const Segments s = build_segments(planes, options);
      check_invariants(planes, s);
      REQUIRE(s.segments.size() == 1);
      REQUIRE(s.segments[0].planes.size() == planes.planes.size());
      REQUIRE(!s.warnings.empty());
    }
  }
}

TEST_CASE("a lone wall is a segment") {
  const Planes wall = as_planes({wall_y(0, 10, 0, 6, 0)});
  for (bool is_paper : {false, true}) {
    const Segments s = build_segments(wall, coarse(is_paper, 12));
    check_invariants(wall, s);
    REQUIRE(s.segments.size() == 1);
  }
}

TEST_CASE("two buildings in one box stay apart") {
  const Planes two =
      as_planes(join(box_planes({0, 0, 0}, {4, 4, 4}), box_planes({10, 0, 0}, {14, 4, 4})));
  const Segments s = build_segments(two, coarse(false, 28));
  check_invariants(two, s);
  REQUIRE(s.segments.size() == 2);
  REQUIRE(s.segment_of_plane[0] != s.segment_of_plane[6]);
  for (const int own : {0, 1})  // nobody but its own segment holds a building's volume
    CHECK(std::any_of(s.coverage.begin(), s.coverage.end(), [&](const Coverage& c) {
      return c.segments == std::vector<int>{own} && c.share > 0.35;
    }));
}

TEST_CASE("an alcove needs three planes, two that face and two that cross") {
  const Planes planes =
      as_planes({wall_x(0, 2, 0, 2, 0, false), wall_x(0, 2, 0, 2, 2), wall_y(0, 2, 0, 2, 2),
                 wall_y(4, 6, 0, 2, 0), wall_y(6, 8, 0, 2, 0), slab(4, 8, 0, 2, 0)});
  const auto guard = [&](const std::vector<int>& claimed) {
    return guard_alcoves(planes, claimed, 2);
  };
  REQUIRE(guard({0, 0, 0, -1, -1, -1}) == std::vector<int>{0, 0, 0, -1, -1, -1});
  REQUIRE(guard({0, 0, -1, 1, 1, 1}) == std::vector<int>{-1, -1, -1, -1, -1, -1});
  REQUIRE(guard({-1, 0, 0, 1, 1, 0}) == std::vector<int>{-1, -1, -1, -1, -1, -1});
}

TEST_CASE("coverage counts voxels of two grids by who encloses them") {
  HitGrid a = row_grid(4, {{{0, 1}}, {{0, 1}}, {}, {}}), c = a;
  c.box = Box{Vec3(1, 0, 0), Vec3(3, 2, 2)};  // voxels of half the size
  c.is_valid.assign(64, 1);
  VoxelGroups of_a, of_c;
  of_a.group_of_voxel.assign(64, -1), of_c.group_of_voxel.assign(64, 0);
  of_a.group_of_voxel[0] = of_a.group_of_voxel[1] = 0;
  const std::vector<Coverage> coverage = overlay_coverage(a, of_a, 0, c, of_c, 1);
  REQUIRE(coverage.size() == 3);
  REQUIRE(coverage[0].segments == std::vector<int>{0});
  REQUIRE(coverage[0].share == 1);
  REQUIRE(coverage[1].segments == std::vector<int>{0, 1});
  REQUIRE(coverage[1].share == 1);
  REQUIRE(coverage[2].segments == std::vector<int>{1});
  REQUIRE(coverage[2].share == 7);
}
