// 3D Tiles 1.1: tileset.json and tiles/ over all buildings' layers, geometric errors measured.
#pragma once

#include "exporter.h"

namespace colod {

struct TilesOptions {
  Compression compression = Compression::kDraco;
  double quantization = 0.01;  ///< metres: bound on the position error, finer for the finest layer
  double target_sse = 16;      ///< k = target_sse / pixel_error scales the measured deviation
  double pixel_error = 2;
  Placement placement = {};  ///< empty: the frame is local and no place on Earth is made up
};

/// First of the result is tileset.json, last written. Frames have their origin at the middle of the
/// buildings' foot, to the metre; its world position is in asset.extras. Boxes in z-up tile space,
/// children inside parents, errors strictly falling, leaves 0. Beyond 256 buildings or a kilometre,
/// cells are tilesets of their own, tiles/<cell>/tileset.json. Runs in parallel. Throws
/// Error{kOutput} for a building without layers or triangles.
std::vector<Encoded> encode_tileset(const std::vector<ExportBuilding>& buildings,
                                    const TilesOptions& options = {});

}  // namespace colod
