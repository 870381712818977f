// The only door to meshoptimizer: EXT_meshopt_compression's payloads, orders, and quadric
// collapse.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "geometry.h"

namespace colod {

/// A mesh as meshoptimizer takes it: three numbers a vertex, from the middle of the mesh's box, and
/// three indices a face.
struct IndexedMesh {
  std::vector<float> positions;
  std::vector<std::uint32_t> indices;

  explicit IndexedMesh(const Mesh& mesh);
};

/// The faces that indices stand for.
std::vector<Face> faces_of(const std::vector<std::uint32_t>& indices);

/// Reorders triangles for the vertex cache and numbers vertices by first use: `order[new]` = old
/// vertex. `indices` hold the new numbers.
void optimize_order(std::vector<std::uint32_t>& indices, std::size_t vertices,
                    std::vector<std::uint32_t>& order);

/// The points' numbers in an order in which those that follow one another mostly lie near one
/// another (Morton's).
std::vector<std::uint32_t> order_in_space(const std::vector<Vec3>& points);

/// Collapses edges until `count` indices are left, or as few as the shape's topology allows,
/// however far that is from the shape. `positions`: three numbers a vertex; vertices stay where
/// they are.
std::vector<std::uint32_t> simplify_indices(const std::vector<float>& positions,
                                            const std::vector<std::uint32_t>& indices,
                                            std::size_t count);

/// Collapses edges while quadrics tell of no more than `error`, in the unit of `positions`.
/// `is_locked`, per vertex: it stays where it is, and so does what its triangles touch of a border
/// there; borders that nothing locks are straightened as surfaces are.
std::vector<std::uint32_t> simplify_within(const std::vector<float>& positions,
                                           const std::vector<std::uint32_t>& indices,
                                           const std::vector<char>& is_locked, float error);

/// mode TRIANGLES. A decoder may turn triangles.
std::string encode_meshopt_indices(const std::vector<std::uint32_t>& indices, std::size_t vertices);

/// mode ATTRIBUTES; `bytes` holds elements of `stride` bytes, a multiple of 4.
std::string encode_meshopt_vertices(const std::string& bytes, std::size_t stride);

/// What a client will see; empty when the payload is damaged.
std::vector<std::uint32_t> decode_meshopt_indices(const std::string& payload, std::size_t count);
std::string decode_meshopt_vertices(const std::string& payload, std::size_t count,
                                    std::size_t stride);

/// A whole buffer view of the extension as any writer may pack it: `mode` ATTRIBUTES, TRIANGLES or
/// INDICES, `filter` NONE, OCTAHEDRAL, QUATERNION or EXPONENTIAL. count × stride bytes; empty when
/// the payload is damaged or mode, filter, count and stride do not go together.
std::string decode_meshopt(std::string_view payload, std::size_t count, std::size_t stride,
                           const std::string& mode, const std::string& filter);

}  // namespace colod
