// Based on: projection along the normal, as normal maps are baked.
// Differs: the nearest surface that agrees wins, whether it lies before the facet or behind it.
#include "probe.h"

#include <algorithm>

#include "parameters.h"

namespace colod::bake {

using namespace parameters::bake;

Probe::Probe(const Mesh& mesh, Sides sides) : rays_(mesh), has_both_sides_(sides == Sides::kBoth) {
  for (const Face& f : mesh.faces) {
    const Vec3 cross = face_cross(mesh, f);
    normals_.push_back(cross.norm() > 0 ? Vec3(cross.normalized()) : Vec3(Vec3::Zero()));
  }
}

bool Probe::agrees(int face, const Vec3& normal) const {
  const double cosine = normals_[static_cast<std::size_t>(face)].dot(normal);
  return (has_both_sides_ ? std::abs(cosine) : cosine) > kAgrees;
}

RayHit Probe::first_agreeing(const Vec3& from, const Vec3& direction, const Vec3& normal,
                             double reach, const Holes& is_hole) const {
  double begin = 0;
  for (int layer = 0; layer < kMostLayers && begin < reach; ++layer) {
    const RayHit hit = rays_.first_hit(from, direction, begin, reach);
    if (!hit) return hit;
    if (agrees(hit.triangle, normal) &&
        !(is_hole && is_hole(hit.triangle, from + hit.distance * direction)))
      return hit;
    begin = hit.distance + kLift;
  }
  return {};
}

Found Probe::find(const Vec3& p, const Vec3& normal, double reach, const Holes& is_hole) const {
  // Each ray begins a little before the facet, so that a surface in its plane is met.
  const RayHit out = first_agreeing(p - kLift * normal, normal, normal, reach + kLift, is_hole);
  const double known = out ? std::abs(out.distance - kLift) : reach;
  const RayHit in = first_agreeing(p + kLift * normal, -normal, normal, known + kLift, is_hole);
  if (in && std::abs(in.distance - kLift) <= known)
    return {Finding::kSeen, in.triangle, p - (in.distance - kLift) * normal};
  if (out) return {Finding::kSeen, out.triangle, p + (out.distance - kLift) * normal};
  NearestInTurn nearest = in_turn();
  return beside(p, normal, reach, is_hole, nearest);
}

Found Probe::beside(const Vec3& p, const Vec3& normal, double reach, const Holes& is_hole,
                    NearestInTurn& nearest) const {
  const NearestPoint near = nearest(p, std::min(reach, kNearest));
  if (near.triangle >= 0 && agrees(near.triangle, normal) &&
      !(is_hole && is_hole(near.triangle, near.point)))
    return {Finding::kNearest, near.triangle, near.point};
  return {};
}

}  // namespace colod::bake
