// Shared by glb.cpp and exporters/tiles3d/tiles3d.cpp: a glTF document and its binary chunk as they
// grow.
//
// nlohmann-json and this container instead of a glTF library: Draco primitives and property tables
// are mostly extension objects, which libraries take as trees of their own, and they decide
// themselves about the order of buffers, which matters here (coarsest level first).
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/bytes.h"
#include "draco.h"
#include "exporters/exporter.h"

namespace colod {

/// Of the bound on positions, in a finest layer: a rounding that shows only close by.
constexpr double kFinestShare = 0.3;

/// A growing document: JSON and the BIN chunk it points into.
struct GltfDocument {
  nlohmann::ordered_json json;
  std::string binary;
  std::size_t unpacked_bytes = 0;  ///< of the buffer that EXT_meshopt_compression stands for
};

/// A document with the asset, one material and no content.
GltfDocument start_gltf();

/// Appends `bytes` as a buffer view that starts at a multiple of 8; `target` is glTF's hint or 0.
int add_buffer_view(GltfDocument& document, const std::string& bytes, int target = 0);

/// Appends the mesh as one primitive and returns it. A Draco primitive takes one buffer view, the
/// others three or four, contiguous. `box`, when asked for, receives what a client will see, in
/// glTF axes.
nlohmann::ordered_json add_primitive(GltfDocument& document, const FlatMesh& mesh,
                                     const QuantizationGrid& grid, Compression compression,
                                     Box* box = nullptr);

/// Gives a primitive the material of a look: an image of its own, or vertex colours, both unlit;
/// without either it keeps the plain one. Appends what it needs; the document has no plain material
/// any more then.
void set_look(GltfDocument& document, const LevelLook& look, const std::string& name,
              nlohmann::ordered_json& primitive);

/// The .glb file: header, JSON chunk, BIN chunk.
std::string finish_glb(GltfDocument document);

/// Tile or building axes (z up) to glTF's (y up) and back.
inline Vec3 to_gltf(const Vec3& p) { return {p.x(), p.z(), -p.y()}; }
inline Vec3 from_gltf(const Vec3& p) { return {p.x(), -p.z(), p.y()}; }

/// The layer flat-shaded in glTF axes, moved by `offset` (z-up metres) and rounded to the grid;
/// triangles that rounding made a line between two points or a point are left out, which opens no
/// hole. Every vertex gets the id `feature`, and what `look` says of it: coordinates of its
/// texture, or its facet's colour.
FlatMesh flatten(const PolygonMesh& mesh, const Vec3& offset, const QuantizationGrid& grid,
                 int feature = 0, const LevelLook& look = {});

/// Appends b to a.
void append(FlatMesh& a, const FlatMesh& b);

/// Every edge once in each direction after equal positions became one.
bool is_closed(const FlatMesh& mesh);

/// fit_grid, with the bound halved (at most 8 times) until rounding keeps a mesh closed that is
/// closed without it. In glTF axes.
QuantizationGrid fit_closed_grid(const PolygonMesh& mesh, const Vec3& offset, const Box& gltf_box,
                                 double bound);

}  // namespace colod
