// Based on: refining a triangle soup by constrained Delaunay triangulations in its faces' planes,
// as Zhou, Grinspun, Zorin & Jacobson, "Mesh arrangements for solid geometry", ACM TOG 35(4), 2016.
// Differs: only flagged faces are cut, and what touches them within a millimetre cuts them, too,
// since coordinates are rounded; so the lines are found in doubles, and only the triangulation
// decides exactly.
// Notation: flat: without the coordinate in which the face's normal is longest.
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include "core/flat.h"
#include "core/parallel.h"
#include "hidden_parts.h"

namespace colod::hidden {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Delaunay =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, CGAL::Default, CGAL::Exact_predicates_tag>;
using Corners = std::array<Vec3, 3>;
struct Segment {
  Vec2 a, b;
};

constexpr double kTouch = 0.001;  // metres
// Lines may cross each other, so that pieces grow with their square. The outer walls of furnished
// models have up to 100 lines; hundreds of random triangles that run through each other reach both.
constexpr std::size_t kMostLines = 400;        // of a face …
constexpr std::size_t kMostSquares = 1000000;  // … and the sum of their squares over all faces
constexpr double kSliver = 1e-4;               // metres: pieces narrower than this are rounding

Corners corners(const Mesh& mesh, int face) {
  const Face& f = mesh.faces[face];
  return {mesh.vertices[f[0]], mesh.vertices[f[1]], mesh.vertices[f[2]]};
}

/// Per flagged face the others whose boxes meet its own, rising.
std::vector<std::vector<int>> find_partners(const Mesh& mesh, const std::vector<char>& is_cut) {
  using Box3 = CGAL::Box_intersection_d::Box_with_handle_d<double, 3, const Face*>;
  std::vector<Box3> all, cut;
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    Box b;
    for (const int v : mesh.faces[i]) b.extend(mesh.vertices[v]);
    const Vec3 low = b.min.array() - kTouch, high = b.max.array() + kTouch;
    const Box3 box({low.x(), low.y(), low.z(), high.x(), high.y(), high.z()}, &mesh.faces[i]);
    all.push_back(box);
    if (is_cut[i]) cut.push_back(box);
  }
  std::vector<std::vector<int>> partners(mesh.faces.size());
  CGAL::box_intersection_d(cut.begin(), cut.end(), all.begin(), all.end(),
                           [&](const Box3& a, const Box3& b) {
                             if (a.handle() == b.handle()) return;
                             partners[a.handle() - mesh.faces.data()].push_back(
                                 static_cast<int>(b.handle() - mesh.faces.data()));
                           });
  for (std::vector<int>& p : partners) std::sort(p.begin(), p.end());
  return partners;
}

/// A face seen flat.
class Flat {
 public:
  explicit Flat(const Corners& c)
      : corners_(c), normal_((c[1] - c[0]).cross(c[2] - c[0]).normalized()) {
    normal_.cwiseAbs().maxCoeff(&axis_);
  }

  double height(const Vec3& p) const { return normal_.dot(p - corners_[0]); }
  /// Counter-clockwise faces stay so.
  Vec2 flatten(const Vec3& p) const {
    const Vec2 q(p[(axis_ + 1) % 3], p[(axis_ + 2) % 3]);
    return normal_[axis_] > 0 ? q : Vec2(q.y(), q.x());
  }
  Vec3 lift(const Vec2& flat) const {
    const Vec2 q = normal_[axis_] > 0 ? flat : Vec2(flat.y(), flat.x());
    Vec3 p = corners_[0];
    p[(axis_ + 1) % 3] = q.x(), p[(axis_ + 2) % 3] = q.y();
    p[axis_] -= height(p) / normal_[axis_];
    return p;
  }
  std::array<Vec2, 3> outline() const {
    return {flatten(corners_[0]), flatten(corners_[1]), flatten(corners_[2])};
  }

 private:
  Corners corners_;
  Vec3 normal_;
  Eigen::Index axis_ = 0;
};

/// What of a segment lies in a counter-clockwise triangle.
std::optional<Segment> clip(const Segment& s, const std::array<Vec2, 3>& triangle) {
  double from = 0, to = 1;
  for (int k = 0; k < 3; ++k) {
    const Vec2 along = triangle[(k + 1) % 3] - triangle[k];
    const double a = cross(along, s.a - triangle[k]), b = cross(along, s.b - triangle[k]);
    if (a < 0 && b < 0) return {};
    if (a < 0) from = std::max(from, a / (a - b));
    if (b < 0) to = std::min(to, a / (a - b));
  }
  if (from >= to) return {};
  return Segment{s.a + from * (s.b - s.a), s.a + to * (s.b - s.a)};
}

/// Where a face meets the plane of another: sides that lie in it, and the line across it.
void add_lines(const Flat& flat, const Corners& other, std::vector<Segment>& lines) {
  std::array<double, 3> height;
  std::vector<Vec3> across;
  for (int k = 0; k < 3; ++k) {
    height[k] = flat.height(other[k]);
    if (std::abs(height[k]) <= kTouch) height[k] = 0;
  }
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    if (height[k] == 0 && height[next] == 0)
      lines.push_back({flat.flatten(other[k]), flat.flatten(other[next])});
    if (height[k] == 0) across.push_back(other[k]);
    if (height[k] * height[next] < 0)
      across.push_back(other[k] +
                       height[k] / (height[k] - height[next]) * (other[next] - other[k]));
  }
  if (across.size() == 2) lines.push_back({flat.flatten(across[0]), flat.flatten(across[1])});
}

/// The lines of the other faces in a face, rounded, each once.
std::vector<Segment> find_lines(const Mesh& mesh, int face, const std::vector<int>& partners,
                                double grid) {
  const Flat flat(corners(mesh, face));
  std::vector<Segment> lines, clipped;
  for (const int p : partners) add_lines(flat, corners(mesh, p), lines);
  const auto rounded = [&](const Vec2& p) -> Vec2 { return (p / grid).array().round() * grid; };
  const auto key = [](const Segment& s) {
    return std::make_tuple(s.a.x(), s.a.y(), s.b.x(), s.b.y());
  };
  const auto less = [&](const Segment& s, const Segment& t) { return key(s) < key(t); };
  for (const Segment& line : lines)
    if (const std::optional<Segment> s = clip(line, flat.outline())) {
      Segment r{rounded(s->a), rounded(s->b)};
      if (std::make_pair(r.b.x(), r.b.y()) < std::make_pair(r.a.x(), r.a.y())) std::swap(r.a, r.b);
      if (r.a != r.b) clipped.push_back(r);
    }
  std::sort(clipped.begin(), clipped.end(), less);
  clipped.erase(std::unique(clipped.begin(), clipped.end(),
                            [&](const Segment& s, const Segment& t) { return key(s) == key(t); }),
                clipped.end());
  return clipped;
}

bool is_sliver(const std::array<Vec2, 3>& t) {
  double longest = 0;
  for (int k = 0; k < 3; ++k) longest = std::max(longest, (t[(k + 1) % 3] - t[k]).norm());
  return cross(t[1] - t[0], t[2] - t[0]) < kSliver * longest;
}

/// The face's pieces, each three corners.
std::vector<Corners> cut_face(const Mesh& mesh, int face, const std::vector<Segment>& lines) {
  const Flat flat(corners(mesh, face));
  const std::array<Vec2, 3> outline = flat.outline();
  Delaunay triangulation;
  const auto point = [&](const Vec2& p) { return Kernel::Point_2(p.x(), p.y()); };
  for (int k = 0; k < 3; ++k)
    triangulation.insert_constraint(point(outline[k]), point(outline[(k + 1) % 3]));
  for (const Segment& line : lines) triangulation.insert_constraint(point(line.a), point(line.b));
  std::vector<Corners> pieces;
  for (const auto f : triangulation.finite_face_handles()) {
    std::array<Vec2, 3> t;
    for (int k = 0; k < 3; ++k) t[k] = Vec2(f->vertex(k)->point().x(), f->vertex(k)->point().y());
    const Vec2 middle = (t[0] + t[1] + t[2]) / 3;
    bool is_in = !is_sliver(t);
    for (int k = 0; k < 3; ++k)
      is_in = is_in && cross(outline[(k + 1) % 3] - outline[k], middle - outline[k]) > 0;
    if (is_in) pieces.push_back({flat.lift(t[0]), flat.lift(t[1]), flat.lift(t[2])});
  }
  return pieces;
}

}  // namespace

Pieces cut_faces(const Mesh& mesh, const std::vector<char>& is_cut, double grid) {
  const std::vector<std::vector<int>> partners = find_partners(mesh, is_cut);
  std::vector<std::vector<Segment>> lines(mesh.faces.size());
  parallel_for(mesh.faces.size(), [&](std::size_t i) {
    if (!partners[i].empty()) lines[i] = find_lines(mesh, static_cast<int>(i), partners[i], grid);
  });
  int left_whole = 0;
  std::size_t squares = 0;
  for (std::vector<Segment>& own : lines) {
    const std::size_t square = own.size() * own.size();
    if (own.size() > kMostLines || squares + square > kMostSquares)
      own.clear(), ++left_whole;
    else
      squares += square;
  }
  std::vector<std::vector<Corners>> pieces(mesh.faces.size());
  parallel_for(mesh.faces.size(), [&](std::size_t i) {
    if (!lines[i].empty()) pieces[i] = cut_face(mesh, static_cast<int>(i), lines[i]);
  });
  Pieces result{{mesh.vertices, {}}, {}, left_whole};
  std::map<std::tuple<double, double, double>, int> index;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec3& p = mesh.vertices[v];
    index.emplace(std::tuple(p.x(), p.y(), p.z()), static_cast<int>(v));
  }
  const auto vertex = [&](const Vec3& exact) {
    const Vec3 p = (exact / grid).array().round() * grid;
    const auto [it, is_new] = index.try_emplace(std::tuple(p.x(), p.y(), p.z()),
                                                static_cast<int>(result.mesh.vertices.size()));
    if (is_new) result.mesh.vertices.push_back(p);
    return it->second;
  };
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    if (pieces[i].size() < 2) {
      result.mesh.faces.push_back(mesh.faces[i]);
      result.face_of.push_back(static_cast<int>(i));
      continue;
    }
    for (const Corners& c : pieces[i]) {
      const Face f = {vertex(c[0]), vertex(c[1]), vertex(c[2])};
      if (f[0] == f[1] || f[1] == f[2] || f[2] == f[0]) continue;
      result.mesh.faces.push_back(f);
      result.face_of.push_back(static_cast<int>(i));
    }
  }
  return result;
}

}  // namespace colod::hidden
