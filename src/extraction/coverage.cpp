// Based on: the clipping of I. Sutherland and G. Hodgman, "Reentrant polygon clipping",
// Communications of the ACM 17(1), 1974.
// Differs: robust rules only.
// Notation: none.
#include "coverage.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/flat.h"
#include "core/parallel.h"

namespace colod {
namespace {

/// Area of a triangle inside a convex counter-clockwise polygon.
double clipped_area(const std::vector<Vec2>& convex, const std::array<Vec2, 3>& triangle) {
  std::vector<Vec2> poly(triangle.begin(), triangle.end()), next;
  for (std::size_t i = 0; i < convex.size() && poly.size() > 2; ++i) {
    const Vec2 a = convex[i], d = convex[(i + 1) % convex.size()] - a;
    next.clear();
    for (std::size_t j = 0; j < poly.size(); ++j) {
      const Vec2 &p = poly[j], &q = poly[(j + 1) % poly.size()];
      const double sp = cross(d, p - a), sq = cross(d, q - a);
      if (sp >= 0) next.push_back(p);
      if ((sp < 0) != (sq < 0)) next.push_back(p + sp / (sp - sq) * (q - p));
    }
    poly.swap(next);
  }
  double sum = 0;
  for (std::size_t j = 1; j + 1 < poly.size(); ++j)
    sum += cross(poly[j] - poly[0], poly[j + 1] - poly[0]);
  return 0.5 * std::abs(sum);
}

/// One outline in the coordinates of an integer plane.
struct FlatOutline {
  std::vector<std::array<Vec2, 3>> triangles;
  bool is_reversed;
};

}  // namespace

void measure_coverage(const Partition& partition, const Planes& planes,
                      const std::vector<int>& input, Evidence& evidence) {
  std::vector<std::array<Vec3, 2>> basis;
  for (const auto& plane : partition.planes)
    basis.push_back(
        plane_basis(Vec3(plane.normal[0], plane.normal[1], plane.normal[2]).normalized()));
  const auto flat = [&](int plane, const Vec3& p) {
    return Vec2(basis[plane][0].dot(p), basis[plane][1].dot(p));
  };
  std::vector<std::vector<FlatOutline>> outlines(partition.planes.size());
  for (std::size_t i = 0; i < input.size(); ++i) {
    const Partition::Cut& cut = partition.cuts[i];
    if (input[i] < 0 || cut.plane < 0) continue;
    const Outline& outline = planes.planes[input[i]].outline;
    outlines[cut.plane].push_back({{}, cut.is_reversed});
    for (const Face& f : outline.triangles)
      outlines[cut.plane].back().triangles.push_back({flat(cut.plane, outline.vertices[f[0]]),
                                                      flat(cut.plane, outline.vertices[f[1]]),
                                                      flat(cut.plane, outline.vertices[f[2]])});
  }
  parallel_for(
      partition.pieces.size(),
      [&](std::size_t p) {
        const Partition::Piece& piece = partition.pieces[p];
        if (outlines[piece.plane].empty() || evidence.area[p] <= 0) return;
        std::vector<Vec2> polygon;
        for (const int v : piece.polygon) polygon.push_back(flat(piece.plane, partition.points[v]));
        Eigen::AlignedBox2d box;
        for (const Vec2& q : polygon) box.extend(q);
        for (const FlatOutline& outline : outlines[piece.plane]) {
          double sum = 0;
          for (const auto& t : outline.triangles) {
            Eigen::AlignedBox2d other;
            for (const Vec2& q : t) other.extend(q);
            if (box.intersects(other)) sum += clipped_area(polygon, t);
          }
          double& share = (outline.is_reversed ? evidence.reversed : evidence.coverage)[p];
          share = std::min(1.0, share + sum / evidence.area[p]);
        }
      },
      64);
}

double explained_share(const Partition& partition, const Evidence& evidence,
                       const std::vector<char>& is_inside) {
  double total = 0, on_surface = 0;
  const auto inside = [&](int cell) { return cell >= 0 && is_inside[cell]; };
  for (std::size_t p = 0; p < partition.pieces.size(); ++p) {
    const auto [behind, before] = partition.pieces[p].cells;
    total += evidence.area[p] * (evidence.coverage[p] + evidence.reversed[p]);
    if (inside(behind) && !inside(before)) on_surface += evidence.area[p] * evidence.coverage[p];
    if (!inside(behind) && inside(before)) on_surface += evidence.area[p] * evidence.reversed[p];
  }
  return total > 0 ? on_surface / total : 0;
}

}  // namespace colod
