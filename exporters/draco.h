// KHR_draco_mesh_compression's payload; the only door to the Draco encoder.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "../src/geometry.h"

namespace colod {

/// A flat-shaded triangle list ready for encoding: one vertex per corner of a facet (vertices
/// shared within a facet).
struct FlatMesh {
  std::vector<Vec3> positions;             ///< metres, in the axes of the container
  std::vector<Vec3> normals;               ///< unit, per position
  std::vector<std::uint32_t> feature_ids;  ///< per position, or empty
  std::vector<Face> triangles;
};

/// One grid for all parts that must not crack: positions are rounded to origin + step·integer.
struct QuantizationGrid {
  Vec3 origin = Vec3::Zero();
  double range = 1;  ///< metres, of the longest side
  int bits = 14;     ///< 1..30
};

struct DracoResult {
  std::string bytes;
  std::uint32_t vertices = 0, faces = 0;                ///< as a decoder will see them
  Vec3 min, max;                                        ///< of the decoded positions
  int position_id = 0, normal_id = 0, feature_id = -1;  ///< Draco unique ids
};

/// Throws Error{kOutput} when the encoder refuses.
DracoResult encode_draco(const FlatMesh& mesh, const QuantizationGrid& grid);

}  // namespace colod
