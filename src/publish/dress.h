// A building's layers in what its source looks like.
#pragma once

#include "exporters/exporter.h"
#include "image/cache.h"
#include "outputs.h"

namespace colod {

/// Whether a texture or colours are made for it.
bool is_dressed(const Building& building, const TextureOptions& options);

/// Gives each level its look, and notes in the building's layers what it is, in its warnings which
/// images are doubtful, and which are lost. `building` has its source. A level's texel is as large
/// as a pixel is where the level may stand.
void dress(Building& building, const TextureOptions& options, const ImageCache& images,
           ExportBuilding& out);

}  // namespace colod
