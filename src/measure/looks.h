// How a layer looks, in numbers: what a person who drew the building would have done otherwise.
// Needs the source and one mesh; nothing of the pipeline, so that other programs' models can be
// judged, too.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "core/geometry.h"
#include "solid.h"

namespace colod {

/// What can be wrong with a layer's looks. The first ones have a place where they are worst.
enum class LookFault { kFlap, kUnsupported, kLeaning, kNarrow, kEdges, kEaves, kTriangles };
constexpr int kLookFaults = 7, kPlacedFaults = 4;

/// As in report.json: "flap", "unsupported", "leaning", "narrow", "edges", "eaves", "triangles".
const char* to_string(LookFault fault);

/// Where a fault is worst: a facet.
struct FaultPlace {
  double size = 0;            ///< m² of it there (narrow: of the facet); 0: nowhere
  Vec3 place = Vec3::Zero();  ///< in the frame of the mesh
};

struct Looks {
  double triangles_ratio = -1;  ///< triangles over the source's; −1: the source is points
  double wall_area = 0;         ///< m² of facets that are walls
  double upright = 1;           ///< 0..1 of it within 1° of upright; 1: no wall
  double aligned = 1;  ///< 0..1 of the edges' length in the building's few plan directions; 1: none
  double level_eaves = 1;  ///< 0..1 of the eaves' length within 1° of level; 1: no eave
  int narrow = 0;          ///< facets narrower than the noise
  double unsupported = 0;  ///< m² that no source supports
  double flaps = 0;        ///< m² of thin bodies
  double ragged = 0;       ///< m² that are either
  std::array<FaultPlace, kPlacedFaults> worst;  ///< by LookFault
};

/// What is to be said of a layer's looks in one word.
struct LookVerdict {
  double points = 0;              ///< 0: nothing is seen; the sum of the faults' own, 1..10 each
  std::vector<LookFault> faults;  ///< that are seen, the heaviest first
};

/// A fault is seen from a bound on, its points are how many times the bound it is: flaps 0.5 m²,
/// unsupported surface 1 m², 5 % of the wall area leaning, a narrow facet, 20 % of the edges'
/// length in no direction of the plan, 10 % of the eaves' not level; more triangles than the source
/// has.
LookVerdict judge_looks(const Looks& looks);

/// Of the wall area: a finest layer with more of it ragged than this shows another thing than its
/// source. Of 274 single buildings, which were looked at, one has more, 0.22 (a cloud's house whose
/// walls stand over a terrace), the next 0.16 and the median 0.001; two scraps of a tile that a
/// beam joins have 0.23, a scrap of a flat roof 2.4.
constexpr double kMostRagged = 0.2;
/// m²: with fewer walls it is a roof alone, which is as thin as it is low.
constexpr double kLeastWall = 0.1;

/// What is known of a source before any layer is looked at.
struct SourceLooks {
  double noise = 0;  ///< metres: median over places of the surface of the rms distance from the
                     ///< best plane within 2 m, of what faces the same way by 45°; at most 0.5
  double edge = -1;  ///< metres: median length of its triangles' edges; −1: points
};

/// Judges one source's layers.
///
/// A facet is a maximal set of coplanar faces. A *wall* is a facet steeper than 70°, or than 45°
/// where at least half of its lower border is on the ground, which is a metre over the lowest
/// point. So a wall that leans by 10 or 20° counts as a leaning wall, one that leans farther does
/// where it reaches the ground, and a steep roof does not, whatever it stands on.
///
/// An *edge* is where the surface bends by more than 2°, or ends. It is aligned when it is upright
/// within 2°, or its plan is within 2° of one of at most two pairs of directions at right angles
/// (each found by the length that it explains, the second only if that is a tenth of all), or, for
/// edges that slope, of a bisector of a pair: hips.
///
/// An *eave* is a roof's lower border over a wall, or all of a flat roof's (up to 5°) over walls. A
/// roof is a facet that looks up and is no wall.
///
/// *Narrow* is a facet of which twice the area over the perimeter, a long strip's width, is less
/// than the source's noise, or than 1 cm.
///
/// *Unsupported* is surface farther than `support` from the source that can be seen from above the
/// horizon, past the mesh itself, with nothing of the source above it: no piece of source within
/// `support` in plan is as high. So walls that a scan has not seen below a roof, floors and bases
/// count as supported, and tops that stand in the air or over a yard do not. `support`: 0.5 m or 2
/// % of the source's diagonal, of points also twice their spacing.
///
/// *Flaps* are thin bodies: surface behind which, straight inward, the body ends within
/// max(noise, 0.3 m) at a facet that faces the other way by 30°; unless the source shows both sides
/// there, each within that thickness and facing the same way by 60°. Sheets of a source without
/// noise (less than 1 cm) count as both sides, as do points without normals of no side.
///
/// Areas are sampled, some 8,000 points a mesh. Deterministic, in parallel; about 0.1 s a mesh on
/// one core.
class LookGauge {
 public:
  /// Throws Error{kInput} where the source has no finite face with an area, or no finite point.
  explicit LookGauge(const Source& source);
  /// The same where the surface of a mesh is there: saves the time for its rays. It outlives the
  /// gauge; of points it is not asked.
  LookGauge(const Source& source, const Surface& surface);
  ~LookGauge();

  const SourceLooks& source() const;
  /// All zero (shares 1) for a mesh without finite faces.
  Looks look_at(const Mesh& mesh) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// For report.json and `colod eval`: an object with the members of Looks, as `worst` the places by
/// the faults' names, those that there are, and the verdict's `points` and `faults`.
std::string looks_json(const Looks& looks);

}  // namespace colod
