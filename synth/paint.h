// Made-up houses as photogrammetry gives them: with an atlas of small charts, light baked in.
#pragma once

#include "synth.h"

namespace colod {

/// An OBJ, the MTL that it names and the image that this names.
struct PaintedModel {
  std::string obj, mtl, image;  ///< the image is a JPEG
};

/// Brick or plaster on walls, tiles on roofs, glass in windows, wood on doors, and on every wall a
/// word, which shows whether a picture is mirrored or turned. What a place looks like depends on
/// the place alone, and of a scan on the place of `clean`, its model before it was scanned, that is
/// nearest: its bumps show what a camera saw. `texel`: metres, of most charts; some are coarser, as
/// pictures from farther away make them. Files are named after the building; groups
/// are numbered as the truth does, floaters last. Deterministic.
PaintedModel paint(const SynthBuilding& building, double texel,
                   const SynthBuilding* clean = nullptr);

}  // namespace colod
