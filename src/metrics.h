// What a mesh is worth: validity and distances. Used by `colod eval`, the report and the tests.
#pragma once

#include <cstdint>

#include "geometry.h"

namespace colod {

struct Validity {
  int vertices = 0, faces = 0;
  int polygons = 0;  ///< maximal connected sets of coplanar faces (exactly given by the caller, or
                     ///< found within 1e-4 m / 0.1°)
  bool is_watertight = false;  ///< every edge is used exactly once in each direction, vertices
                               ///< welded at equal coordinates first
  bool is_manifold =
      false;  ///< watertight or bounded, and every edge has ≤ 2 faces and every vertex one fan
  std::int64_t boundary_edges = 0, nonmanifold_edges = 0, nonmanifold_vertices = 0;
  std::int64_t self_intersections =
      0;  ///< intersecting face pairs that share no vertex/edge legitimately
  std::int64_t degenerate_faces = 0;  ///< zero area in doubles
  int components = 0;
  double volume = 0;  ///< m³, signed
  double area = 0;
};

/// `check_self_intersections` is the slow part (CGAL, O(n log n)).
Validity check_validity(const Mesh& mesh, bool check_self_intersections = true);

struct DistanceOptions {
  int samples = 100000;  ///< area-uniform, a side at least; vertices are added
  std::uint64_t seed = 1;
};

struct Distances {
  double a_to_b = 0, b_to_a = 0;            ///< one-sided maxima, metres (sampled Hausdorff)
  double relative = 0;                      ///< max of both / diagonal of a's bounding box
  double mean_a_to_b = 0, mean_b_to_a = 0;  ///< metres
  double rms_a_to_b = 0, rms_b_to_a = 0;    ///< metres
};

/// Surface to surface. Both meshes need a face.
Distances measure_distances(const Mesh& a, const Mesh& b, const DistanceOptions& options = {});

/// From a source (mesh surface, or the points of a cloud) to a model, and back (back to a cloud: to
/// its nearest point).
Distances measure_distances(const Source& a, const Mesh& b, const DistanceOptions& options = {});

}  // namespace colod
