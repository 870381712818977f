// Planes → Segments: sets of planes around one component of the building (paper
// section 3.1, Algorithm 1).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/element_kind.h"
#include "core/rules.h"
#include "planes/planes.h"
#include "visibility/visibility.h"

namespace colod {

struct SegmentOptions {
  RuleSet rules = RuleSet::all();  ///< none: Algorithm 1, hSum rule and plane → most hits
  double alcove_area = 80;         ///< A_eps, m²
  VisibilityOptions visibility;    ///< what the rules decide of it is not read
};

struct Segment {
  std::vector<int> planes;  ///< rising, each plane in at most one segment, at least one
  bool is_alcove = false;   ///< a recess: its voxels lie outside the building
  /// Of an element (elements/elements.h). Rays part chimneys from the body; they are only named.
  ElementKind kind = ElementKind::kPlain;
  std::int64_t voxels = 0;
  double volume = 0;  ///< m³, voxels × voxel volume
  double area = 0;    ///< m² of its planes
};

/// What a building loses when all of these segments are dropped, and not before.
struct Coverage {
  std::vector<int> segments;  ///< rising; empty: what nobody can lose
  double share = 0;  ///< of the building's volume and outline (paper: of its enclosed voxels);
                     ///< those of a building sum to 1
};

struct Segments {
  std::vector<Segment> segments;      ///< largest volume first, ties by first plane
  std::vector<int> segment_of_plane;  ///< −1: none
  std::vector<Coverage> coverage;     ///< P(I) of the paper's eq. 3, taken apart by who encloses
  std::uint64_t rays = 0;
  double visibility_seconds = 0, aggregation_seconds = 0;
  std::vector<std::string> warnings;
};

/// Never empty: when nothing is enclosed, all planes become one segment, with a warning.
Segments build_segments(const Planes& planes, const SegmentOptions& options = {});

}  // namespace colod
