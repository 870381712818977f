// KHR_draco_mesh_compression's payload; the only door to the Draco encoder.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/geometry.h"

namespace colod {

/// A flat-shaded triangle list ready for encoding: one vertex per corner of a facet (vertices
/// shared within a facet).
struct FlatMesh {
  std::vector<Vec3> positions;             ///< metres, in the axes of the container
  std::vector<Vec3> normals;               ///< unit, per position, or empty
  std::vector<std::uint32_t> feature_ids;  ///< per position, or empty
  std::vector<Vec2f> uvs;                  ///< per position, or empty
  std::vector<Rgb> colors;                 ///< per position, or empty
  int texture_side = 0;                    ///< texels of the longer side that uvs are of
  std::vector<Face> triangles;
};

/// One grid for all parts that must not crack: positions are rounded to origin + step·integer.
struct QuantizationGrid {
  Vec3 origin = Vec3::Zero();
  double range = 1;  ///< metres, of the longest side
  int bits = 14;     ///< 1..30

  double step() const { return range / ((std::int64_t{1} << bits) - 1); }
  /// Largest distance that rounding moves a position.
  double error() const { return 0.5 * std::sqrt(3.0) * step(); }
  Vec3 round(const Vec3& p) const {
    return origin + ((p - origin) / step()).array().round().matrix() * step();
  }
};

/// The coarsest grid over `box` that moves no position farther than `bound` metres. Its step is a
/// power of two and its origin a multiple of it, so that grids nest and decoded floats are exact;
/// 8 to 24 bits (a float holds no more), hence a wider step for boxes beyond 2^24 steps.
QuantizationGrid fit_grid(const Box& box, double bound);

/// The grid of this step (a power of two) about one tile's or mesh's box.
QuantizationGrid grid_about(const Box& box, double step);

struct DracoResult {
  std::string bytes;
  std::uint32_t vertices = 0, faces = 0;                           ///< as a decoder will see them
  Vec3 min, max;                                                   ///< of the decoded positions
  int position_id = 0;                                             ///< Draco unique ids …
  int normal_id = -1, feature_id = -1, uv_id = -1, color_id = -1;  ///< … −1: there are none
};

/// COLOR_0 as glTF wants it: linear light, opaque; 16 bits, since 8 part dark colours too coarsely.
std::array<std::uint16_t, 4> linear_color(const Rgb& rgb);

/// Triangles with two corners on one point must have been left out. Throws Error{kOutput} when the
/// encoder refuses or loses a face.
DracoResult encode_draco(const FlatMesh& mesh, const QuantizationGrid& grid);

/// What a decoder finds in a stream, for checks: values by Draco unique id.
struct DracoContent {
  struct Attribute {
    int components = 0;
    std::vector<double> values;  ///< `components` a vertex
  };
  std::size_t vertices = 0;
  std::vector<Face> faces;
  std::map<int, Attribute> attributes;
};

/// Faces and vertices as the stream's header states them, before any memory is taken for them.
/// Throws Error{kInput} when it is no stream of version 2.2, which all writers in use make, or when
/// so few bytes cannot hold them.
struct DracoCounts {
  std::size_t faces = 0, vertices = 0;
};
DracoCounts stated_counts(const std::string& bytes);

/// Throws Error{kInput} when it does not decode, or states more than it can hold.
DracoContent decode_draco(const std::string& bytes);

}  // namespace colod
