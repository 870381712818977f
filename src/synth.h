// A procedural neighbourhood with ground truth, clean or as a simulated photogrammetry scan.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "geometry.h"

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
  std::string type;  ///< body, roof, window, door, balcony, dormer, chimney, recess, bay, …
  int instance = 0;  ///< its number within the building = the face's object number
  int level = 0;     ///< expected layer for l_n = 3: 0 body and roof, 1 large parts, 2 small ones
  double depth = 0;  ///< metres of relief against its parent
  Box box;           ///< world
};

struct SynthBuilding {
  std::string style;
  Source
      source;  ///< world coordinates; `face_object` = SynthPart::instance (−1: floater of a scan)
  std::vector<SynthPart> parts;
};

std::vector<SynthBuilding> make_neighbourhood(const SynthOptions& options = {});

/// The ground-truth file (JSON text), written beside the meshes as truth.json.
std::string truth_json(const std::vector<SynthBuilding>& buildings, const SynthOptions& options);

}  // namespace colod
