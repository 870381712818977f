// Based on: nothing published.
// Differs: robust rules only, on the finest layer. A binary labelling cannot keep a sheet without
//   thickness: both its sides are outside. Models that people draw have eaves, canopies, fins and
//   parapets so. Where an outline is far from the surface and seen from outside on both sides, a
//   second plane behind it and planes along its free borders cut the finished partition once more,
//   and the cells between become inside; no other cell changes.
// Notation: x a place on a sheet, n its normal.
#include "sheets.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/flat.h"
#include "core/parallel.h"
#include "core/spread.h"
#include "parameters.h"

namespace colod {
namespace {

using namespace parameters::extraction::sheets;

constexpr double kMostPlaces = 20000;  // on a plane

/// Tells the places of sheets.
class Looker {
 public:
  explicit Looker(const SheetScene& scene)
      : foot_(scene.planes.box.is_empty() ? -kInfinity : scene.planes.box.min.z()),
        far_(std::max(kLeastFar, kFar * scene.tolerance)),
        joined_(std::max(kJoined, 2 * far_)),
        surface_(scene.mesh.mesh()),
        outlines_(scene.rays),
        around_(ring_directions(64, std::array<double, 4>{2, 20, 45, 70})) {
    for (const Vec3& d : ring_directions(32, std::array<double, 2>{-5, -15})) around_.push_back(d);
  }

  /// To the surface.
  bool is_joined(const Vec3& x) const { return is_near(x, joined_); }

  /// Outside, and not on the surface.
  bool is_lost(const Vec3& x, const Vec3& normal) const {
    if (std::abs(normal.z()) > kLevel && x.z() < foot_ + kAboveFoot) return false;
    return !is_near(x, far_) && !surface_.first_hit(x, Vec3(0.36, 0.48, 0.8)).is_inside;
  }

  /// From outside, on both sides.
  bool is_seen(const Vec3& x, const Vec3& normal) const {
    return escapes(x, normal) && escapes(x, -normal);
  }

 private:
  bool is_near(const Vec3& x, double reach) const {
    const NearestPoint nearest = surface_.nearest(x, reach);
    return nearest.triangle >= 0 && nearest.distance < reach;
  }

  bool escapes(const Vec3& x, const Vec3& side) const {
    return std::any_of(around_.begin(), around_.end(), [&](const Vec3& d) {
      return d.dot(side) > 0.05 && !outlines_.is_occluded(x + kLift * side, d, 1e-4, kInfinity);
    });
  }

  double foot_, far_, joined_;  ///< metres
  RayScene surface_;
  const RayScene& outlines_;
  std::vector<Vec3> around_;
};

/// Places spread over a triangle of something of `whole` m², each for an equal part of it.
std::vector<Vec3> places_on(const Vec3& a, const Vec3& b, const Vec3& c, double whole) {
  const double area = 0.5 * (b - a).cross(c - a).norm();
  const double spacing = std::max(kSpacing, std::sqrt(whole / kMostPlaces));
  const int count = std::max(1, static_cast<int>(area / (spacing * spacing)));
  std::vector<Vec3> places;
  for (int k = 1; k <= count; ++k) places.push_back(spread_on_triangle(a, b, c, k));
  if (count == 1) places[0] = (a + b + c) / 3;
  return places;
}

Sheet find_sheet(const Plane& plane, int id, const Looker& looker) {
  Sheet sheet{id, plane.normal, plane.offset, 0, {}, {}};
  const std::vector<Vec3>& v = plane.outline.vertices;
  double seen = 0;
  for (const Face& f : plane.outline.triangles) {
    const std::vector<Vec3> places = places_on(v[f[0]], v[f[1]], v[f[2]], plane.area);
    const double each = 0.5 * (v[f[1]] - v[f[0]]).cross(v[f[2]] - v[f[0]]).norm() /
                        static_cast<double>(places.size());
    for (const Vec3& x : places)
      if (looker.is_lost(x, plane.normal)) {
        sheet.points.push_back(x), sheet.area += each;
        if (looker.is_seen(x, plane.normal)) seen += each;
      }
  }
  if (seen < kLeastSeen * sheet.area) sheet.area = 0;
  return sheet;
}

std::vector<Vec3> simplified(const std::vector<Vec3>& ring) {
  const int n = static_cast<int>(ring.size());
  int opposite = 0;
  for (int i = 1; i < n; ++i)
    if ((ring[i] - ring[0]).squaredNorm() > (ring[opposite] - ring[0]).squaredNorm()) opposite = i;
  const auto distance = [&](int i, int from, int to) {
    const Vec3 &a = ring[from], &b = ring[to % n];
    const double length = (b - a).norm();
    const double t =
        length > 0 ? std::clamp((ring[i] - a).dot(b - a) / (length * length), 0.0, 1.0) : 0.0;
    return (ring[i] - a - t * (b - a)).norm();
  };
  std::vector<Vec3> corners = {ring[0]};
  for (const int i : corners_between(0, opposite, kBend, distance)) corners.push_back(ring[i]);
  corners.push_back(ring[opposite]);
  for (const int i : corners_between(opposite, n, kBend, distance)) corners.push_back(ring[i]);
  return corners;
}

/// The sheet that ends another between two points: it passes both, not along it. Null: none.
const Sheet* sheet_at(const std::vector<Sheet>& sheets, const Planes& planes, const Sheet& own,
                      const Vec3& a, const Vec3& b) {
  const Vec3 out = (b - a).cross(own.normal).normalized();
  for (const Sheet& other : sheets) {
    if (other.plane == own.plane || std::abs(other.normal.dot(out)) < kLeastAcross) continue;
    Box reach = bounding_box(planes.planes[other.plane].outline.vertices);
    reach.min -= Vec3::Constant(2 * kJoined), reach.max += Vec3::Constant(2 * kJoined);
    const auto is_at = [&](const Vec3& x) {
      return std::abs(other.normal.dot(x) - other.offset) < kJoined &&
             (x.array() > reach.min.array()).all() && (x.array() < reach.max.array()).all();
    };
    if (is_at(a) && is_at(b)) return &other;
  }
  return nullptr;
}

/// Ends a slab between two points of its border, there or along what it is joined to.
CutPlane end_of(const Sheet& sheet, const Vec3& a, const Vec3& b, const Sheet* other) {
  const Vec3 along = (b - a).normalized(), out = along.cross(sheet.normal);
  CutPlane end{out, out.dot(a), {}, -1};
  if (other) end = {other->normal, other->offset, {}, other->plane};
  const Vec3 from = a - kJoined * along, to = b + kJoined * along;
  const Vec3 depth = -kThickness * sheet.normal;
  for (const Vec3& x : {from, to, Vec3(to + depth), Vec3(from + depth)})  // moved onto the end
    end.hull.push_back(x + (end.offset - end.normal.dot(x)) / end.normal.dot(out) * out);
  return end;
}

/// Along the borders that neither the surface nor another sheet meets.
void find_ends(const Planes& planes, const Looker& looker, const std::vector<Sheet>& sheets,
               Sheet& sheet) {
  const Outline& outline = planes.planes[sheet.plane].outline;
  for (const std::vector<int>& ids : outline.rings) {
    if (ids.size() < 3) continue;
    std::vector<Vec3> ring;
    for (const int v : ids) ring.push_back(outline.vertices[v]);
    ring = simplified(ring);
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vec3 &a = ring[i], &b = ring[(i + 1) % ring.size()];
      const double length = (b - a).norm();
      if (length < kLeastCut) continue;
      const Vec3 along = (b - a) / length, out = along.cross(sheet.normal);
      const int steps = std::max(2, static_cast<int>(length / kSpacing));
      double low = length, high = 0;
      for (int k = 0; k < steps; ++k) {
        const double t = (k + 0.5) / steps * length;
        const Vec3 x = a + t * along;
        if (!looker.is_lost(x - kInset * out, sheet.normal) || looker.is_joined(x)) continue;
        low = std::min(low, t), high = std::max(high, t);
      }
      if (high - low < kLeastCut / 2) continue;
      const Vec3 from = a + low * along, to = a + high * along;
      sheet.ends.push_back(end_of(sheet, from, to, sheet_at(sheets, planes, sheet, from, to)));
    }
  }
}

/// Between a sheet and the surface that it stands on.
bool is_joint(const Looker& looker, const Sheet& sheet, const Vec3& x) {
  return looker.is_joined(x) &&
         std::any_of(sheet.points.begin(), sheet.points.end(),
                     [&](const Vec3& y) { return (x - y).norm() < 2 * kSpacing; });
}

/// More than half of the piece is.
bool is_under_sheet(const Partition& partition, const Partition::Piece& piece, const Sheet& sheet,
                    const Outline& outline, const Looker& looker) {
  double total = 0, covered = 0;
  const Vec3& a = partition.points[piece.polygon[0]];
  for (std::size_t i = 1; i + 1 < piece.polygon.size(); ++i) {
    const Vec3 &b = partition.points[piece.polygon[i]], &c = partition.points[piece.polygon[i + 1]];
    const double area = 0.5 * (b - a).cross(c - a).norm();
    const std::vector<Vec3> places = places_on(a, b, c, area);
    const double each = area / static_cast<double>(places.size());
    for (const Vec3& x : places) {
      const bool is_sheet = covers(outline, sheet.normal, x) && looker.is_lost(x, sheet.normal);
      total += each;
      if (is_sheet || is_joint(looker, sheet, x)) covered += each;
    }
  }
  return covered > 0.5 * total;
}

}  // namespace

std::vector<Sheet> find_sheets(const SheetScene& scene, const std::vector<int>& layer_planes) {
  const Planes& planes = scene.planes;
  const Looker looker(scene);
  std::vector<Sheet> found(layer_planes.size());
  parallel_for(found.size(), [&](std::size_t i) {
    found[i] = find_sheet(planes.planes[layer_planes[i]], layer_planes[i], looker);
  });
  const double least = std::max(kLeastArea, kLeastShare * planes.total_area);
  std::erase_if(found, [&](const Sheet& s) { return s.area < least; });
  for (Sheet& sheet : found) find_ends(planes, looker, found, sheet);
  return found;
}

void add_slabs(const Planes& planes, const std::vector<Sheet>& sheets, CuttingPlan& plan) {
  const auto add = [&](const CutPlane& cut, int input) {
    plan.planes.push_back(cut);
    plan.input.push_back(input);
  };
  for (const Sheet& s : sheets) {
    const std::vector<Vec3> hull = grown_hull(planes.planes[s.plane], s.points, kJoined + kSpacing);
    add({s.normal, s.offset, hull, s.plane}, s.plane);
    std::vector<Vec3> behind = hull;
    for (Vec3& x : behind) x -= kThickness * s.normal;
    add({-s.normal, kThickness - s.offset, behind, -1}, -1);
  }
  for (const Sheet& s : sheets)
    for (const CutPlane& end : s.ends) add(end, -1);
}

std::vector<char> fill_slabs(const SheetScene& scene, const Partition& partition,
                             const std::vector<Sheet>& sheets, std::size_t first_cut,
                             const std::vector<char>& was_inside) {
  std::vector<char> is_inside(partition.cells.size());
  for (std::size_t c = 0; c < is_inside.size(); ++c) {
    int from = static_cast<int>(c);
    while (from >= static_cast<int>(was_inside.size())) from = partition.cells[from].split_from;
    is_inside[c] = was_inside[from];
  }
  const Looker looker(scene);
  for (std::size_t s = 0; s < sheets.size(); ++s) {
    const Sheet& sheet = sheets[s];
    const Outline& outline = scene.planes.planes[sheet.plane].outline;
    const Partition::Cut& cut = partition.cuts[first_cut + 2 * s];
    if (cut.plane < 0) continue;
    for (const Partition::Piece& piece : partition.pieces) {
      if (piece.plane != cut.plane) continue;
      const int cell = piece.cells[cut.is_reversed ? 1 : 0];
      if (cell >= 0 && !is_inside[cell] &&
          sheet.normal.dot(partition.cells[cell].centroid) > sheet.offset - kThickness)
        is_inside[cell] = is_under_sheet(partition, piece, sheet, outline, looker);
    }
  }
  return is_inside;
}

}  // namespace colod
