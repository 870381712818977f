// Based on: constrained Delaunay triangulation (CGAL).
#include "reunion.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/flat.h"

namespace colod {

namespace {

using UnionKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using UnionVertex = CGAL::Triangulation_vertex_base_with_info_2<int, UnionKernel>;
using UnionData =
    CGAL::Triangulation_data_structure_2<UnionVertex,
                                         CGAL::Constrained_triangulation_face_base_2<UnionKernel>>;
using UnionCdt = CGAL::Constrained_Delaunay_triangulation_2<UnionKernel, UnionData,
                                                            CGAL::No_constraint_intersection_tag>;
using PartTriangles = std::vector<std::array<Vec3, 3>>;

constexpr double kSamePlace = 1e-7;  // metres: nearer points are one, and on an edge
constexpr double kAreaOff = 1e-5;    // m²: what comes out may differ by so much, and …
constexpr double kShareOff = 1e-6;   // … by this share
constexpr double kFlatFace = 1e-9;   // m²: of less it cannot be told where parts lie

/// A face in its own plane, counter-clockwise.
class FacePlane {
 public:
  explicit FacePlane(const std::array<Vec3, 3>& face) {
    const Vec3 ab = face[1] - face[0], ac = face[2] - face[0];
    const Vec3 x = ab.normalized(), y = (ac - ac.dot(x) * x).normalized();
    corners_ = {Vec2(0, 0), Vec2(ab.norm(), 0), Vec2(ac.dot(x), ac.dot(y))};
  }
  Vec2 at(const Vec3& w) const { return w[1] * corners_[1] + w[2] * corners_[2]; }
  bool is_flat() const { return !(cross(corners_[1], corners_[2]) > kFlatFace); }

 private:
  std::array<Vec2, 3> corners_;
};

using DirectedEdges = std::set<std::array<int, 2>>;

/// The parts' corners, each place once, and the border of what they cover.
class FaceUnion {
 public:
  FaceUnion(const FacePlane& plane, const std::vector<FacePart>& parts) : plane_(plane) {
    std::vector<std::vector<int>> numbers;
    for (const FacePart& part : parts) {
      numbers.emplace_back();
      for (const Vec3& w : part) numbers.back().push_back(number(w));
      area_ += area_of(numbers.back());
    }
    for (const std::vector<int>& own : numbers)
      for (std::size_t i = 0; i < own.size(); ++i) add(own[i], own[(i + 1) % own.size()]);
    straighten();
  }

  /// Empty: the border does not close.
  PartTriangles triangles() const {
    UnionCdt cdt;
    std::vector<UnionCdt::Vertex_handle> handles(weights_.size());
    for (const auto& edge : border_)
      for (const int v : edge) {
        auto& handle = handles[static_cast<std::size_t>(v)];
        if (handle != UnionCdt::Vertex_handle()) continue;
        const Vec2& p = place(v);
        handle = cdt.insert(UnionKernel::Point_2(p.x(), p.y()));
        handle->info() = v;
      }
    try {
      for (const auto& [a, b] : border_)
        cdt.insert_constraint(handles[static_cast<std::size_t>(a)],
                              handles[static_cast<std::size_t>(b)]);
    } catch (const UnionCdt::Intersection_of_constraints_exception&) {
      return {};
    }
    return inside(cdt);
  }

 private:
  const Vec2& place(int v) const { return places_[static_cast<std::size_t>(v)]; }

  int number(const Vec3& w) {
    const Vec2 p = plane_.at(w);
    for (std::size_t v = 0; v < places_.size(); ++v)
      if ((places_[v] - p).cwiseAbs().maxCoeff() < kSamePlace) return static_cast<int>(v);
    weights_.push_back(w);
    places_.push_back(p);
    return static_cast<int>(places_.size()) - 1;
  }

  double area_of(const std::vector<int>& polygon) const {
    double sum = 0;
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
      sum +=
          cross(place(polygon[i]) - place(polygon[0]), place(polygon[i + 1]) - place(polygon[0]));
    return sum / 2;
  }

  /// An edge of a part, from corner to corner that lies on it; where another part has it the other
  /// way round it is no border.
  void add(int a, int b) {
    if (a == b) return;
    const Vec2 along = place(b) - place(a);
    const double length = along.norm();
    std::vector<std::pair<double, int>> on = {{0, a}, {length, b}};
    for (int v = 0; v < static_cast<int>(places_.size()); ++v) {
      const Vec2 off = place(v) - place(a);
      const double at = off.dot(along) / length;
      if (v != a && v != b && at > 0 && at < length &&
          std::abs(cross(along, off)) < kSamePlace * length)
        on.emplace_back(at, v);
    }
    std::sort(on.begin(), on.end());
    for (std::size_t i = 0; i + 1 < on.size(); ++i)
      if (border_.erase({on[i + 1].second, on[i].second}) == 0)
        border_.insert({on[i].second, on[i + 1].second});
  }

  /// Corners that are on a straight border go.
  void straighten() {
    for (int v = 0; v < static_cast<int>(places_.size()); ++v) {
      std::vector<int> before, after;
      for (const auto& [a, b] : border_) {
        if (b == v) before.push_back(a);
        if (a == v) after.push_back(b);
      }
      if (before.size() != 1 || after.size() != 1 || before[0] == after[0]) continue;
      const Vec2 along = place(after[0]) - place(before[0]);
      const Vec2 off = place(v) - place(before[0]);
      if (std::abs(cross(along, off)) > kSamePlace * along.norm()) continue;
      if (off.dot(along) < 0 || off.dot(along) > along.squaredNorm()) continue;
      border_.erase({before[0], v}), border_.erase({v, after[0]});
      if (border_.erase({after[0], before[0]}) == 0) border_.insert({before[0], after[0]});
    }
  }

  bool holds(const Vec2& p) const {
    bool is_inside = false;
    for (const auto& [i, j] : border_) {
      const Vec2 &a = place(i), &b = place(j);
      if ((a.y() > p.y()) != (b.y() > p.y()) &&
          p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
        is_inside = !is_inside;
    }
    return is_inside;
  }

  PartTriangles inside(const UnionCdt& cdt) const {
    PartTriangles out;
    double area = 0;
    for (const UnionCdt::Face_handle face : cdt.finite_face_handles()) {
      const std::vector<int> v = {face->vertex(0)->info(), face->vertex(1)->info(),
                                  face->vertex(2)->info()};
      if (!holds((place(v[0]) + place(v[1]) + place(v[2])) / 3)) continue;
      area += area_of(v);
      out.push_back({weights_[static_cast<std::size_t>(v[0])],
                     weights_[static_cast<std::size_t>(v[1])],
                     weights_[static_cast<std::size_t>(v[2])]});
    }
    const bool is_whole = std::abs(area - area_) <= kAreaOff + kShareOff * area_;
    return is_whole ? out : PartTriangles{};
  }

  const FacePlane& plane_;
  std::vector<Vec3> weights_;
  std::vector<Vec2> places_;
  DirectedEdges border_;
  double area_ = 0;
};

PartTriangles fans(const std::vector<FacePart>& parts) {
  PartTriangles out;
  for (const FacePart& part : parts)
    for (std::size_t k = 1; k + 1 < part.size(); ++k)
      out.push_back({part[0], part[k], part[k + 1]});
  return out;
}

}  // namespace

PartTriangles reunite(const std::array<Vec3, 3>& face, const std::vector<FacePart>& parts) {
  const FacePlane plane(face);
  const bool is_triangle = parts.size() == 1 && parts[0].size() == 3;
  if (parts.empty() || is_triangle || plane.is_flat()) return fans(parts);
  const PartTriangles whole = FaceUnion(plane, parts).triangles();
  return whole.empty() ? fans(parts) : whole;
}

}  // namespace colod
