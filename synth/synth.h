// A procedural neighbourhood with ground truth, clean or as a simulated photogrammetry scan.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/element_kind.h"
#include "core/geometry.h"

namespace colod {

/// How large the parts of one kind are in a neighbourhood.
enum class SynthSizes {
  kAlike,  ///< as builders make them: a chimney is smaller than a dormer
  kMixed   ///< from tiny to huge in every kind, so that no size tells a kind
};

/// What stands in a varied neighbourhood.
enum class SynthPlans { kAny, kHalls, kOffices };

struct SynthOptions {
  int buildings = 20;
  std::uint64_t seed = 1;
  bool is_scan =
      false;  ///< visible surface only, noise along the line of sight, holes, no floor, floaters
  bool is_drone = false;   ///< as drone photogrammetry gives it: bulging, melted, with ground and
                           ///< trees; is_scan, noise and density then say nothing
  double scan_edge = 0.6;  ///< metres, the median edge of a drone's mesh
  double noise = 0.025;    ///< metres, sigma of the scan's noise
  double density = 40;     ///< samples per m² of the scan
  SynthSizes sizes = SynthSizes::kAlike;  ///< not with is_varied
  bool is_varied = false;  ///< plans, roofs and makes from wide ranges, for development and tests
  SynthPlans plans = SynthPlans::kAny;  ///< of varied houses
  bool has_slopes = false;              ///< varied houses stand on sloping ground
};

/// One part of a building: a window, a balcony, a dormer…
struct SynthPart {
  ElementKind kind = ElementKind::kPlain;  ///< kSpire: a church's tower
  std::string model;  ///< the catalogue's entry; equal in all buildings where the part repeats,
                      ///< size and all. Empty for body, roof and tower
  int instance = 0;   ///< its number within the building = the face's object number
  int level = 0;      ///< expected layer for l_n = 3: 0 body, roof, tower; 1 a part with at
                      ///< least 0.4 m of relief and 1.5 m³ of box; 2 all others. With mixed
                      ///< sizes the kind decides: 2 windows, doors and ornaments
  double depth = 0;   ///< metres of relief against its parent
  Box box;            ///< world
};

struct SynthBuilding {
  std::string style;
  Source
      source;  ///< world coordinates; `face_object` = SynthPart::instance (−1: floater of a scan)
  std::vector<SynthPart> parts;
};

/// Houses along two streets, facing them. Every clean model is closed, 2-manifold, outward and free
/// of self-intersections; coordinates are whole micrometres. Throws Error when there is nothing to
/// build. Deterministic; a building depends on the seed and its number only, a scan on its
/// neighbours too.
std::vector<SynthBuilding> make_neighbourhood(const SynthOptions& options = {});

/// Houses whose numbers follow each other.
struct SynthBatch {
  std::vector<SynthBuilding> buildings;
  std::vector<SynthBuilding> clean;  ///< what a scan was made of; else none
};

/// The same buildings, in order and a few at a time, so that memory does not grow with their
/// number: houses are made once to place them all and again when it is their, or a scanned
/// neighbour's, turn.
void stream_neighbourhood(const SynthOptions& options,
                          const std::function<void(const SynthBatch&)>& take);

/// The ground-truth file (JSON text), written beside the meshes as truth.json.
std::string truth_json(const std::vector<SynthBuilding>& buildings, const SynthOptions& options);
/// The same in pieces: the entries stand between both, separated by ",\n".
std::string truth_before(const SynthOptions& options);
std::string truth_entry(const SynthBuilding& building);
std::string truth_after();

/// A building as a file, in world coordinates. OBJ text has a group `<kind>__<instance>` for each
/// part; binary PLY has double coordinates and an int face property `object`.
std::string synth_obj(const SynthBuilding& building);
std::string synth_ply(const SynthBuilding& building);

}  // namespace colod
