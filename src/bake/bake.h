// A source's appearance and a layer's mesh → the layer's own texture, at the size of the pixels
// that it is seen at.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/geometry.h"
#include "image/image.h"

namespace colod {

class ImageCache;

struct BakeOptions {
  double texel = 0;    ///< metres a side; 0: as fine as the source, which it never falls below
  int largest = 4096;  ///< texels a side of the atlas
  double reach = 0.5;  ///< metres, along a facet's normal and about it, within which the source is
                       ///< looked for
  bool has_normals = false;  ///< a normal map, too
};

/// What a texture is, and where its texels come from.
struct BakeFacts {
  int width = 0, height = 0;  ///< texels
  double texel = 0;           ///< metres a side; more than asked where the atlas would not fit
  int charts = 0;
  /// Shares of the texels on the surface, 0..1, together 1: seen along the normal; by the nearest
  /// point; filled from neighbours or with the facet's mean; no part of the source near them, so a
  /// mean stands for them.
  double seen = 0, nearest = 0, filled = 0, unseen = 0;
};

struct BakedTexture {
  Raster image;
  /// As large as the image, or empty: how the source is turned against the facet, x right, y up and
  /// z outward on the chart, −1..1 as 0..255; outward where nothing is known.
  Raster normals;
  std::vector<std::array<Vec2f, 3>>
      uvs;  ///< per triangle of the mesh; 0,0 is the upper left corner
  BakeFacts facts;
};

/// A coloured cloud as a surface: a square a point, as wide as the cloud is dense there.
struct Splats {
  Mesh mesh;
  Appearance look;
  double spacing = 0;  ///< metres from point to point, the median
};

/// `colors` is as long as `cloud.points`; the cloud has normals. O(points · log points), in
/// parallel.
Splats splat_points(const PointCloud& cloud, const std::vector<std::array<Rgb, 3>>& colors);

/// Which sides of a source's faces are its outside.
enum class Sides { kFront, kBoth };

/// One building's source, ready to be looked at. Keeps references to what it is given.
class Baker {
 public:
  /// Reads all images once.
  Baker(const Mesh& source, const Appearance& look, const ImageCache& cache,
        Sides sides = Sides::kFront);
  ~Baker();

  /// Charts are facets, those in one plane that share edges together; each is turned to its
  /// smallest rectangle and drawn at one scale, without distortion. A texel shows what the nearest
  /// surface along the facet's normal shows whose normal agrees, else the nearest point; the mean
  /// of several samples, in linear light, of the source's mip level that fits. What is left is
  /// filled from its neighbours, farther than half a metre from them with the facet's mean. A facet
  /// of which nothing is seen has the mean of the building's walls or of its other facets, and a
  /// single block of the atlas.
  /// `mesh` is in the source's coordinates, its vertices shared between facets. Deterministic, runs
  /// in parallel. Throws Error{kStage} where `largest` is too small for the number of charts.
  BakedTexture bake(const PolygonMesh& mesh, const BakeOptions& options) const;

  /// One colour a facet: the mean of what is seen of it.
  std::vector<Rgb> facet_colors(const PolygonMesh& mesh, double reach) const;

  /// Whether places of the source look unlike: it has an image that can be read, or colours.
  bool has_detail() const;
  /// What LookSampler says of images.
  const std::vector<std::string>& warnings() const;
  const std::vector<std::string>& losses() const;
  /// Metres, of the source's own texels.
  double source_texel() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace colod
