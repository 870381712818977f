// A procedural neighbourhood with ground truth, clean or as a simulated photogrammetry scan.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/element_kind.h"
#include "core/geometry.h"

namespace colod {

struct SynthOptions {
  int buildings = 20;
  std::uint64_t seed = 1;
  bool is_scan =
      false;  ///< visible surface only, noise along the line of sight, holes, no floor, floaters
  double noise = 0.025;  ///< metres, sigma of the scan's noise
  double density = 40;   ///< samples per m² of the scan
};

/// One part of a building: a window, a balcony, a dormer…
struct SynthPart {
  ElementKind kind = ElementKind::kPlain;  ///< kSpire: a church's tower
  std::string model;  ///< the catalogue's entry; equal in all buildings where the part repeats,
                      ///< size and all. Empty for body, roof and tower
  int instance = 0;   ///< its number within the building = the face's object number
  int level = 0;      ///< expected layer for l_n = 3: 0 body, roof, tower; 1 a part with at
                      ///< least 0.4 m of relief and 1.5 m³ of box; 2 all others
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

/// The ground-truth file (JSON text), written beside the meshes as truth.json.
std::string truth_json(const std::vector<SynthBuilding>& buildings, const SynthOptions& options);

/// A building as a file, in world coordinates. OBJ text has a group `<kind>__<instance>` for each
/// part; binary PLY has double coordinates and an int face property `object`.
std::string synth_obj(const SynthBuilding& building);
std::string synth_ply(const SynthBuilding& building);

}  // namespace colod
