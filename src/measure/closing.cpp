// Based on: own work.
//
// Differs: –
//
// Notation: –
#include "closing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <span>

#include "core/flat.h"
#include "core/rays.h"
#include "face_samples.h"

namespace colod {
namespace {

constexpr double kSpacing = 0.1;                     // metres between samples of a part, at most
constexpr double kSamplesOfPart = 400;               // of a part, at least
constexpr double kBodySpacing = 0.2;                 // metres between samples of the body
constexpr double kSameSide = 0.866;                  // cosine of 30°
constexpr std::size_t kMostSides = 8;                // of a part: more is noise
constexpr double kCell = 0.25;                       // metres
constexpr int kCellsAround = 2;                      // cells: half a metre
constexpr double kNearInDepth = 1, kFarInDepth = 3;  // metres in depth
constexpr double kLargeSide = 0.1;                   // of a part's area
constexpr double kOffFace = 1e-3;                    // metres: no ray meets its own face
constexpr double kLeastDepth = 0.02;                 // metres
constexpr std::size_t kLeastAround = 3;              // samples that make a plane

bool is_opening(ElementKind kind) {
  return kind == ElementKind::kWindow || kind == ElementKind::kDoor;
}

Mesh part_of(const Mesh& mesh, const std::vector<int>& object, int instance) {
  Mesh part{mesh.vertices, {}};
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    if (object[f] == instance) part.faces.push_back(mesh.faces[f]);
  return part;
}

/// Samples that look the same way, or the opposite one.
struct Side {
  Vec3 along = Vec3::Zero();
  std::vector<std::size_t> samples;
};

/// Greedily from the largest face on; twice, so that its own noise does not decide.
std::vector<Side> find_sides(const Mesh& part, const std::vector<SurfaceSample>& samples) {
  std::vector<Vec3> cross;
  for (const Face& f : part.faces) cross.push_back(face_cross(part, f));
  std::vector<char> is_taken(part.faces.size(), 0);
  std::vector<Side> sides;
  const auto alike = [&](std::size_t face, const Vec3& along) {
    return !is_taken[face] && std::abs(cross[face].dot(along)) > kSameSide * cross[face].norm();
  };
  while (sides.size() < kMostSides) {
    std::size_t seed = part.faces.size();
    for (std::size_t f = 0; f < part.faces.size(); ++f)
      if (!is_taken[f] && (seed == part.faces.size() || cross[f].norm() > cross[seed].norm()))
        seed = f;
    if (seed == part.faces.size() || !(cross[seed].norm() > 0)) break;
    Vec3 along = cross[seed].normalized(), sum = Vec3::Zero();
    for (std::size_t f = 0; f < part.faces.size(); ++f)
      if (alike(f, along)) sum += cross[f].dot(along) < 0 ? Vec3(-cross[f]) : cross[f];
    Side side{sum.normalized(), {}};
    std::vector<char> is_own(part.faces.size(), 0);
    for (std::size_t f = 0; f < part.faces.size(); ++f)
      is_own[f] = f == seed || alike(f, side.along);
    for (std::size_t i = 0; i < samples.size(); ++i)
      if (is_own[samples[i].face]) side.samples.push_back(i);
    for (std::size_t f = 0; f < part.faces.size(); ++f) is_taken[f] |= is_own[f];
    sides.push_back(std::move(side));
  }
  return sides;
}

struct Level {
  Vec3 normal;
  double offset;  // along it
};

/// Where a side's samples are, seen along its direction.
class Shadow {
 public:
  Shadow(const Vec3& along, const std::vector<Vec3>& points) : basis_(plane_basis(along)) {
    for (const Vec3& p : points) {
      const auto [x, y] = cell(p);
      for (int j = -kCellsAround; j <= kCellsAround; ++j)
        for (int i = -kCellsAround; i <= kCellsAround; ++i) cells_.insert({x + i, y + j});
    }
  }
  bool is_near(const Vec3& p) const { return cells_.contains(cell(p)); }

 private:
  std::pair<int, int> cell(const Vec3& p) const {
    return {static_cast<int>(std::floor(p.dot(basis_[0]) / kCell)),
            static_cast<int>(std::floor(p.dot(basis_[1]) / kCell))};
  }
  std::array<Vec3, 2> basis_;
  std::set<std::pair<int, int>> cells_;
};

/// ∞: most have none.
double middle_relief(std::span<const PartSample> samples) {
  std::vector<double> reliefs;
  for (const PartSample& s : samples) reliefs.push_back(s.relief);
  return upper_median(std::move(reliefs));
}

}  // namespace

struct ClosedBuilding::Body {
  Mesh mesh;
  RayScene rays;
  std::vector<Vec3> points, normals;

  explicit Body(Mesh m) : mesh(std::move(m)), rays(mesh) {
    for (const SurfaceSample& s : spread_over(mesh, kBodySpacing)) {
      points.push_back(s.point);
      normals.push_back(face_cross(mesh, mesh.faces[s.face]).normalized());
    }
  }

  /// The plane that goes on around a side, in depth within `reach` of its middle; false: none.
  bool find_level(const std::vector<Vec3>& side, const Vec3& along, double reach,
                  Level& level) const;
  void add_side(const Side& side, const std::vector<SurfaceSample>& spread, double area,
                std::vector<PartSample>& samples) const;
  /// Along a line through x, the nearer of its two directions.
  double distance_along(const Vec3& x, const Vec3& along) const;
};

bool ClosedBuilding::Body::find_level(const std::vector<Vec3>& side, const Vec3& along,
                                      double reach, Level& level) const {
  std::vector<double> depths;
  Box box;
  for (const Vec3& p : side) depths.push_back(p.dot(along)), box.extend(p);
  const double middle = median(std::move(depths));
  const Vec3 margin = Vec3::Constant(kFarInDepth + kCell * kCellsAround);
  const Box around{box.min - margin, box.max + margin};
  const Shadow shadow(along, side);
  std::vector<std::size_t> found;
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3& p = points[i];
    if (!(p.array() >= around.min.array()).all() || !(p.array() <= around.max.array()).all())
      continue;
    const double cos = normals[i].dot(along);
    if (std::abs(cos) < kSameSide || std::abs(p.dot(along) - middle) > reach || !shadow.is_near(p))
      continue;
    found.push_back(i);
    sum += cos < 0 ? Vec3(-normals[i]) : normals[i];
  }
  if (found.size() < kLeastAround) return false;
  level.normal = sum.normalized();
  std::vector<double> offsets;
  for (const std::size_t i : found) offsets.push_back(points[i].dot(level.normal));
  level.offset = median(std::move(offsets));
  return true;
}

double ClosedBuilding::Body::distance_along(const Vec3& x, const Vec3& along) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3& direction : {along, Vec3(-along)})
    if (const RayHit hit = rays.first_hit(x, direction)) least = std::min(least, hit.distance);
  return least;
}

/// A side's samples with their relief.
void ClosedBuilding::Body::add_side(const Side& side, const std::vector<SurfaceSample>& spread,
                                    double area, std::vector<PartSample>& samples) const {
  std::vector<Vec3> places;
  for (const std::size_t i : side.samples) places.push_back(spread[i].point);
  if (places.empty()) return;
  Level level;
  const bool is_level = find_level(places, side.along, kNearInDepth, level) ||
                        find_level(places, side.along, kFarInDepth, level);
  for (const Vec3& x : places) {
    PartSample s{x, side.along, distance_along(x, side.along), area};
    if (is_level)
      s.relief = std::min(
          s.relief, std::abs((level.offset - x.dot(level.normal)) / side.along.dot(level.normal)));
    samples.push_back(s);
  }
}

ClosedBuilding::ClosedBuilding(const Source& source, const TruthBuilding& truth)
    : source_(source), rays_(source.mesh) {
  std::vector<int> openings;
  for (const TruthPart& p : truth.parts)
    if (is_opening(p.kind)) openings.push_back(p.instance);
  std::sort(openings.begin(), openings.end());
  Mesh main{source.mesh.vertices, {}}, solid = main;
  for (std::size_t f = 0; f < source.mesh.faces.size(); ++f) {
    const int object = source.face_object[f];
    if (std::binary_search(truth.main_building.begin(), truth.main_building.end(), object))
      main.faces.push_back(source.mesh.faces[f]);
    if (!std::binary_search(openings.begin(), openings.end(), object))
      solid.faces.push_back(source.mesh.faces[f]);
  }
  for_openings_ = std::make_unique<Body>(std::move(solid));
  for_others_ = std::make_unique<Body>(std::move(main));
}

ClosedBuilding::~ClosedBuilding() = default;

/// From the sky or from a little below: undersides are seen, and no view is from under the floor,
/// where models are open.
bool ClosedBuilding::is_seen(const Vec3& x) const {
  constexpr std::array<double, 4> kElevations_deg = {-10, 3, 30, 60};
  static const std::vector<Vec3> views = [&] {
    std::vector<Vec3> rings = ring_directions(32, kElevations_deg);
    rings.push_back(Vec3::UnitZ());
    return rings;
  }();
  return std::any_of(views.begin(), views.end(), [&](const Vec3& view) {
    return !rays_.is_occluded(x, view, kOffFace, std::numeric_limits<double>::infinity());
  });
}

PartRelief ClosedBuilding::sample(const TruthPart& part) const {
  const Body& body = is_opening(part.kind) ? *for_openings_ : *for_others_;
  const Mesh own = part_of(source_.mesh, source_.face_object, part.instance);
  const double spacing = std::min(kSpacing, std::sqrt(surface_area(own) / kSamplesOfPart));
  PartRelief relief;
  if (!(spacing > 0)) return relief;
  std::vector<SurfaceSample> spread = spread_over(own, spacing);
  std::erase_if(spread, [&](const SurfaceSample& s) { return !is_seen(s.point); });
  double least = std::numeric_limits<double>::infinity();
  for (const Side& side : find_sides(own, spread)) {
    const std::size_t first = relief.samples.size();
    body.add_side(side, spread, spacing * spacing, relief.samples);
    if (relief.samples.size() - first < kLargeSide * static_cast<double>(spread.size())) continue;
    const double middle = middle_relief(
        {relief.samples.data() + first, relief.samples.data() + relief.samples.size()});
    if (middle >= kLeastDepth) least = std::min(least, middle);
  }
  relief.depth = std::isfinite(least) ? least : 0;
  return relief;
}

}  // namespace colod
