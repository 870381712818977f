// Pictures by our own ray caster, for reports, contact sheets and looking: flat shaded,
// orthographic or perspective-free.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/geometry.h"

namespace colod {

class LookSampler;

struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  ///< width × height × 3, top row first
};

using Color = std::array<std::uint8_t, 3>;
inline constexpr Color kBackground{250, 250, 250};  ///< of every picture

struct PreviewOptions {
  int width = 480, height = 360;
  double azimuth_deg = 35,
         elevation_deg = 28;  ///< where the camera looks from; azimuth 0 = from −y (south)
  int samples = 2;            ///< rays along a pixel's side
  bool has_edges = true;      ///< dark lines where neighbouring pixels see different facets
  Box box;  ///< what to frame; empty: the mesh's own box. The same box gives the same camera
  std::vector<Vec3> marks =
      {};  ///< places of a mesh that get a red ring, also those that are hidden
};

/// `facet_of_face` (edges, empty: by normal) and `color_of_face` (empty: light grey) are per face.
/// Back faces are drawn dark red, so that a flipped face shows. Renders in parallel, deterministic.
Image render_preview(const Mesh& mesh, const PreviewOptions& options = {},
                     const std::vector<int>& facet_of_face = {},
                     const std::vector<Color>& color_of_face = {});
/// What the mesh looks like, without light of its own: the light is in its texture.
Image render_preview(const Mesh& mesh, const LookSampler& look, const PreviewOptions& options = {});
/// Points as small discs.
Image render_preview(const PointCloud& cloud, const PreviewOptions& options = {});

/// Images side by side in rows of `columns`, white gaps, one line of text under each (empty: none).
Image contact_sheet(const std::vector<Image>& images, const std::vector<std::string>& captions,
                    int columns);
/// PNG bytes.
std::string encode_png(const Image& image);
/// PNG bytes for a page that holds many: at most 64 colours, the background transparent. While they
/// are more than `most`, colours are given up and then pixels, down to 16 a side.
std::string encode_small_png(const Image& image, std::size_t most);
/// A colour for each id, well apart for neighbouring ids.
Color palette(int id);

}  // namespace colod
