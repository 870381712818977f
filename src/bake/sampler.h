// Inside room `bake` only: what a place on the source looks like.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "core/geometry.h"
#include "image/cache.h"

namespace colod::bake {

using Light = Eigen::Vector3f;  ///< linear, 0..1

/// Images that one thread looks at, so that each place need not ask the cache: the two used last.
class Lens {
 public:
  explicit Lens(const ImageCache& cache) : cache_(cache) {}
  /// Null: it cannot be read.
  const Pyramid* look(const ImagePlace& place, int number);

 private:
  struct Held {
    int number = -1;
    std::shared_ptr<const Pyramid> pyramid;
  };
  const ImageCache& cache_;
  std::array<Held, 2> held_;
};

/// The surface of a source. Keeps references to all that it is given.
class Sampler {
 public:
  /// Decodes each image once, to learn its size.
  Sampler(const Mesh& mesh, const Appearance& look, const ImageCache& cache);

  /// What a face looks like at a point of its plane; `spacing`: metres from one sample to the next.
  Light sample(int face, const Vec3& point, double spacing, Lens& lens) const;
  /// Metres, of the source's texels: the mean over its textured area; without images, of its faces.
  double texel() const { return texel_; }
  /// One line for each image with a fault.
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  const Mesh& mesh_;
  const Appearance& look_;
  const ImageCache& cache_;
  std::vector<float> texel_of_face_;  // metres; 0: no image
  double texel_ = 0;
  std::vector<std::string> warnings_;
};

}  // namespace colod::bake
