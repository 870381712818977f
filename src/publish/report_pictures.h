// Pictures of buildings for the report: the source and each layer through one camera, small PNGs.
#pragma once

#include <cstddef>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "exporters/exporter.h"
#include "image/cache.h"
#include "picture/picture.h"
#include "pipeline/pipeline.h"

namespace colod {

struct PictureOptions {
  int width = 0, height = 0;   ///< pixels; 0: no pictures
  std::size_t most_bytes = 0;  ///< of one picture
  std::size_t every = 1;       ///< about one building in so many has any, by a hash of its name
};

/// So that all pictures of a scene together stay under some 5 MB: many buildings get small
/// pictures, and of very many (some 2,000) only every n-th has any.
PictureOptions picture_options(std::size_t buildings, int layers);

/// PNG bytes of the source, then of each layer, coarsest first; an empty string where there is
/// nothing to see. A part of a layer has the colour of the layer on which its segment appears, what
/// belongs to no segment is grey; a red ring is where its looks are worst (measure/looks.h). Main
/// walls always stand at the same angle, and of the four such
/// views it is the one from which the source shows most. Deterministic, runs in parallel.
std::vector<std::string> draw_building(const Building& building, const PictureOptions& options);

/// JPEG bytes of the source and of each layer with their textures, through the same camera; for
/// layers that wear none an empty string. `building` has its source, `out` the layers' looks.
std::vector<std::string> draw_looks(const Building& building, const ExportBuilding& out,
                                    const ImageCache& images, const PictureOptions& options);

/// The colour of what appears on a layer.
Color layer_color(int layer);
/// Of layers 0 … layers − 1, as CSS writes them.
std::vector<std::string> css_layer_colors(int layers);

/// Draws buildings when their layers are done and their sources still there. A building that cannot
/// be drawn gets a warning. `buildings`: how many there are.
class Gallery {
 public:
  Gallery(std::size_t buildings, int layers);

  /// Thread-safe.
  void draw(Building& building);
  /// Lives no longer than the gallery.
  Observer observer();

  /// One building's pictures, or none.
  std::vector<std::string> take(const std::string& building);
  /// Per building of the scene: its pictures, or none.
  std::vector<std::vector<std::string>> take(const Scene& scene);

 private:
  PictureOptions options_;
  std::mutex mutex_;
  std::map<std::string, std::vector<std::string>> pictures_;
};

}  // namespace colod
