// What a place on a surface looks like.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "cache.h"
#include "core/geometry.h"

namespace colod {

using Light = Eigen::Vector3f;  ///< linear, 0..1

/// Texels of an image that a sample covers at most: beyond it charts of its atlas run together.
inline constexpr double kMostTexels = 4;

/// Images that one thread looks at, so that each place need not ask the cache: the two used last.
class Lens {
 public:
  explicit Lens(const ImageCache& cache) : cache_(cache) {}
  /// Null: it cannot be read.
  const Pyramid* look(const ImagePlace& place, int number);
  /// How often an image was let go of: pointers to it are good as long as this stays.
  int changes() const { return changes_; }
  /// How much of each corner of a face a point of its plane is.
  Vec3 weights(const Mesh& mesh, int face, const Vec3& point);

 private:
  struct Held {
    int number = -1;
    std::shared_ptr<const Pyramid> pyramid;
  };
  const ImageCache& cache_;
  std::array<Held, 2> held_;
  int changes_ = 0;
  // Of the face that was asked for last, since the next texel mostly shows it, too.
  const Mesh* mesh_ = nullptr;
  int face_ = -1;
  CornerWeights weights_;
};

/// What a face looks like, worked out once for many places of it. It points into the mesh's look
/// and into an image that a lens holds.
class FaceLook {
 public:
  /// `weight`: how much of each corner a place is, together 1.
  Light at(const Vec3& weight) const;

 private:
  friend class LookSampler;

  const std::array<Rgb, 3>* colors_ = nullptr;  // null: none
  Light tint_ = Light::Ones();
  const Material* material_ = nullptr;
  const std::array<Vec2f, 3>* uvs_ = nullptr;
  const Raster* fine_ = nullptr;  // null: no image, or the same everywhere
  const Raster* coarse_ = nullptr;
  float share_ = 0;  // of the coarser level
};

/// A mesh with its look. Keeps references to all that it is given.
class LookSampler {
 public:
  /// Decodes each image once, to learn its size.
  LookSampler(const Mesh& mesh, const Appearance& look, const ImageCache& cache);

  /// What a face looks like at a point of its plane; `spacing`: metres from one sample to the next.
  /// Where a face has an image and no coordinates, or none that are numbers, the image's mean.
  Light sample(int face, const Vec3& point, double spacing, Lens& lens) const;
  /// The same for many places of a face: good until lens.changes() does.
  FaceLook look_at(int face, double spacing, Lens& lens) const;
  /// Whether a place of a face is cut out by its image's transparency. Never where !has_holes().
  bool is_hole(int face, const Vec3& point, Lens& lens) const;
  /// Whether a material is seen through where its image is transparent, and it is somewhere.
  bool has_holes() const { return has_holes_; }
  /// Metres, of the source's texels: the mean over its textured area; without images, of its faces.
  double texel() const { return texel_; }
  const ImageCache& cache() const { return cache_; }
  /// Whether there is an image that can be read.
  bool has_images() const { return has_images_; }
  /// Whether places look unlike: there is one, or colours.
  bool has_detail() const { return has_images_ || !look_.colors.empty(); }
  /// One line for each image that faces without coordinates wear, or that was converted by guess;
  /// names its file.
  const std::vector<std::string>& warnings() const { return warnings_; }
  /// One line for each image that faces wear and that is not there, or not whole; names its file.
  const std::vector<std::string>& losses() const { return losses_; }

 private:
  /// What faces make of an image.
  struct Wear {
    int faces = 0, without = 0;  ///< that wear it; of them without coordinates
    std::string material;        ///< of the first of them
  };
  std::vector<Wear> find_wear() const;
  Vec2 place_of(std::size_t face, const Vec3& weight) const;
  bool has_place(std::size_t face) const;
  /// How large texels are, by face and all in all.
  void measure_texels(const std::vector<ImageCache::Facts>& facts);

  const Mesh& mesh_;
  const Appearance& look_;
  const ImageCache& cache_;
  std::vector<float> texel_of_face_;  // metres; 0: no image
  double texel_ = 0;
  bool has_images_ = false, has_holes_ = false;
  std::vector<std::string> warnings_, losses_;
};

}  // namespace colod
