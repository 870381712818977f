// What the files of room `planes` share: the items of a source and the regions grown over them. Not
// for other rooms.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "core/geometry.h"
#include "planes.h"

namespace colod::regions {

/// The faces of a mesh or the points of a cloud, with who lies beside whom.
struct Items {
  const Source* source = nullptr;
  std::vector<Vec3> center;      ///< face centroid or point
  std::vector<Vec3> normal;      ///< unit; zero where unknown
  std::vector<double> area;      ///< m²; of a point: what its neighbours leave it
  std::vector<char> is_floater;  ///< parted from the building; not used either
  std::vector<char> is_used;     ///< no floater, not degenerate, finite
  std::vector<int> first;        ///< neighbours of i: neighbor[first[i] .. first[i + 1])
  std::vector<int> neighbor;     ///< across an edge, or among the nearest points
  std::vector<signed char> way;  ///< beside `neighbor`: +1 wound alike across the edge, −1 not,
                                 ///< 0 unknown (points)
  double spacing = 0;            ///< metres: median distance of neighbouring points; mesh: 0

  int size() const { return static_cast<int>(center.size()); }
  bool is_mesh() const { return source->is_mesh(); }
  /// The points whose distance from a plane counts: three corners, or the point.
  int corners(int item, std::array<Vec3, 3>& out) const;
};

/// Weighted sums over a region's surface from which its plane follows.
struct Moments {
  double weight = 0;
  Vec3 sum = Vec3::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();

  void add(const Moments& other);
  void add_item(const Items& items, int item);
  Vec3 mean() const { return weight > 0 ? Vec3(sum / weight) : Vec3(Vec3::Zero()); }
  Eigen::Matrix3d covariance() const;
  /// Unit normal of the least-squares plane, turned towards `like`; `like` itself when undefined.
  Vec3 fit(const Vec3& like) const;
  /// Root mean square distance from the plane.
  double rms(const Vec3& normal, double offset) const;
};

struct Region {
  std::vector<int> items;  ///< rising once grown
  Moments moments;
  Vec3 normal = Vec3::UnitZ();
  double offset = 0;
  double area = 0;  ///< m²: of the items

  void refit();
};

struct GrowingOptions {
  double distance;   ///< metres
  double angle_deg;  ///< of the smoothed normals
};

// items.cpp
Items collect_items(const Source& source);
/// Marks small components far from the rest as unused; says how many in a warning.
void drop_floaters(Items& items, std::vector<std::string>& warnings);

// noise.cpp
/// Root mean square distance of neighbourhoods of 1.5 m from their own planes, metres: the flattest
/// tenth of them.
double estimate_noise(const Items& items);
/// Normals averaged over neighbours, for the angle test only.
std::vector<Vec3> smooth_normals(const Items& items, int rounds);

// growing.cpp
/// Regions by falling area; every used item in one region at most.
std::vector<Region> grow_regions(const Items& items, const std::vector<Vec3>& smooth,
                                 const GrowingOptions& options);
/// Items of no region join a neighbouring region whose plane they lie on within `distance`.
void absorb_rest(const Items& items, double distance, std::vector<Region>& regions);
/// Pairs of regions (a < b) with neighbouring items, rising.
std::vector<std::pair<int, int>> neighboring_regions(const Items& items,
                                                     const std::vector<Region>& regions,
                                                     double gap);

// round.cpp
/// A region for each side of the source's round shapes, on the shape's own planes.
std::vector<Region> round_regions(const Items& items, const RuleSet& rules);

// paper.cpp
std::vector<Region> grow_with_cgal(const Items& items, const PlaneOptions& options);

// regularize.cpp
/// Metres that aligning may move a region (root mean square over its own surface): as much as it is
/// off its own plane, but within these; and how far parallel planes that become one may be apart.
struct AlignOptions {
  double least_move;
  double most_move;
  double offset_width;
  bool is_strip_turned;  ///< whether narrow strips may turn farther than others
};
/// Joins nearly coplanar neighbours, then aligns directions and offsets where a region's own points
/// allow, as far as the rules for each are on.
void regularize(const Items& items, double distance, const AlignOptions& align,
                const RuleSet& rules, std::vector<Region>& regions);

// outline.cpp
/// Per region its outline; small holes are filled (Rule::kHoles), and rings that end near a
/// neighbouring plane are drawn to it (Rule::kBorders).
std::vector<Outline> make_outlines(const Items& items, const std::vector<Region>& regions,
                                   double distance, const RuleSet& rules);
double outline_area(const Outline& outline);

// orientation.cpp
/// Turns planes from whose back clearly more rays escape than from their front; in airborne clouds
/// what looks away from the sky or towards the roof above it. Returns how many.
int repair_orientation(std::vector<Plane>& planes, bool is_airborne_told);

}  // namespace colod::regions
