// The sweep against Embree and against brute force, where they could disagree.
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "core/parallel.h"
#include "read/frame.h"
#include "read/read.h"
#include "visibility/parts.h"
#include "visibility/visibility.h"
#include "visibility_helpers.h"

using namespace colod;
using namespace colod::test;

namespace {

HitGrid cast(const Planes& planes, int ns, int nr, Visibility engine = Visibility::kSweep) {
  return cast_visibility(planes, {.engine = engine, .ns = ns, .nr = nr});
}

bool is_same(const HitGrid& a, const HitGrid& b) {
  return a.first == b.first && a.is_valid == b.is_valid &&
         std::equal(a.hits.begin(), a.hits.end(), b.hits.begin(), b.hits.end(),
                    [](const Hit& h, const Hit& i) {
                      return h.plane == i.plane && h.inside == i.inside && h.outside == i.outside;
                    });
}

void expect_as_embree(const Planes& planes, int ns, int nr) {
  const HitGrid sweep = cast(planes, ns, nr);
  CHECK(is_same(sweep, cast(planes, ns, nr, Visibility::kEmbree)));
  CHECK(sweep.rays == static_cast<std::uint64_t>(ns) * ns * ns * nr);
}

/// Hits of kept voxels that landed elsewhere, at least.
std::uint64_t differing(const HitGrid& a, const HitGrid& b) {
  std::uint64_t sum = 0;
  for (std::size_t v = 0; v < a.is_valid.size(); ++v) {
    std::vector<int> more(2 * 4096, 0);
    for (const Hit& h : a.at(v)) more[2 * h.plane] += h.inside, more[2 * h.plane + 1] += h.outside;
    for (const Hit& h : b.at(v)) more[2 * h.plane] -= h.inside, more[2 * h.plane + 1] -= h.outside;
    for (const int m : more) sum += static_cast<std::uint64_t>(std::max(0, m));
  }
  return sum;
}

/// The first plane of a ray and its side as 2 × plane + inside, in doubles over the very triangles;
/// −1 nothing.
int brute_first(const casting::Job& job, const Vec3& o, const casting::Direction& d) {
  const Vec3 ray(static_cast<float>(d.x), static_cast<float>(d.y), 0);
  double best = std::numeric_limits<double>::infinity();
  int found = -1;
  for (std::size_t t = 0; t < job.soup.plane_of_triangle.size(); ++t) {
    Vec3 c[3];
    for (int i = 0; i < 3; ++i) {
      const auto& corner = job.soup.corners[3 * t + static_cast<std::size_t>(i)];
      c[i] = Vec3(corner[0], corner[1], corner[2]) - o;
    }
    // The ray passes between the edges when its volumes with all three have one sign.
    double least = 1e300, most = -1e300;
    for (int i = 0; i < 3; ++i) {
      const double volume = c[i].cross(c[(i + 1) % 3]).dot(ray);
      least = std::min(least, volume), most = std::max(most, volume);
    }
    const Vec3 normal = (c[1] - c[0]).cross(c[2] - c[0]);
    const double distance = normal.dot(c[0]) / normal.dot(ray);
    if ((least < 0 && most > 0) || !(distance >= 0 && distance < best)) continue;
    best = distance;
    found = 2 * job.soup.plane_of_triangle[t] +
            d.is_inside(job.normal[static_cast<std::size_t>(job.soup.plane_of_triangle[t])]);
  }
  return found;
}

/// Rays of kept voxels whose first plane is another one than brute force finds.
int wrong_rays(const Planes& planes, const HitGrid& g, std::size_t step) {
  const casting::Job job = casting::make_job(planes, {.ns = g.ns, .nr = g.nr}, {}, {}, g.box);
  int wrong = 0;
  for (std::size_t v = 0; v < g.is_valid.size(); v += step) {
    const Vec3 o = (g.center(v) - job.center).cast<float>().cast<double>();
    std::vector<int> hits(2 * planes.planes.size(), 0);
    int in = 0, out = 0;
    for (int k = 0; k < g.nr; ++k)
      if (const int found = brute_first(job, o, casting::direction(k, g.nr)); found >= 0)
        ++hits[static_cast<std::size_t>(found)], ++(found % 2 == 1 ? in : out);
    CHECK(bool(g.is_valid[v]) == job.rule.is_valid(in, out));
    if (!job.rule.is_kept(in, out)) continue;
    for (const Hit& h : g.at(v)) hits[2 * h.plane + 1] -= h.inside, hits[2 * h.plane] -= h.outside;
    for (const int h : hits) wrong += std::max(0, h);
  }
  return wrong;
}

}  // namespace

TEST_CASE("the sweep sees what Embree sees: boxes, odd directions, one voxel, one ray") {
  const Planes planes = as_planes(
      join(box_planes({0, 0, 0}, {10, 8, 6}), turned_planes(box_planes({2, 3, 1}, {4, 5, 9}))));
  expect_as_embree(planes, 12, 20);
  expect_as_embree(planes, 9, 25);
  expect_as_embree(planes, 1, 7);
  expect_as_embree(planes, 5, 1);
  expect_as_embree(planes, 33, 4);
}

TEST_CASE("the sweep agrees with brute force to the last ray on random planes") {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Planes planes = as_planes(random_planes(70, seed));
    CHECK(wrong_rays(planes, cast(planes, 11, 30), 3) == 0);
    CHECK(differing(cast(planes, 20, 24), cast(planes, 20, 24, Visibility::kEmbree)) <= 1);
  }
}

TEST_CASE("a ray at a time finds what packets find") {
  const Planes planes = as_planes(random_planes(60, 8));
  const HitGrid one = cast(planes, 13, 20, Visibility::kEmbreeSingle);
  CHECK(differing(one, cast(planes, 13, 20, Visibility::kEmbree)) <= 1);
}

TEST_CASE("the larger of coplanar outlines that overlap is met first, whoever casts") {
  auto list = box_planes({0, 0, 0}, {10, 8, 6});
  list.push_back(rectangle_plane({10, 1, 1}, {0, 4, 0}, {0, 0, 4}));
  list.push_back(rectangle_plane({10, 3, 2}, {0, 4, 0}, {0, 0, 3}));
  list.push_back(list[1]);
  const Planes planes = as_planes(list);
  const HitGrid g = cast(planes, 15, 36);
  CHECK(is_same(g, cast(planes, 15, 36, Visibility::kEmbree)));
  CHECK(is_same(g, cast(planes, 15, 36, Visibility::kEmbreeSingle)));
  for (const Hit& h : g.hits) REQUIRE(h.plane < 6);
}

TEST_CASE("segments that end on rays leave no gap") {
  // Walls of many pieces whose ends lie on the rays of the middle row and column.
  std::vector<Plane> list;
  for (int i = 0; i < 9; ++i) {
    list.push_back(rectangle_plane({9, i * 1.0, 0}, {0, 1, 0}, {0, 0, 5}));
    list.push_back(rectangle_plane({i + 1.0, 9, 0}, {-1, 0, 0}, {0, 0, 5}));
  }
  const Planes planes = as_planes(join(list, box_planes({0, 0, 0}, {9, 9, 5})));
  const HitGrid g = cast(planes, 9, 40);
  CHECK(std::count(g.is_valid.begin(), g.is_valid.end(), 1) == 9 * 9 * 9);
  for (std::size_t v = 0; v < g.is_valid.size(); ++v) {
    int hits = 0;
    for (const Hit& h : g.at(v)) hits += h.inside + h.outside;
    REQUIRE(hits == 40);
  }
}

TEST_CASE("levels in a slice, slices without outlines, walls along the rays, a sliver of a roof") {
  auto list = join(box_planes({0, 0, 0}, {6, 5, 2}), box_planes({1, 1, 7}, {4, 4, 9}));
  list.push_back(rectangle_plane({0, 0, 1}, {6, 0, 0}, {0, 5, 0}));
  list.push_back(rectangle_plane({0, 2, 0}, {6, 0, 0}, {0, 0, 2}));
  list.push_back(rectangle_plane({0, 0, 1.01}, {6, 0, 1e-4}, {0, 5, 0}));
  const Planes planes = as_planes(list);
  expect_as_embree(planes, 18, 8);
  CHECK(wrong_rays(planes, cast(planes, 18, 8), 7) == 0);
}

TEST_CASE("reversed planes and planes left out are the same to the sweep") {
  const Planes planes = as_planes(random_planes(40, 5));
  std::vector<char> is_active(40, 1), is_reversed(40, 0);
  for (int i = 0; i < 40; i += 3) is_active[i] = 0, is_reversed[i + 1 < 40 ? i + 1 : 0] = 1;
  VisibilityOptions o{.engine = Visibility::kSweep, .ns = 12, .nr = 30};
  const HitGrid sweep = cast_visibility(planes, o, is_active, is_reversed);
  o.engine = Visibility::kEmbree;
  CHECK(differing(sweep, cast_visibility(planes, o, is_active, is_reversed)) <= 1);
  o.engine = Visibility::kSweep;
  CHECK(cast_visibility(planes, o, std::vector<char>(40, 0)).hits.empty());
  CHECK(cast_visibility(Planes(), o).hits.empty());
}

TEST_CASE("the sweep gives the same bytes with one and two threads, and in several bands") {
  const Planes planes = as_planes(random_planes(50, 4));
  limit_threads(1);
  const HitGrid one = cast(planes, 40, 900);  // more codes than a task may hold
  limit_threads(2);
  const HitGrid two = cast(planes, 40, 900);
  limit_threads(0);
  CHECK(is_same(one, two));
  CHECK(differing(one, cast(planes, 40, 900, Visibility::kEmbree)) <= one.rays / 1000000);
}

TEST_CASE("the sweep, Embree and brute force agree on every building of the assets") {
  for (const char* name : {"neighbourhood", "neighbourhood-clean"}) {
    const std::filesystem::path folder = std::filesystem::path(COLOD_SOURCE_DIR) / "assets" / name;
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      if (entry.path().extension() == ".ply" || entry.path().extension() == ".obj")
        files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    REQUIRE(!files.empty());
    for (const auto& file : files) {
      INFO(file.string());
      const Source read = read_single(file.string());
      const Planes planes = detect_planes(localize(read, main_frame(read)));
      const HitGrid sweep = cast(planes, 24, 50);
      CHECK(differing(sweep, cast(planes, 24, 50, Visibility::kEmbree)) <= sweep.rays / 100000);
      CHECK(wrong_rays(planes, sweep, 97) == 0);
    }
  }
}
