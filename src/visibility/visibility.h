// Planes → HitGrid: which planes each voxel of the box sees, and from which side (paper
// section 3.1, steps 1–4).
//
// n_s³ voxels divide the planes' box; from each centroid n_r rays leave at angles 2πk/n_r in the XY
// plane; the first plane met counts as a hit, inside when the centroid is behind the plane (normals
// point outward).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry.h"
#include "core/options.h"
#include "parameters.h"
#include "planes/planes.h"

namespace colod {

struct VisibilityOptions {
  Visibility engine = Visibility::kEmbree;  ///< only Embree's stop early; no result hangs on it
  int ns = 150;
  int nr = 100;
  /// Stop a voxel's rays once it can neither become valid (≥ n_r/2 inside hits, or the robust party
  /// wall rule) nor an alcove candidate (≥ n_r/2 outside hits). Its hits are then dropped: the
  /// result is the same for every consumer.
  bool early_stop = true;
  bool is_party_wall_rule = true;  ///< Rule::kPartyWalls: a voxel with ≥ 0.35 n_r inside and
                                   ///< ≤ 0.02 n_r outside hits is valid too
  /// Rule::kWideOutlines: for the rays, outlines are wider by this many times Planes::distance on
  /// every side, so that few rays escape through cracks between neighbours; 0: as they are.
  double border_ratio = parameters::visibility::kBorderRatio;
};

/// One plane seen from one voxel.
struct Hit {
  std::uint32_t plane;    ///< index into Planes::planes
  std::uint16_t inside;   ///< rays that met the plane's inner side (valid hits)
  std::uint16_t outside;  ///< rays that met its outer side
};

/// Sparse hits of all voxels; voxel (x, y, z) has index x + ns (y + ns z).
struct HitGrid {
  int ns = 0, nr = 0;
  Box box;  ///< of the active planes' outlines, larger by some 3e-4 of its size (visibility.cpp)
  std::vector<std::uint64_t>
      first;  ///< ns³ + 1: hits of voxel v are hits[first[v]] … hits[first[v+1]−1], by rising plane
  std::vector<Hit> hits;
  std::vector<std::uint8_t> is_valid;  ///< ns³: the voxel is inside the building
  std::uint64_t rays = 0;              ///< rays cast, fewer than ns³ nr after early stops
  double seconds = 0;                  ///< of casting, for rays per second

  Vec3 voxel_size() const { return box.size() / ns; }
  double voxel_volume() const { return voxel_size().prod(); }
  Vec3 center(std::size_t voxel) const {
    const std::size_t n = static_cast<std::size_t>(ns);
    const Vec3 cell(static_cast<double>(voxel % n), static_cast<double>(voxel / n % n),
                    static_cast<double>(voxel / n / n));
    return box.min + (cell + Vec3::Constant(0.5)).cwiseProduct(voxel_size());
  }
  std::span<const Hit> at(std::size_t voxel) const {
    return {hits.data() + first[voxel], hits.data() + first[voxel + 1]};
  }
};

/// `is_active` (empty: all) leaves planes out; `is_reversed` (empty: none) turns planes round
/// (Algorithm 1). `is_valid` and `hits` are those of all n_r rays with and without early_stop: hits
/// are kept of valid voxels and of those with ≥ n_r/2 outside hits. No plane, or none active: empty
/// box, no hits. Uses threads; the same bytes with any number. Rays a second and core: Embree 20
/// million, the sweep 200 million or more (docs/performance.md); but for the grid itself, the sweep
/// holds at most 256 MiB and 8 MiB a thread, for n_s n_r above 2 million the codes of two rows
/// (4 n_s n_r bytes). Engines agree but for rays within rounding of an outline's edge. Throws
/// Error{kUsage} for n_s outside 1…2048 or n_r outside 1…65535; sweep: Error{kProcess} when more
/// than 32767 planes cross one slice.
HitGrid cast_visibility(const Planes& planes, const VisibilityOptions& options = {},
                        const std::vector<char>& is_active = {},
                        const std::vector<char>& is_reversed = {});

}  // namespace colod
