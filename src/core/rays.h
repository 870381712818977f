// The ray oracle: one triangle soup, first hits and nearest points. With visibility/visibility.cpp
// the only files that name Embree.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "geometry.h"

namespace colod {

struct RayHit {
  int triangle = -1;    ///< −1: nothing hit
  double distance = 0;  ///< metres along the unit direction
  bool is_inside =
      false;  ///< the ray meets the triangle's back, so its origin is on the inner side

  explicit operator bool() const { return triangle >= 0; }
};

struct NearestPoint {
  int triangle = -1;
  double distance = 0;
  Vec3 point = Vec3::Zero();
};

/// Immutable once built; all queries are const and safe from several threads. Embree computes in
/// single precision about the soup's own centre; hits are exact to about 1e-6 of the soup's size.
/// `nearest` refines in double.
class RayScene {
 public:
  RayScene(const std::vector<Vec3>& vertices, const std::vector<Face>& triangles);
  explicit RayScene(const Mesh& mesh) : RayScene(mesh.vertices, mesh.faces) {}
  /// Part of a soup whose box is `whole`: rays that can meet nothing else of the soup get the bits
  /// that all of it would give.
  RayScene(const Mesh& part, const Box& whole);
  ~RayScene();
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;

  /// First hit at distance in (t_min, t_max).
  RayHit first_hit(const Vec3& origin, const Vec3& direction, double t_min = 0,
                   double t_max = std::numeric_limits<double>::infinity()) const;
  bool is_occluded(const Vec3& origin, const Vec3& direction, double t_min, double t_max) const;
  /// All hits along the ray, nearest first; at most `limit`.
  std::vector<RayHit> all_hits(const Vec3& origin, const Vec3& direction, int limit = 1024) const;
  /// A `within` that is no less than the distance saves time and changes nothing; below it the
  /// answer is arbitrary or none (triangle −1).
  NearestPoint nearest(const Vec3& query,
                       double within = std::numeric_limits<double>::infinity()) const;

 private:
  friend class NearestInTurn;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Nearest points of queries that mostly lie near the one before: the search begins with the
/// triangle that was the last one's. Answers as RayScene::nearest, sooner. One a thread; the scene
/// must outlive it.
class NearestInTurn {
 public:
  explicit NearestInTurn(const RayScene& scene) : scene_(scene) {}
  /// None (triangle −1) where nothing lies at most `within` away.
  NearestPoint operator()(const Vec3& query,
                          double within = std::numeric_limits<double>::infinity());

 private:
  const RayScene& scene_;
  std::int64_t last_ = -1;  ///< the scene's own number of a triangle
};

/// n unit directions spread over the sphere (Fibonacci lattice), the same at every call.
std::vector<Vec3> sphere_directions(int n);
/// n unit directions on rings at the given elevations (degrees above the horizon), n shared out
/// evenly, first ring first.
std::vector<Vec3> ring_directions(int n, std::span<const double> elevations_deg);

}  // namespace colod
