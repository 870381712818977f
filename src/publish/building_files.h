// Inside room `publish`: one building to its files.
#pragma once

#include "exporters/exporter.h"
#include "exporters/gltf/engine.h"
#include "image/cache.h"
#include "outputs.h"
#include "report_pictures.h"

namespace colod {

/// What all buildings of a scene are written with.
struct Writer {
  const OutputOptions& options;
  SwitchFacts facts;
  const ImageCache& images;
  PictureOptions look;  ///< of pictures of looks
};

/// Whether a format is among those that are written.
bool writes(const OutputOptions& options, const char* format);

EngineOptions engine_options(const OutputOptions& options, const SwitchFacts& facts);

/// Dresses the levels of `out`, and makes the building's own files. One that cannot be encoded
/// fails alone. Of the levels' pixels the coarsest's stay. `pictures`, which may be null, get those
/// of its looks.
void encode_building(ExportBuilding& out, const Writer& writer, Depot& depot, Building& building,
                     std::vector<std::string>* pictures, const Take& take);

}  // namespace colod
