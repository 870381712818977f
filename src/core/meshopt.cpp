// Based on: EXT_meshopt_compression (ratified), meshoptimizer's codecs of version 0.
// Differs: nothing; the floats are rounded to a power-of-two grid before, which the codec rewards.
#include "meshopt.h"

#include <meshoptimizer.h>

namespace colod {

IndexedMesh::IndexedMesh(const Mesh& mesh) {
  const Vec3 center = bounding_box(mesh.vertices).center();
  for (const Vec3& v : mesh.vertices)
    for (int k = 0; k < 3; ++k) positions.push_back(static_cast<float>(v[k] - center[k]));
  for (const Face& f : mesh.faces)
    for (const int v : f) indices.push_back(static_cast<std::uint32_t>(v));
}

std::vector<Face> faces_of(const std::vector<std::uint32_t>& indices) {
  std::vector<Face> faces;
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
    faces.push_back({static_cast<int>(indices[i]), static_cast<int>(indices[i + 1]),
                     static_cast<int>(indices[i + 2])});
  return faces;
}

namespace {

const unsigned char* data_of(std::string_view s) {
  return reinterpret_cast<const unsigned char*>(s.data());
}

/// Undoes a filter in place; false: there is no such one, or none of that stride.
bool undo_filter(std::string& bytes, std::size_t count, std::size_t stride,
                 const std::string& filter) {
  if (filter == "NONE") return true;
  if (filter == "OCTAHEDRAL" && (stride == 4 || stride == 8))
    return meshopt_decodeFilterOct(bytes.data(), count, stride), true;
  if (filter == "QUATERNION" && stride == 8)
    return meshopt_decodeFilterQuat(bytes.data(), count, stride), true;
  if (filter == "EXPONENTIAL" && stride % 4 == 0)
    return meshopt_decodeFilterExp(bytes.data(), count, stride), true;
  return false;
}

}  // namespace

std::vector<std::uint32_t> simplify_indices(const std::vector<float>& positions,
                                            const std::vector<std::uint32_t>& indices,
                                            std::size_t count) {
  constexpr float kAnyError = 1e10f;
  std::vector<std::uint32_t> kept(indices.size());
  kept.resize(meshopt_simplify(kept.data(), indices.data(), indices.size(), positions.data(),
                               positions.size() / 3, 3 * sizeof(float), count, kAnyError, 0,
                               nullptr));
  return kept;
}

namespace {

/// The library can lock all of a border or nothing. Vertices at which more than two open edges end
/// are locked, too: each that is to stay gets triangles of its own, which hang on nothing else.
void hang_on_locked(std::vector<float>& positions, std::vector<std::uint32_t>& indices,
                    const std::vector<char>& is_locked) {
  constexpr float kSide = 0.01f;  // as large as not to vanish in a float of kilometres
  for (std::size_t v = 0; v < is_locked.size(); ++v) {
    if (!is_locked[v]) continue;
    for (const float side : {kSide, -kSide}) {
      const auto first = static_cast<std::uint32_t>(positions.size() / 3);
      for (const float up : {side, 2 * side})
        for (std::size_t k = 0; k < 3; ++k)
          positions.push_back(positions[3 * v + k] + (k == 2 ? up : k == 0 ? side : 0));
      for (const std::uint32_t i : {static_cast<std::uint32_t>(v), first, first + 1})
        indices.push_back(i);
    }
  }
}

}  // namespace

std::vector<std::uint32_t> simplify_within(const std::vector<float>& positions,
                                           const std::vector<std::uint32_t>& indices,
                                           const std::vector<char>& is_locked, float error) {
  const std::size_t own = positions.size() / 3;
  std::vector<float> all = positions;
  std::vector<std::uint32_t> in = indices;
  hang_on_locked(all, in, is_locked);
  const float scale = meshopt_simplifyScale(all.data(), all.size() / 3, 3 * sizeof(float));
  std::vector<std::uint32_t> out(in.size());
  out.resize(meshopt_simplify(out.data(), in.data(), in.size(), all.data(), all.size() / 3,
                              3 * sizeof(float), 0, scale > 0 ? error / scale : 0, 0, nullptr));
  std::vector<std::uint32_t> kept;
  for (std::size_t i = 0; i + 2 < out.size(); i += 3)
    if (out[i] < own && out[i + 1] < own && out[i + 2] < own)
      kept.insert(kept.end(), out.begin() + static_cast<std::ptrdiff_t>(i),
                  out.begin() + static_cast<std::ptrdiff_t>(i + 3));
  return kept;
}

void optimize_order(std::vector<std::uint32_t>& indices, std::size_t vertices,
                    std::vector<std::uint32_t>& order) {
  std::vector<std::uint32_t> sorted(indices.size()), remap(vertices);
  meshopt_optimizeVertexCache(sorted.data(), indices.data(), indices.size(), vertices);
  const std::size_t used =
      meshopt_optimizeVertexFetchRemap(remap.data(), sorted.data(), sorted.size(), vertices);
  meshopt_remapIndexBuffer(indices.data(), sorted.data(), sorted.size(), remap.data());
  order.assign(used, 0);
  for (std::uint32_t v = 0; v < vertices; ++v)
    if (remap[v] != ~0u) order[remap[v]] = v;
}

std::vector<std::uint32_t> order_in_space(const std::vector<Vec3>& points) {
  const Vec3 center = bounding_box(points).center();
  std::vector<float> positions;
  positions.reserve(3 * points.size());
  for (const Vec3& p : points)
    for (int k = 0; k < 3; ++k) positions.push_back(static_cast<float>(p[k] - center[k]));
  std::vector<std::uint32_t> place(points.size()), order(points.size());
  meshopt_spatialSortRemap(place.data(), positions.data(), points.size(), 3 * sizeof(float));
  for (std::uint32_t i = 0; i < place.size(); ++i) order[place[i]] = i;
  return order;
}

std::string encode_meshopt_indices(const std::vector<std::uint32_t>& indices,
                                   std::size_t vertices) {
  static const bool has_version = (meshopt_encodeIndexVersion(1), true);  // the extension's
  (void)has_version;
  std::vector<unsigned char> out(meshopt_encodeIndexBufferBound(indices.size(), vertices));
  out.resize(meshopt_encodeIndexBuffer(out.data(), out.size(), indices.data(), indices.size()));
  return {out.begin(), out.end()};
}

std::string encode_meshopt_vertices(const std::string& bytes, std::size_t stride) {
  const std::size_t count = bytes.size() / stride;
  static const bool has_version = (meshopt_encodeVertexVersion(0), true);  // the extension's
  (void)has_version;
  std::vector<unsigned char> out(meshopt_encodeVertexBufferBound(count, stride));
  out.resize(meshopt_encodeVertexBuffer(out.data(), out.size(), bytes.data(), count, stride));
  return {out.begin(), out.end()};
}

std::vector<std::uint32_t> decode_meshopt_indices(const std::string& payload, std::size_t count) {
  std::vector<std::uint32_t> out(count);
  if (meshopt_decodeIndexBuffer(out.data(), count, 4, data_of(payload), payload.size()) != 0)
    out.clear();
  return out;
}

std::string decode_meshopt_vertices(const std::string& payload, std::size_t count,
                                    std::size_t stride) {
  std::string out(count * stride, '\0');
  if (meshopt_decodeVertexBuffer(out.data(), count, stride, data_of(payload), payload.size()) != 0)
    out.clear();
  return out;
}

std::string decode_meshopt(std::string_view payload, std::size_t count, std::size_t stride,
                           const std::string& mode, const std::string& filter) {
  std::string out(count * stride, '\0');
  const bool is_index = stride == 2 || stride == 4;
  int problem = 1;
  if (mode == "ATTRIBUTES" && stride > 0 && stride <= 256 && stride % 4 == 0)
    problem =
        meshopt_decodeVertexBuffer(out.data(), count, stride, data_of(payload), payload.size());
  else if (mode == "TRIANGLES" && is_index && count % 3 == 0)
    problem =
        meshopt_decodeIndexBuffer(out.data(), count, stride, data_of(payload), payload.size());
  else if (mode == "INDICES" && is_index)
    problem =
        meshopt_decodeIndexSequence(out.data(), count, stride, data_of(payload), payload.size());
  if (problem != 0 || !undo_filter(out, count, stride, filter)) out.clear();
  return out;
}

}  // namespace colod
