// Source → Planes: the planar regions of a building with their outlines, oriented outward.
#pragma once

#include <string>
#include <vector>

#include "core/geometry.h"
#include "core/rules.h"
#include "relief/relief.h"

namespace colod {

/// Metres: planes grow at least this far under robust rules, on small buildings 2 % of the
/// diagonal; those of exact models that have few, 3 mm (planes.cpp).
constexpr double kLeastDistance = 0.03;
/// A model has none to spare of so few planes: nothing is merged or left out where it is exact.
constexpr std::size_t kFewPlanes = 12;

/// In plane_of_item: no part of the building, left out from the start.
constexpr int kFloater = -2;
/// Likewise: the ground around a building that is read as a relief (relief/relief.h).
constexpr int kAround = -3;

struct PlaneOptions {
  RuleSet rules = RuleSet::all();  ///< none: CGAL's region growing on points (of a mesh:
                                   ///< sampled) at the values below, nothing else
  double distance = 0.2;  ///< metres; with Rule::kNoise the most it may be, the value used is found
                          ///< from the data (planes.cpp)
  double angle_deg = 30;
  int min_points = 20;  ///< with Rule::kRegionArea regions are filtered by area instead; for clouds
                        ///< both hold
};

struct Planes {
  /// How exactly a source knows its surface: decided once, with the planes.
  enum class Surface {
    kExact,  ///< flat to the millimetre, as what people draw
    kClean,  ///< no noise asks planes to grow farther than kLeastDistance
    kNoisy   ///< photogrammetry, most clouds
  };

  std::vector<Plane> planes;       ///< largest area first, ties by centroid
  std::vector<int> plane_of_item;  ///< per face or point of the source; −1: none, kFloater, kAround
  Box box;                         ///< of the source without its floaters
  double total_area = 0;  ///< m² of the source without its floaters (cloud: sum of the outlines)
  double distance = 0;    ///< metres: the region growing distance used
  Surface surface = Surface::kExact;
  std::vector<char> is_side;  ///< per plane: of a round shape (rounds/rounds.h), exact and as good
                              ///< as its neighbours, however small; empty: none is
  std::vector<std::string> warnings;

  bool is_clean() const { return surface != Surface::kNoisy; }
  bool has_side(int plane) const { return !is_side.empty() && is_side[plane]; }
};

/// As the growing distance alone tells, which is what a scene file holds: kClean or kNoisy. No
/// later room tells kExact from kClean.
Planes::Surface surface_at(double distance);

/// `source` is in its local frame (read/frame.h). Deterministic; uses threads. Throws
/// Error{kProcess} when no plane is found.
Planes detect_planes(const Source& source, const PlaneOptions& options = {});

/// The roofs and walls of the source's relief as planes; what lies around is kAround. Throws as
/// above.
Planes relief_planes(const Source& source, Relief relief);

}  // namespace colod
