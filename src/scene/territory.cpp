// Based on: constrained Delaunay triangulation (CGAL); clipping of convex polygons after I.
// Sutherland and G. Hodgman, 1974.
// Differs: borders between footprints that stand apart by less than two eaves follow the middle of
// the gap; eaves end in octagons about corners.
// Notation: a corner of a cut face is given by its weights of the face's own corners.
#include "territory.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include "core/flat.h"
#include "cutter.h"
#include "fewer_pieces.h"
#include "parameters.h"
#include "reunion.h"

namespace colod {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Cdt =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, CGAL::Default, CGAL::Exact_predicates_tag>;
using Ring = std::vector<Vec2>;
using parameters::territory::kEaves;

constexpr double kSame = 1e-6;  // metres: nearer points are one
constexpr double kBin = 4;      // metres, of the grid that pieces are found by

Vec2 nearest(const Vec2& a, const Vec2& b, const Vec2& p) {
  const Vec2 along = b - a;
  const double length = along.squaredNorm();
  return length > 0 ? Vec2(a + std::clamp((p - a).dot(along) / length, 0.0, 1.0) * along) : a;
}

struct Edge {
  Vec2 a, b;
};

std::vector<Edge> edges_of(const Footprint& f) {
  std::vector<Edge> out;
  for (const auto& part : f.parts)
    for (const Ring& ring : part)
      for (std::size_t i = 0; i < ring.size(); ++i)
        out.push_back({ring[i], ring[(i + 1) % ring.size()]});
  return out;
}

/// A footprint as it is asked for.
struct Plan {
  std::vector<Edge> edges;
  Vec2 min, max;  // with eaves

  explicit Plan(const Footprint& f) : edges(edges_of(f)) {
    min = Vec2::Constant(INFINITY), max = -min;
    for (const Edge& e : edges) min = min.cwiseMin(e.a), max = max.cwiseMax(e.a);
    min.array() -= kEaves, max.array() += kEaves;
  }
  bool is_near(const Vec2& p) const {
    return (p.array() >= min.array()).all() && (p.array() <= max.array()).all();
  }
  /// By counting crossings of a ray, so that holes are holes.
  bool holds(const Vec2& p) const {
    bool is_inside = false;
    for (const Edge& e : edges)
      if ((e.a.y() > p.y()) != (e.b.y() > p.y()) &&
          p.x() < e.a.x() + (p.y() - e.a.y()) / (e.b.y() - e.a.y()) * (e.b.x() - e.a.x()))
        is_inside = !is_inside;
    return is_inside;
  }
  double distance(const Vec2& p) const {
    double least = INFINITY;
    for (const Edge& e : edges) least = std::min(least, (nearest(e.a, e.b, p) - p).norm());
    return least;
  }
};

/// Bins of a plane → what overlaps them.
class Bins {
 public:
  void add(int item, const Vec2& min, const Vec2& max) {
    for_each(min, max, [&](const Key& key) { bins_[key].push_back(item); });
  }
  /// Rising, each once.
  std::vector<int> find(const Vec2& min, const Vec2& max) const {
    std::vector<int> out;
    for_each(min, max, [&](const Key& key) {
      if (const auto found = bins_.find(key); found != bins_.end())
        out.insert(out.end(), found->second.begin(), found->second.end());
    });
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
  }

 private:
  using Key = std::array<int, 2>;
  template <typename Body>
  static void for_each(const Vec2& min, const Vec2& max, Body body) {
    const auto bin = [](double x) { return static_cast<int>(std::floor(x / kBin)); };
    for (int x = bin(min.x()); x <= bin(max.x()); ++x)
      for (int y = bin(min.y()); y <= bin(max.y()); ++y) body({x, y});
  }
  std::map<Key, std::vector<int>> bins_;
};

/// Everything that parts the plan: borders, where eaves end, and the middle of gaps.
class Borders {
 public:
  explicit Borders(const std::vector<Plan>& plans) : plans_(plans) {
    for (std::size_t i = 0; i < plans.size(); ++i)
      for (std::size_t e = 0; e < plans[i].edges.size(); ++e)
        names_.push_back({static_cast<int>(i), static_cast<int>(e)});
    for (std::size_t n = 0; n < names_.size(); ++n) {
      const Edge& e = edge(static_cast<int>(n));
      bins_.add(static_cast<int>(n), e.a.cwiseMin(e.b), e.a.cwiseMax(e.b));
    }
  }

  Cdt triangulation() {
    for (std::size_t n = 0; n < names_.size(); ++n) {
      const Edge& e = edge(static_cast<int>(n));
      constrain(e.a, e.b);
      add_eaves(e);
      add_middles(static_cast<int>(n));
    }
    return std::move(cdt_);
  }

 private:
  const Edge& edge(int n) const {
    const auto [plan, e] = names_[static_cast<std::size_t>(n)];
    return plans_[static_cast<std::size_t>(plan)].edges[static_cast<std::size_t>(e)];
  }

  void constrain(const Vec2& a, const Vec2& b) {
    if ((a - b).norm() > kSame)
      cdt_.insert_constraint(Kernel::Point_2(a.x(), a.y()), Kernel::Point_2(b.x(), b.y()));
  }

  void add_eaves(const Edge& e) {
    const Vec2 along = (e.b - e.a).normalized(), out(along.y(), -along.x());
    for (const double side : {-kEaves, kEaves}) constrain(e.a + side * out, e.b + side * out);
    constexpr int kCorners = 8;
    const auto corner = [&](int k) {
      const double turn = 2 * std::numbers::pi * k / kCorners;
      return Vec2(e.a + kEaves * Vec2(std::cos(turn), std::sin(turn)));
    };
    for (int k = 0; k < kCorners; ++k) constrain(corner(k), corner(k + 1));
  }

  /// Between this edge and those of later footprints that are nearer than two eaves.
  void add_middles(int n) {
    const Edge& e = edge(n);
    const Vec2 reach = Vec2::Constant(2 * kEaves);
    const double length = (e.b - e.a).norm();
    const Vec2 along = (e.b - e.a) / length;
    for (const int m : bins_.find(e.a.cwiseMin(e.b) - reach, e.a.cwiseMax(e.b) + reach)) {
      if (names_[static_cast<std::size_t>(m)][0] <= names_[static_cast<std::size_t>(n)][0])
        continue;
      const Edge& f = edge(m);
      const double s = along.dot(f.a - e.a), t = along.dot(f.b - e.a);
      const double from = std::clamp(std::min(s, t) - 2 * kEaves, 0.0, length);
      const double to = std::clamp(std::max(s, t) + 2 * kEaves, 0.0, length);
      const auto middle = [&](double at) {
        const Vec2 p = e.a + at * along;
        return Vec2(0.5 * (p + nearest(f.a, f.b, p)));
      };
      const double gap =
          (nearest(f.a, f.b, e.a + 0.5 * (from + to) * along) - (e.a + 0.5 * (from + to) * along))
              .norm();
      if (gap > kSame && gap < 2 * kEaves) constrain(middle(from), middle(to));
    }
  }

  const std::vector<Plan>& plans_;
  std::vector<std::array<int, 2>> names_;
  Bins bins_;
  Cdt cdt_;
};

struct FlatFace {
  std::array<Vec2, 3> corners;
  Vec2 at(const Vec3& weights) const {
    return weights[0] * corners[0] + weights[1] * corners[1] + weights[2] * corners[2];
  }
};

/// What of a polygon lies to the left of a → b, and what to the right.
void split(const FlatFace& face, const FacePart& polygon, const Vec2& a, const Vec2& b,
           FacePart& left, FacePart& right) {
  left.clear(), right.clear();
  const Vec2 along = (b - a).normalized();
  std::vector<double> side;
  for (const Vec3& w : polygon) {
    const double s = cross(along, face.at(w) - a);
    side.push_back(std::abs(s) < kSame ? 0 : s);
  }
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const std::size_t j = (i + 1) % polygon.size();
    if (side[i] >= 0) left.push_back(polygon[i]);
    if (side[i] <= 0) right.push_back(polygon[i]);
    if (side[i] * side[j] >= 0) continue;
    const Vec3 middle = (polygon[i] * std::abs(side[j]) + polygon[j] * std::abs(side[i])) /
                        (std::abs(side[i]) + std::abs(side[j]));
    left.push_back(middle), right.push_back(middle);
  }
  const auto is_line = [&](const std::vector<double>& s) {
    return std::all_of(s.begin(), s.end(), [](double x) { return x == 0; });
  };
  if (is_line(side)) right.clear();  // upright on the border: the left one's
}

}  // namespace

struct Territories::Impl {
  std::vector<std::vector<Piece>> fine;  // per building; all of them meet corner to corner
  std::vector<Piece> pieces;             // the same ground in fewer
  std::vector<Box> boxes;
  std::vector<double> areas;
  Bins bins;

  explicit Impl(std::size_t buildings) : fine(buildings), boxes(buildings), areas(buildings, 0) {}

  /// The ground of each building in as few pieces as its borders take.
  void settle(double tolerance) {
    for (const std::vector<Piece>& own : fine)
      if (!own.empty())
        for (const Piece& piece : fewer_pieces(own, tolerance)) add(piece);
  }

  void add(const Piece& piece) {
    const Vec2 low = piece.corners[0].cwiseMin(piece.corners[1]).cwiseMin(piece.corners[2]);
    const Vec2 high = piece.corners[0].cwiseMax(piece.corners[1]).cwiseMax(piece.corners[2]);
    bins.add(static_cast<int>(pieces.size()), low, high);
    const auto b = static_cast<std::size_t>(piece.building);
    boxes[b].extend(Vec3(low.x(), low.y(), -INFINITY));
    boxes[b].extend(Vec3(high.x(), high.y(), INFINITY));
    pieces.push_back(piece);
  }

  /// Parts of a face over a building's ground, or, of −1, over no one's. True: all of it is.
  bool parts_of(const FlatFace& face, int building, std::vector<FacePart>& out) const;
};

bool Territories::Impl::parts_of(const FlatFace& face, int building,
                                 std::vector<FacePart>& out) const {
  const Vec2 low = face.corners[0].cwiseMin(face.corners[1]).cwiseMin(face.corners[2]);
  const Vec2 high = face.corners[0].cwiseMax(face.corners[1]).cwiseMax(face.corners[2]);
  std::vector<FacePart> open = {{Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()}}, next;
  FacePart inside, outside;
  bool is_foreign = false;  // something of it is another's
  for (const int p : bins.find(low, high)) {
    const Piece& piece = pieces[static_cast<std::size_t>(p)];
    next.clear();
    for (FacePart& polygon : open) {
      const FacePart whole = polygon;
      std::vector<FacePart> rest;
      for (std::size_t e = 0; e < 3 && polygon.size() >= 3; ++e) {
        split(face, polygon, piece.corners[e], piece.corners[(e + 1) % 3], inside, outside);
        if (outside.size() >= 3) rest.push_back(outside);
        polygon.swap(inside);
      }
      if (polygon.size() < 3) {
        next.push_back(whole);  // it is beside the piece
        continue;
      }
      if (piece.building == building)
        out.push_back(polygon);
      else
        is_foreign = true;
      next.insert(next.end(), rest.begin(), rest.end());
    }
    open.swap(next);
    if (open.empty()) break;
  }
  if (building < 0) {
    out = open;
    return !is_foreign;
  }
  const auto is_nothing = [&](const FacePart& p) { return p.size() < 3; };
  open.erase(std::remove_if(open.begin(), open.end(), is_nothing), open.end());
  return open.empty() && !is_foreign;
}

Territories::Territories(const std::vector<Footprint>& footprints)
    : impl_(std::make_unique<Impl>(footprints.size())) {
  std::vector<Plan> plans(footprints.begin(), footprints.end());
  Bins near;
  for (std::size_t i = 0; i < plans.size(); ++i)
    near.add(static_cast<int>(i), plans[i].min, plans[i].max);
  const Cdt cdt = Borders(plans).triangulation();
  for (const Cdt::Face_handle face : cdt.finite_face_handles()) {
    Piece piece{{}, -1};
    for (int k = 0; k < 3; ++k)
      piece.corners[static_cast<std::size_t>(k)] = {face->vertex(k)->point().x(),
                                                    face->vertex(k)->point().y()};
    const auto& c = piece.corners;
    if (cross(c[1] - c[0], c[2] - c[0]) < 2 * kLeastFace) continue;
    const Vec2 middle = (c[0] + c[1] + c[2]) / 3;
    double least = kEaves;
    for (const int i : near.find(middle, middle)) {
      const Plan& plan = plans[static_cast<std::size_t>(i)];
      if (!plan.is_near(middle)) continue;
      if (plan.holds(middle)) {
        piece.building = i;
        impl_->areas[static_cast<std::size_t>(i)] += 0.5 * cross(c[1] - c[0], c[2] - c[0]);
        break;
      }
      if (const double d = plan.distance(middle); d < least) least = d, piece.building = i;
    }
    if (piece.building >= 0) impl_->fine[static_cast<std::size_t>(piece.building)].push_back(piece);
  }
  impl_->settle(kSame);
}

Territories::Territories(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Territories::~Territories() = default;
Territories::Territories(Territories&&) noexcept = default;

Territories Territories::without(const std::vector<char>& is_out) const {
  auto impl = std::make_unique<Impl>(count());
  for (std::size_t b = 0; b < count(); ++b)
    if (!is_out[b]) impl->fine[b] = impl_->fine[b], impl->areas[b] = impl_->areas[b];
  impl->settle(kSame);
  return Territories(std::move(impl));
}

Territories Territories::coarser(double tolerance) const {
  auto impl = std::make_unique<Impl>(1);
  for (std::size_t b = 0; b < count(); ++b)
    impl->fine[0].insert(impl->fine[0].end(), impl_->fine[b].begin(), impl_->fine[b].end());
  for (Piece& piece : impl->fine[0]) piece.building = 0;
  impl->areas[0] = std::accumulate(impl_->areas.begin(), impl_->areas.end(), 0.0);
  impl->settle(tolerance);
  return Territories(std::move(impl));
}

std::size_t Territories::count() const { return impl_->boxes.size(); }
const Box& Territories::box(std::size_t building) const { return impl_->boxes[building]; }
double Territories::area(std::size_t building) const { return impl_->areas[building]; }
const std::vector<Territories::Piece>& Territories::pieces() const { return impl_->pieces; }

bool Territories::covers(const Vec2& p) const {
  for (const int i : impl_->bins.find(p, p)) {
    const auto& c = impl_->pieces[static_cast<std::size_t>(i)].corners;
    if (cross(c[1] - c[0], p - c[0]) >= 0 && cross(c[2] - c[1], p - c[1]) >= 0 &&
        cross(c[0] - c[2], p - c[2]) >= 0)
      return true;
  }
  return false;
}

Source Territories::cut_out(const Source& source, int building) const {
  Cutter cutter(source);
  const Mesh& mesh = source.mesh;
  std::vector<FacePart> parts;
  const bool is_rest = building < 0;
  const Box* box = is_rest ? nullptr : &impl_->boxes[static_cast<std::size_t>(building)];
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    FlatFace flat;
    std::array<Vec3, 3> corners;
    Box own;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = mesh.vertices[static_cast<std::size_t>(mesh.faces[f][k])];
      corners[k] = p, flat.corners[k] = p.head<2>();
      own.extend(p);
    }
    if (box &&
        ((own.min.array() > box->max.array()).any() || (own.max.array() < box->min.array()).any()))
      continue;
    parts.clear();
    if (impl_->parts_of(flat, building, parts))
      cutter.add_whole(f);
    else
      for (const auto& part : reunite(corners, parts))
        cutter.add_part(f, {part[0], part[1], part[2]});
  }
  return cutter.take();
}

}  // namespace colod
