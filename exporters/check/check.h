// colod's own checks of what it wrote: faults that the official validators let pass.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/geometry.h"

namespace colod {

/// One fault.
struct Finding {
  std::string code;   ///< as docs/checks.md lists them
  std::string where;  ///< file, and the place in it
  std::string message;
};

/// A GLB as a client decodes it.
struct GlbContent {
  struct MeshContent {
    std::vector<Vec3> positions;          ///< z up
    std::vector<Vec3> normals;            ///< per position; empty: none
    std::vector<std::uint32_t> features;  ///< per position; empty: no ids
    std::vector<Face> faces;
  };
  /// A row of the property table.
  struct Row {
    std::string name;
    int layer = -1, coarsest_layer = -1;  ///< −1: a stand-in
    double gsd = 0;                       ///< metres a pixel
    double deviation = 0;                 ///< metres
  };
  nlohmann::json json;
  std::vector<MeshContent> meshes;  ///< of all their primitives; empty where one is damaged
  std::vector<Row> rows;
  bool has_transforms = false;  ///< some node is moved: positions are not the scene's
};

/// Containers, accessors against decoded data, normals against windings, feature ids, property
/// tables, MSFT_lod with its gsds and coverages. Never throws for what the bytes hold.
GlbContent check_glb(const std::string& bytes, const std::string& where,
                     std::vector<Finding>& findings);

/// A tileset with all that it names: errors, boxes, contents, external tilesets, identity of
/// buildings across tiles. Never throws for what the files hold.
void check_tileset(const std::string& path, std::vector<Finding>& findings);

/// A .glb, a tileset.json, or a folder: its tileset, and every GLB below it that no tile names.
/// Sorted by file. Throws Error{kInput} when there is nothing to check.
std::vector<Finding> check_output(const std::string& path);

}  // namespace colod
