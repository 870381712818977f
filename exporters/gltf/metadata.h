// EXT_mesh_features and EXT_structural_metadata: which building and layer a vertex belongs to.
#pragma once

#include "gltf.h"

namespace colod {

/// A row of the property table.
struct Feature {
  std::string name;  ///< the building's; of several, the first ones' and how many more
  int layer = -1;    ///< −1: a stand-in, coarser than layer 0; of alike layers the finest …
  int coarsest_layer = -1;  ///< … and the coarsest
  double gsd = 0;           ///< metres a pixel, from where on it is shown
  double deviation = 0;     ///< metres from the finest layer, rounding included
  std::string source;       ///< file; empty where several differ
  std::size_t faces = 0;    ///< triangles as written
  std::string given_name;   ///< as the input writes the name
  /// Names and values: a column each, empty where others have it alone.
  std::vector<std::pair<std::string, std::string>> attributes = {};
};

/// The name for readers: as the input writes it, where it writes one.
const std::string& shown_name(const ExportBuilding& building);

constexpr int kMostFeatures = 1 << 24;  ///< ids beyond are no exact floats

/// The row of one building's level.
Feature feature_of(const ExportBuilding& building, const ExportLevel& level, double deviation,
                   std::size_t faces);

/// As in asset.extras: measure, scope, bounds in pixels, viewport and the scene's gsd per layer.
nlohmann::ordered_json switching_json(const SwitchFacts& facts);

/// Adds the schema and one property table with these rows; names the extensions.
void add_features(GltfDocument& document, const std::vector<Feature>& features);

/// What a primitive with ids in _FEATURE_ID_0 says: ids 0 … count − 1 are rows of that table.
nlohmann::ordered_json feature_ids(std::size_t count);

}  // namespace colod
