// Exports that a game engine's importer takes as they are: one plain GLB a level, and lods.json
// with when to show which.
#pragma once

#include "exporters/exporter.h"

namespace colod {

struct EngineOptions {
  double quantization = 0.01;  ///< metres: positions stay within it, finer for the finest layer
  SwitchFacts switching = {};
};

/// engine/<name>_LOD<n>.glb, n = 0 the finest: uncompressed, y up, metres, pivot at the middle of
/// the footprint on the ground, one node, mesh, material and draw call; its image, which needs the
/// pixels of the level's look, has sides that are powers of two. Throws Error{kOutput} for a
/// building without layers or triangles.
std::vector<Encoded> encode_engine_levels(const ExportBuilding& building,
                                          const EngineOptions& options = {});

/// engine/lods.json over all buildings: pivots in the world, and per level its gsd, deviation,
/// switch distance and screen size.
Encoded encode_lods_json(const std::vector<ExportBuilding>& buildings,
                         const EngineOptions& options = {});

/// The same in pieces, for buildings that are not all in memory: one building's entry as JSON text,
/// and the file of all entries.
std::string lods_entry(const ExportBuilding& building, const EngineOptions& options = {});
Encoded encode_lods_json(const std::vector<std::string>& entries,
                         const EngineOptions& options = {});

}  // namespace colod
