// `colod synth --scene`: a made-up scene written tile by tile.
#pragma once

#include <string>

#include "synth/scene_files.h"

namespace colod::cli {

/// Tiles in their layout in DIR/scene, what is true of them in DIR/truth: apart, so that clean
/// models are not taken for tiles. Memory follows the tiles that are made at the same time.
void write_synth_scene(const SynthSceneOptions& options, SynthLayout layout,
                       const std::string& out);

}  // namespace colod::cli
