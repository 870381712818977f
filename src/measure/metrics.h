// What a mesh is worth: validity and distances. Used by `colod eval`, the report and the tests.
#pragma once

#include <cstdint>
#include <memory>

#include "core/geometry.h"

namespace colod {

struct Validity {
  int vertices = 0, faces = 0;  ///< as given, before welding
  int polygons = 0;  ///< maximal connected sets of coplanar faces (exactly given by the caller, or
                     ///< found within 1e-4 m / 0.1°)
  double least_width = 0;  ///< metres, of the narrowest polygon: twice its area over its perimeter,
                           ///< which is a long strip's width; 0: no polygon
  bool is_watertight = false;  ///< every edge is used exactly once in each direction, vertices
                               ///< welded at equal coordinates first; no face collapses in it
  bool is_manifold =
      false;  ///< watertight or bounded, and every edge has ≤ 2 faces and every vertex one fan
  std::int64_t boundary_edges = 0;     ///< used by one face
  std::int64_t nonmanifold_edges = 0;  ///< used by three or more
  std::int64_t misoriented_edges = 0;  ///< used by two faces in the same direction
  std::int64_t nonmanifold_vertices =
      0;  ///< more than one fan of faces; non-manifold edges part fans
  std::int64_t self_intersections =
      0;  ///< intersecting face pairs that share no vertex/edge legitimately
  std::int64_t degenerate_faces = 0;  ///< zero area in doubles, or a coordinate that is not finite
                                      ///< (counted here and ignored elsewhere)
  int components = 0;                 ///< sets of faces connected over edges
  int enclosed_components = 0;        ///< watertight: those inside another one, cavities and what
                                      ///< stands in them: nobody sees them from outside; else 0
  double volume = 0;                  ///< m³, signed
  double area = 0;
};

/// Never throws; a mesh without faces is neither watertight nor manifold. Touching counts as
/// intersecting; faces that share an edge intersect when they fold onto each other, equal faces
/// always do. Degenerate faces are left out of the intersections. Deterministic, runs in parallel.
/// `check_self_intersections` is the slow part (CGAL, O(n log n)).
Validity check_validity(const Mesh& mesh, bool check_self_intersections = true);

struct DistanceOptions {
  int samples = 100000;  ///< evenly over the area, on each side; vertices are added
  std::uint64_t seed = 1;
};

/// Distances over an area, metres.
struct Spread {
  double mean = 0, p95 = 0, p99 = 0, max = 0;  ///< p95: what 95 % of the area does not exceed
};

struct Distances {
  double a_to_b = 0, b_to_a = 0;            ///< one-sided maxima, metres (sampled Hausdorff)
  double relative = 0;                      ///< max of both / diagonal of a's bounding box
  double mean_a_to_b = 0, mean_b_to_a = 0;  ///< metres
  double rms_a_to_b = 0, rms_b_to_a = 0;    ///< metres
  Spread taken;  ///< a → b, of what is not left out of a; all of it unless the gauge is told so
};

/// Measures one mesh or source (a) against many meshes: its samples and its search tree are made
/// once. Maxima are over samples and vertices, means over the samples only; of a cloud all points
/// are used, those not finite are left out, and the way back is to its nearest point. Both sides
/// need a finite face with an area (a cloud: a finite point), else Error. Never NaN; `relative`
/// divides by 1 where a has no extent. Deterministic, runs in parallel.
class DistanceGauge {
 public:
  explicit DistanceGauge(const Mesh& a, const DistanceOptions& options = {});
  /// `is_left_out`: per face or point of a, what was parted from the building; empty: nothing.
  explicit DistanceGauge(const Source& a, const DistanceOptions& options = {},
                         const std::vector<char>& is_left_out = {});
  ~DistanceGauge();

  Distances measure_to(const Mesh& b) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// One measurement by a DistanceGauge.
Distances measure_distances(const Mesh& a, const Mesh& b, const DistanceOptions& options = {});
Distances measure_distances(const Source& a, const Mesh& b, const DistanceOptions& options = {});

}  // namespace colod
