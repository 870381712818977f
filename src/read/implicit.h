// Inside room `read` only: tiles that a tileset does not list one by one.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace colod::mesh_io {

/// `implicitTiling` of 3D Tiles 1.1, or its extension of 1.0.
struct ImplicitTiling {
  int branches = 4;        ///< 4: a quadtree, 8: an octree
  int subtree_levels = 1;  ///< of one file
  int levels = 1;          ///< of the whole
  std::string subtrees;    ///< a template of their addresses
};

/// Of a tile that has it; throws Error{kInput}, naming `path`, where it makes no sense.
ImplicitTiling implicit_tiling(const std::string& path, const nlohmann::json& tile);

/// A tile's place: level, x, y, z.
using ImplicitPlace = std::array<std::uint64_t, 4>;

/// The child at a place in Morton's order; z stays 0 in a quadtree.
ImplicitPlace child_of(const ImplicitPlace& parent, int branch, int branches);

/// A template with {level}, {x}, {y}, {z} filled in.
std::string filled(std::string text, const ImplicitPlace& place);

/// Which tiles, contents and further subtrees there are below a place.
class Subtree {
 public:
  /// `bytes`: JSON, or the binary form. `read` gives the bytes of a buffer by its address. Throws
  /// Error{kInput}.
  Subtree(const std::string& path, const std::string& bytes, const ImplicitTiling& tiling,
          const std::function<std::string(const std::string& uri)>& read);

  /// `morton`: among the tiles of that level, which counts from the subtree's root.
  bool has_tile(int level, std::uint64_t morton) const;
  bool has_content(std::size_t content, int level, std::uint64_t morton) const;
  bool has_subtree(std::uint64_t morton) const;

 private:
  struct Bits {
    bool is_all = false;
    std::string bytes;  ///< empty: is_all counts
    bool at(std::uint64_t i) const;
  };
  std::uint64_t index_of(int level, std::uint64_t morton) const;

  int branches_;
  Bits tiles_, subtrees_;
  std::vector<Bits> contents_;
};

}  // namespace colod::mesh_io
