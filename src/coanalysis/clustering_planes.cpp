// Based on: Co-LOD section 3.2: a layer is formed by the planes of segments up to it, with adjacent
// planes that belong to no segment.
//
// Differs: both rules: "adjacent" is not said in the paper: here, outlines nearer than 0.3 m or
// twice the distance of region growing, whichever is more. One hop: a plane of no segment that
// touches only such planes stays out. --rules robust: a canopy, a window's reveal, a step that no
// voxel tells from the body lies in the body's segment, and would be detail on layer 0; so the
// smallest planes of layer 0's segments, 3 % of their area and none over 1 %, wait for the finest
// layer, and planes of no segment that are as small with them.
//
// Notation: p plane of no segment, q plane of a segment of the layer.
#include <algorithm>
#include <cassert>
#include <cmath>

#include "clustering.h"
#include "parameters.h"

namespace colod {
namespace {

using namespace parameters::coanalysis;

constexpr double kLeastTouch = 0.3;  // metres
constexpr double kUpright = 0.01;    // |z| of a wall's normal, at most
constexpr double kOnRoof = 0.02;     // metres between a wall's end and the roof that it hangs from
constexpr double kLeastHang = 0.1;   // metres that it hangs, half of its height

struct Piece {
  Vec3 a, b, c;
};

Vec3 nearest_on_segment(const Vec3& a, const Vec3& b, const Vec3& x) {
  const Vec3 d = b - a;
  const double length = d.squaredNorm();
  const double t = length > 0 ? std::clamp(d.dot(x - a) / length, 0.0, 1.0) : 0.0;
  return a + t * d;
}

double point_segment(const Vec3& x, const Vec3& a, const Vec3& b) {
  return (x - nearest_on_segment(a, b, x)).norm();
}

// Inside the triangle's prism the distance to its plane, else to its border.
double point_triangle(const Vec3& x, const Piece& t) {
  const Vec3 n = (t.b - t.a).cross(t.c - t.a);
  const double length = n.norm();
  if (length > 0 && (t.b - t.a).cross(x - t.a).dot(n) >= 0 &&
      (t.c - t.b).cross(x - t.b).dot(n) >= 0 && (t.a - t.c).cross(x - t.c).dot(n) >= 0)
    return std::abs((x - t.a).dot(n)) / length;
  return std::min(
      {point_segment(x, t.a, t.b), point_segment(x, t.b, t.c), point_segment(x, t.c, t.a)});
}

// Alternating projection between two lines converges in one step to the lines' nearest points;
// clamping and projecting back makes it exact for segments (Ericson, "Real-time collision
// detection", 2004, section 5.1.9).
double segment_segment(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = d - c, w = a - c;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v);
  const double denominator = uu * vv - uv * uv;
  double s = 0;
  if (denominator > 1e-12 * uu * vv)
    s = std::clamp((uv * v.dot(w) - vv * u.dot(w)) / denominator, 0.0, 1.0);
  const Vec3 on_second = nearest_on_segment(c, d, a + s * u);
  const double inner = (on_second - nearest_on_segment(a, b, on_second)).norm();
  return std::min({inner, point_segment(a, c, d), point_segment(b, c, d), point_segment(c, a, b),
                   point_segment(d, a, b)});
}

bool is_crossing(const Vec3& a, const Vec3& b, const Piece& t) {
  const Vec3 n = (t.b - t.a).cross(t.c - t.a);
  const double da = n.dot(a - t.a), db = n.dot(b - t.a);
  if (!(da * db < 0)) return false;
  return point_triangle(a + da / (da - db) * (b - a), t) < 1e-6;
}

bool is_near(const Piece& s, const Piece& t, double reach) {
  const std::array<Vec3, 3> p{s.a, s.b, s.c}, q{t.a, t.b, t.c};
  for (int i = 0; i < 3; ++i) {
    if (point_triangle(p[i], t) <= reach || point_triangle(q[i], s) <= reach) return true;
    if (is_crossing(p[i], p[(i + 1) % 3], t) || is_crossing(q[i], q[(i + 1) % 3], s)) return true;
    for (int j = 0; j < 3; ++j)
      if (segment_segment(p[i], p[(i + 1) % 3], q[j], q[(j + 1) % 3]) <= reach) return true;
  }
  return false;
}

Box grown(Box box, double by) {
  if (!box.is_empty()) box.min.array() -= by, box.max.array() += by;
  return box;
}

bool is_overlapping(const Box& a, const Box& b) {
  return (a.min.array() <= b.max.array()).all() && (b.min.array() <= a.max.array()).all();
}

Box box_of(const Piece& t) {
  Box box;
  box.extend(t.a), box.extend(t.b), box.extend(t.c);
  return box;
}

// The outline's triangles that reach into a box.
std::vector<Piece> pieces_in(const Outline& outline, const Box& box) {
  std::vector<Piece> pieces;
  for (const Face& f : outline.triangles) {
    const Piece t{outline.vertices[f[0]], outline.vertices[f[1]], outline.vertices[f[2]]};
    if (is_overlapping(box_of(t), box)) pieces.push_back(t);
  }
  return pieces;
}

bool is_touching(const Outline& p, const Box& p_box, const Outline& q, const Box& q_box,
                 double reach) {
  if (!is_overlapping(grown(p_box, reach), q_box)) return false;
  const std::vector<Piece> ps = pieces_in(p, grown(q_box, reach));
  const std::vector<Piece> qs = pieces_in(q, grown(p_box, reach));
  for (const Piece& s : ps) {
    const Box near = grown(box_of(s), reach);
    for (const Piece& t : qs)
      if (is_overlapping(near, box_of(t)) && is_near(s, t, reach)) return true;
  }
  return false;
}

double sane_area(const Plane& plane) {
  return std::isfinite(plane.area) && plane.area > 0 ? plane.area : 0;
}

// The largest area that still counts as small; −1: none does. Equal planes are all small or none.
double small_area(const Planes& planes, const Segments& segments,
                  const std::vector<int>& layer_of_segment) {
  std::vector<double> areas;
  double total = 0;
  for (std::size_t s = 0; s < segments.segments.size(); ++s)
    for (const int p : segments.segments[s].planes)
      if (layer_of_segment[s] == 0)
        areas.push_back(sane_area(planes.planes[p])), total += areas.back();
  double small = -1, sum = 0;
  if (areas.size() <= kFewPlanes) return small;
  std::sort(areas.begin(), areas.end());
  for (std::size_t i = 0; i < areas.size(); ++i) {
    sum += areas[i];
    if (sum > kSmallPlanes * total || areas[i] > kSmallPlane * total) break;
    if (i + 1 == areas.size() || areas[i + 1] > areas[i]) small = areas[i];
  }
  return small;
}

// Read as a relief (relief/relief.h): its ground was parted from its roofs and walls.
bool is_relief(const Planes& planes) {
  return std::find(planes.plane_of_item.begin(), planes.plane_of_item.end(), kAround) !=
         planes.plane_of_item.end();
}

// A wall that ends in the roof above it.
bool hangs_from(const Plane& wall, const Plane& roof) {
  if (std::abs(wall.normal.z()) > kUpright || roof.normal.z() <= kUpright) return false;
  const auto above = [&](const Vec3& v) { return roof.normal.dot(v) - roof.offset; };
  if (above(wall.centroid) > -kLeastHang) return false;
  const Box around = grown(bounding_box(roof.outline.vertices), kOnRoof);
  return std::count_if(
             wall.outline.vertices.begin(), wall.outline.vertices.end(), [&](const Vec3& v) {
               return std::abs(above(v)) < kOnRoof && (v.array() >= around.min.array()).all() &&
                      (v.array() <= around.max.array()).all();
             }) >= 2;
}

// Roofs of a relief have all their walls: without one they would end where another plane passes.
void add_hanging_walls(const Planes& planes, std::vector<char>& is_in) {
  if (!is_relief(planes)) return;
  const std::vector<char> before = is_in;
  for (std::size_t p = 0; p < is_in.size(); ++p)
    for (std::size_t q = 0; q < before.size() && !is_in[p]; ++q)
      is_in[p] = before[q] && hangs_from(planes.planes[p], planes.planes[q]);
}

// Roofs of a relief that cover much of the plan are on each layer: what has no plane of its own
// there is covered by a neighbour's, run on over yards and wings.
void add_large_roofs(const Planes& planes, std::vector<char>& is_in) {
  if (!is_relief(planes)) return;
  std::vector<double> covered;
  double total = 0;
  for (const Plane& p : planes.planes) {
    covered.push_back(p.normal.z() > kUpright ? p.normal.z() * sane_area(p) : 0);
    total += covered.back();
  }
  for (std::size_t p = 0; p < is_in.size(); ++p)
    if (covered[p] > kRoofShare * total) is_in[p] = 1;
}

}  // namespace

std::vector<int> layer_planes(const Planes& planes, const Segments& segments,
                              const std::vector<int>& layer_of_segment, int k,
                              const LayerPlanesOptions& options) {
  assert(layer_of_segment.size() == segments.segments.size());
  const std::size_t n = planes.planes.size();
  const bool is_coarse = options.rules.has(Rule::kSmallPlanes) && k < options.layers - 1;
  const double small = is_coarse ? small_area(planes, segments, layer_of_segment) : -1;
  std::vector<char> is_in(n, 0), is_out(n, 0);  // out: whatever it touches
  for (std::size_t p = 0; p < n; ++p) is_out[p] = sane_area(planes.planes[p]) <= small;
  for (std::size_t s = 0; s < segments.segments.size(); ++s)
    for (const int p : segments.segments[s].planes) {
      is_in[p] = layer_of_segment[s] <= k && !(layer_of_segment[s] == 0 && is_out[p]);
      is_out[p] = 1;
    }
  add_large_roofs(planes, is_in);
  add_hanging_walls(planes, is_in);

  std::vector<Box> boxes;
  for (const Plane& p : planes.planes) boxes.push_back(bounding_box(p.outline.vertices));
  const double reach = std::max(kLeastTouch, 2 * planes.distance);
  std::vector<int> result;
  for (std::size_t p = 0; p < n; ++p) {
    bool is_wanted = is_in[p];
    for (std::size_t q = 0; q < n && !is_out[p] && !is_wanted; ++q)
      is_wanted = is_in[q] && is_touching(planes.planes[p].outline, boxes[p],
                                          planes.planes[q].outline, boxes[q], reach);
    if (is_wanted) result.push_back(static_cast<int>(p));
  }
  return result;
}

std::vector<std::vector<int>> spare_planes(const Planes& planes, const Segments& segments,
                                           const std::vector<int>& layer_of_segment,
                                           const std::vector<int>& layer0_planes) {
  const std::size_t none = segments.segments.size();
  std::vector<std::vector<int>> spares(none + 1);
  std::vector<double> area(spares.size(), 0);
  std::vector<char> is_in(planes.planes.size(), 0);
  for (const int p : layer0_planes) is_in[p] = 1;
  double total = 0;
  for (const Plane& p : planes.planes) total += sane_area(p);
  for (std::size_t p = 0; p < planes.planes.size(); ++p) {
    const double own = sane_area(planes.planes[p]);
    if (is_in[p] || own < kSpareShare * total) continue;
    const int s = segments.segment_of_plane[p];
    if (s >= 0 && segments.segments[s].kind != ElementKind::kPlain) continue;
    const std::size_t set = s < 0 || layer_of_segment[s] == 0 ? none : s;
    spares[set].push_back(static_cast<int>(p)), area[set] += own;
  }
  std::vector<std::vector<int>> result;
  for (std::size_t set = 0; set < spares.size(); ++set)
    if (!spares[set].empty() && area[set] >= kSparesShare * total)
      result.push_back(std::move(spares[set]));
  return result;
}

}  // namespace colod
