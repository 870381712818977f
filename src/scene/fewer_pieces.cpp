// Based on: Douglas & Peucker, 1973; constrained Delaunay triangulation (CGAL), whose domains are
// told apart by how many borders lie around them.
// Differs: what is narrower than the tolerance may close.
#include "fewer_pieces.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>

#include "core/flat.h"
#include "cutter.h"

namespace colod {

namespace {

using PlanKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using PlanCdt = CGAL::Constrained_Delaunay_triangulation_2<PlanKernel, CGAL::Default,
                                                           CGAL::Exact_predicates_tag>;
using PlanRing = std::vector<Vec2>;
using Corner2 = std::array<double, 2>;

Corner2 key_of(const Vec2& p) { return {p.x(), p.y()}; }

/// Around all that pieces cover together.
std::vector<PlanRing> rings_about(const std::vector<Territories::Piece>& pieces) {
  std::map<std::array<Corner2, 2>, int> border;
  for (const Territories::Piece& piece : pieces)
    for (std::size_t k = 0; k < 3; ++k) {
      const Corner2 a = key_of(piece.corners[k]), b = key_of(piece.corners[(k + 1) % 3]);
      if (border.erase({b, a}) == 0) border[{a, b}] = 0;
    }
  std::vector<PlanRing> rings;
  while (!border.empty()) {
    PlanRing ring;
    const Corner2 start = border.begin()->first[0];
    for (auto edge = border.begin(); edge != border.end();) {
      const auto [from, to] = edge->first;
      ring.emplace_back(from[0], from[1]);
      border.erase(edge);
      edge = to == start ? border.end() : border.lower_bound({to, Corner2{-INFINITY, -INFINITY}});
      if (edge != border.end() && edge->first[0] != to) edge = border.end();  // it does not close
    }
    rings.push_back(std::move(ring));
  }
  return rings;
}

/// A ring without corners that lie no farther from it than that; fewer than three: nothing.
PlanRing straightened(const PlanRing& ring, double tolerance) {
  const auto at = [&](int i) { return ring[static_cast<std::size_t>(i) % ring.size()]; };
  const auto distance = [&](int i, int a, int b) {
    const Vec2 along = at(b) - at(a), off = at(i) - at(a);
    const double length = along.norm();
    if (length == 0) return off.norm();
    const double t = std::clamp(off.dot(along) / (length * length), 0.0, 1.0);
    return (off - t * along).norm();
  };
  int far = 0;
  for (int i = 1; i < static_cast<int>(ring.size()); ++i)
    if ((at(i) - at(0)).norm() > (at(far) - at(0)).norm()) far = i;
  std::vector<int> kept = {0};
  for (const auto& [from, to] : {std::array{0, far}, {far, static_cast<int>(ring.size())}}) {
    for (const int i : corners_between(from, to, tolerance, distance)) kept.push_back(i);
    if (to == far) kept.push_back(far);
  }
  PlanRing out;
  for (const int i : kept) out.push_back(at(i));
  return out.size() < 3 ? PlanRing{} : out;
}

/// Whether a face lies within an odd number of borders.
std::map<PlanCdt::Face_handle, bool> insides(const PlanCdt& cdt) {
  std::map<PlanCdt::Face_handle, bool> is_inside = {{cdt.infinite_face(), false}};
  std::deque<PlanCdt::Face_handle> open = {cdt.infinite_face()};
  while (!open.empty()) {
    const PlanCdt::Face_handle face = open.front();
    open.pop_front();
    for (int k = 0; k < 3; ++k) {
      const PlanCdt::Face_handle beside = face->neighbor(k);
      const bool is_border = cdt.is_constrained({face, k});
      if (is_inside.try_emplace(beside, is_inside[face] != is_border).second)
        open.push_back(beside);
    }
  }
  return is_inside;
}

}  // namespace

std::vector<Territories::Piece> fewer_pieces(const std::vector<Territories::Piece>& pieces,
                                             double tolerance) {
  PlanCdt cdt;
  const auto point = [](const Vec2& p) { return PlanKernel::Point_2(p.x(), p.y()); };
  for (const PlanRing& ring : rings_about(pieces)) {
    const PlanRing straight = straightened(ring, tolerance);
    for (std::size_t i = 0; i < straight.size(); ++i)
      cdt.insert_constraint(point(straight[i]), point(straight[(i + 1) % straight.size()]));
  }
  std::vector<Territories::Piece> out;
  if (cdt.dimension() < 2) return out;
  const auto is_inside = insides(cdt);
  for (const PlanCdt::Face_handle face : cdt.finite_face_handles()) {
    if (!is_inside.at(face)) continue;
    Territories::Piece piece{{}, pieces.front().building};
    for (int k = 0; k < 3; ++k)
      piece.corners[static_cast<std::size_t>(k)] = {face->vertex(k)->point().x(),
                                                    face->vertex(k)->point().y()};
    const auto& c = piece.corners;
    if (cross(c[1] - c[0], c[2] - c[0]) >= 2 * kLeastFace) out.push_back(piece);
  }
  return out;
}

}  // namespace colod
