// 3D Tiles 1.1: tileset.json and tiles/*.glb over all buildings' layers, geometric errors measured.
#pragma once

#include "exporter.h"

namespace colod {

struct TilesOptions {
  bool has_draco = true;
  double quantization = 0.01;  ///< metres
  double target_sse = 16;      ///< k = target_sse / pixel_error scales the measured deviation
  double pixel_error = 2;
};

/// First of the result is tileset.json. Local frame: the tileset's origin is the scene's centre on
/// its foot; the offset is in asset.extras. Boxes in z-up tile space, children inside parents,
/// errors strictly falling, leaves 0.
std::vector<Encoded> encode_tileset(const std::vector<ExportBuilding>& buildings,
                                    const TilesOptions& options = {});

}  // namespace colod
