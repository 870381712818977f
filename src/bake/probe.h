// Inside room `bake` only: which place of the source a place of a layer shows.
#pragma once

#include <functional>

#include "bake.h"
#include "core/rays.h"

namespace colod::bake {

enum class Finding : std::uint8_t { kNone, kSeen, kNearest };

struct Found {
  Finding how = Finding::kNone;
  int face = -1;
  Vec3 point = Vec3::Zero();
};

class Probe {
 public:
  explicit Probe(const Mesh& mesh, Sides sides = Sides::kFront);
  /// Passes on where `is_hole` says so of a face and a place on it; empty: nowhere.
  using Holes = std::function<bool(int face, const Vec3& point)>;
  Found find(const Vec3& p, const Vec3& normal, double reach, const Holes& is_hole = {}) const;
  /// What is left where nothing lies along the normal: the nearest place about. `nearest` is one of
  /// `in_turn`, for places that mostly lie near the one before.
  Found beside(const Vec3& p, const Vec3& normal, double reach, const Holes& is_hole,
               NearestInTurn& nearest) const;
  NearestInTurn in_turn() const { return NearestInTurn(rays_); }
  /// Whether a face looks as a facet with this normal does.
  bool agrees(int face, const Vec3& normal) const;

 private:
  /// The first surface along a ray whose normal agrees with `normal`; at most `reach` away.
  RayHit first_agreeing(const Vec3& from, const Vec3& direction, const Vec3& normal, double reach,
                        const Holes& is_hole) const;

  RayScene rays_;
  std::vector<Vec3> normals_;  // unit, per face; zero without area
  bool has_both_sides_;
};

}  // namespace colod::bake
