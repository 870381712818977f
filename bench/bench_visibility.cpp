// How fast the engines of room `visibility` are, and whether they see the same.
//
//   bench_visibility FILE [--ns N] [--nr N] [--threads N] [--repeat N] [--no-single] [--segments]
//   [--json]
//
// Casts the rays of one building with Embree one ray at a time, with Embree's packets and with the
// sweep, in turns, and takes the shortest of each: wall seconds, and processor seconds of all
// threads, which tell more on a busy machine. A differing hit is a ray of a voxel that packets and
// sweep attribute to different planes or sides. It grazes when in doubles the ray passes an edge of
// an outline, or two outlines where they cross, nearer than kGraze, and those very planes are what
// the engines disagree on.
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "core/error.h"
#include "core/parallel.h"
#include "read/frame.h"
#include "read/read.h"
#include "segments/segments.h"
#include "visibility/parts.h"
#include "visibility/visibility.h"

using namespace colod;

namespace {

/// Of the box's radius: what single precision leaves open after a few operations.
constexpr double kGraze = 0x1p-19;
constexpr int kNothing = -1;

struct Settings {
  std::string file;
  VisibilityOptions options{.ns = 150, .nr = 100};
  int threads = 0, repeat = 1;
  bool is_json = false, is_without_single = false, has_segments = false;
};

struct Timing {
  double wall = 1e300, processor = 1e300;
};

HitGrid cast(const Planes& planes, VisibilityOptions options, Visibility engine, Timing& best) {
  options.engine = engine;
  const std::clock_t start = std::clock();
  HitGrid grid = cast_visibility(planes, options);
  const double processor = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  best.wall = std::min(best.wall, grid.seconds);
  best.processor = std::min(best.processor, processor);
  return grid;
}

/// By 2 × plane + (seen from inside): how many more rays one grid's voxel has than the other's.
using Difference = std::map<int, int>;

Difference difference(const HitGrid& a, const HitGrid& b, std::size_t v) {
  Difference d;
  for (const Hit& h : a.at(v)) d[2 * h.plane + 1] += h.inside, d[2 * h.plane] += h.outside;
  for (const Hit& h : b.at(v)) d[2 * h.plane + 1] -= h.inside, d[2 * h.plane] -= h.outside;
  std::erase_if(d, [](const auto& entry) { return entry.second == 0; });
  return d;
}

/// How far the line o + t d passes from the edge a b.
double edge_distance(const Vec3& o, const Vec3& d, const Vec3& a, const Vec3& b) {
  // Seen along d the line is a point.
  const auto flat = [&](const Vec3& p) -> Vec3 { return (p - o) - (p - o).dot(d) * d; };
  const Vec3 p = flat(a), q = flat(b);
  const double length = (q - p).squaredNorm();
  const double t = length > 0 ? std::clamp(-p.dot(q - p) / length, 0.0, 1.0) : 0;
  return (p + t * (q - p)).norm();
}

/// A triangle before a ray.
struct Contact {
  double distance, doubt;  ///< doubt: what the distance may be off by
  int plane;
  bool is_grazing;
};

std::vector<Contact> contacts(const casting::Job& job, const Vec3& o, const Vec3& d, double near) {
  std::vector<Contact> found;
  for (std::size_t t = 0; t < job.soup.plane_of_triangle.size(); ++t) {
    Vec3 c[3];
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& p = job.soup.corners[3 * t + i];
      c[i] = Vec3(p[0], p[1], p[2]);
    }
    if (std::min({c[0].z(), c[1].z(), c[2].z()}) > o.z() + near ||
        std::max({c[0].z(), c[1].z(), c[2].z()}) < o.z() - near)
      continue;
    double edge = 1e300, least = 1e300, most = -1e300;
    for (int i = 0; i < 3; ++i) {
      const Vec3 &a = c[i], &b = c[(i + 1) % 3];
      edge = std::min(edge, edge_distance(o, d, a, b));
      const double volume = (a - o).cross(b - o).dot(d);
      least = std::min(least, volume), most = std::max(most, volume);
    }
    if (least < 0 && most > 0 && edge > near) continue;
    const Vec3 normal = (c[1] - c[0]).cross(c[2] - c[0]).normalized();
    const double across = std::abs(normal.dot(d));
    const double distance = across > 0 ? normal.dot(c[0] - o) / normal.dot(d) : 0;
    const double doubt = near / std::max(across, 1e-9);
    if (distance < -doubt) continue;
    found.push_back({distance, doubt, job.soup.plane_of_triangle[t], edge <= near});
  }
  return found;
}

/// The planes that rounding may choose from for a ray; one where there is no doubt.
std::set<int> possible_planes(const casting::Job& job, const Vec3& o, const Vec3& d, double near) {
  const std::vector<Contact> all = contacts(job, o, d, near);
  double bound = 1e300;
  for (const Contact& c : all)
    if (!c.is_grazing) bound = std::min(bound, c.distance + c.doubt);
  std::set<int> planes;
  for (const Contact& c : all)
    if (c.distance - c.doubt <= bound) planes.insert(c.plane);
  if (bound == 1e300) planes.insert(kNothing);
  return planes;
}

struct Comparison {
  std::uint64_t kept = 0, differing = 0, grazing = 0, differing_valid = 0;
};

/// How many of a voxel's differing hits rays in doubt account for.
std::uint64_t count_grazing(const casting::Job& job, const HitGrid& g, std::size_t v,
                            const Difference& d, double near) {
  const Vec3 o = (g.center(v) - job.center).cast<float>().cast<double>();
  std::uint64_t count = 0;
  for (int k = 0; k < g.nr; ++k) {
    const casting::Direction dir = casting::direction(k, g.nr);
    const auto planes = possible_planes(job, o, Vec3(dir.x, dir.y, 0).normalized(), near);
    const auto is_disputed = [&](const auto& entry) { return planes.count(entry.first / 2) > 0; };
    count += planes.size() > 1 && std::any_of(d.begin(), d.end(), is_disputed);
  }
  return count;
}

Comparison compare(const Planes& planes, const VisibilityOptions& options, const HitGrid& a,
                   const HitGrid& b) {
  const casting::Job job = casting::make_job(planes, options, {}, {}, a.box);
  const double near = kGraze * 0.5 * a.box.diagonal();
  Comparison c;
  for (std::size_t v = 0; v < a.is_valid.size(); ++v) {
    c.differing_valid += a.is_valid[v] != b.is_valid[v];
    c.kept += !a.at(v).empty();
    const Difference d = difference(a, b, v);
    if (d.empty()) continue;
    std::uint64_t more = 0, fewer = 0;
    for (const auto& [side, rays] : d) (rays > 0 ? more : fewer) += std::abs(rays);
    // Hits of a voxel that only one engine keeps are not all different; at least one is.
    const bool is_both = !a.at(v).empty() && !b.at(v).empty();
    const std::uint64_t differing = is_both ? std::max(more, fewer) : 1;
    c.differing += differing;
    c.grazing += std::min(differing, count_grazing(job, a, v, d, near));
  }
  return c;
}

bool has_same_segments(const Planes& planes, const VisibilityOptions& options) {
  SegmentOptions o{.visibility = options};
  o.visibility.engine = Visibility::kEmbree;
  const Segments a = build_segments(planes, o);
  o.visibility.engine = Visibility::kSweep;
  const Segments b = build_segments(planes, o);
  bool is_same = a.segment_of_plane == b.segment_of_plane &&
                 a.segments.size() == b.segments.size() && a.coverage.size() == b.coverage.size();
  for (std::size_t s = 0; is_same && s < a.segments.size(); ++s)
    is_same = a.segments[s].planes == b.segments[s].planes &&
              a.segments[s].is_alcove == b.segments[s].is_alcove;
  return is_same;
}

nlohmann::ordered_json measure(const Settings& settings) {
  const Source read = read_single(settings.file);
  const Planes planes = detect_planes(localize(read, main_frame(read)));
  Timing single, packet, sweep;
  HitGrid a, b;
  for (int i = 0; i < settings.repeat; ++i) {
    b = cast(planes, settings.options, Visibility::kSweep, sweep);
    a = cast(planes, settings.options, Visibility::kEmbree, packet);
    if (!settings.is_without_single)
      cast(planes, settings.options, Visibility::kEmbreeSingle, single);
  }
  const Comparison c = compare(planes, settings.options, a, b);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::size_t triangles = 0;
  for (const Plane& p : planes.planes) triangles += p.outline.triangles.size();
  nlohmann::ordered_json out;
  out["file"] = std::filesystem::path(settings.file).filename().string();
  out["ns"] = a.ns, out["nr"] = a.nr, out["threads"] = thread_count();
  out["planes"] = planes.planes.size(), out["triangles"] = triangles;
  out["rays"] = b.rays, out["rays_embree"] = a.rays;
  if (!settings.is_without_single) {
    out["embree_one_s"] = single.wall, out["embree_one_cpu_s"] = single.processor;
  }
  out["embree_packet_s"] = packet.wall, out["embree_packet_cpu_s"] = packet.processor;
  out["sweep_s"] = sweep.wall, out["sweep_cpu_s"] = sweep.processor;
  out["hits"] = b.hits.size(), out["kept_rays"] = c.kept * static_cast<std::uint64_t>(a.nr);
  out["differing_hits"] = c.differing, out["grazing_hits"] = c.grazing;
  out["differing_valid"] = c.differing_valid;
  if (settings.has_segments) out["has_same_segments"] = has_same_segments(planes, settings.options);
  out["peak_memory_bytes"] = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  CLI::App app("How fast the engines of visibility are, and whether they see the same");
  app.add_option("file", settings.file)->required();
  app.add_option("--ns", settings.options.ns, "voxels a side")->check(CLI::Range(1, 1000));
  app.add_option("--nr", settings.options.nr, "rays a voxel")->check(CLI::Range(1, 1000));
  app.add_option("--threads", settings.threads);
  app.add_option("--repeat", settings.repeat)->check(CLI::Range(1, 100));
  app.add_flag("--no-single", settings.is_without_single, "leave out one ray at a time");
  app.add_flag("--segments", settings.has_segments, "are the segments the same as well?");
  app.add_flag("--json", settings.is_json, "one JSON line instead of a table");
  CLI11_PARSE(app, argc, argv);
  limit_threads(settings.threads);
  try {
    const auto result = measure(settings);
    if (settings.is_json)
      std::printf("%s\n", result.dump().c_str());
    else
      for (const auto& [key, value] : result.items())
        std::printf("%-20s %s\n", key.c_str(), value.dump().c_str());
    return 0;
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return static_cast<int>(error.stage);
  }
}
