// What of a place is no building → coarser tiles above its own, where the source has none:
// simplified, and wearing what they look like from above.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "core/geometry.h"

namespace colod {

/// A tile, and which of its vertices lie where others may join it: they stay on all levels.
struct ChainPart {
  Source source;
  std::vector<char> is_joint;   ///< per vertex
  std::vector<Source> painted;  ///< what it looks like from above; empty: as itself
};

/// A tile of the finest level, which is read when it is needed.
struct ChainLeaf {
  Box box;
  std::function<ChainPart()> read;  ///< thread-safe; what it throws as Error leaves it out
  double texel = 0;  ///< metres; above 0: it is no tile itself, what is made of it first is the
                     ///< finest one, with such texels
};

struct ChainNode {
  int parent = -1;                  ///< parents come before children; one root
  int leaf = -1;                    ///< −1: a coarser tile
  double texel = 0, deviation = 0;  ///< metres, of a coarser tile; from the leaves below it
};

/// Up to four tiles that lie together become one, half as fine, and so on up to one whose picture
/// is small. Memory follows the tiles that are worked on at the same time: what is made lies in a
/// temporary file. Vertices that are joints of tiles which do not lie in the same coarser one are
/// the same on all levels: no cracks between neighbours on different ones.
class ContextChain {
 public:
  /// Makes all of it, in parallel. `image_memory`: bytes that decoded images may take together.
  ContextChain(const std::vector<ChainLeaf>& leaves, std::size_t image_memory);
  ~ContextChain();
  ContextChain(ContextChain&&) noexcept;

  const std::vector<ChainNode>& nodes() const;
  /// What a coarser tile shows. Its image lies in a file that is there as long as this is.
  /// Thread-safe.
  Source read(std::size_t node) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Per vertex: whether an edge that only one face has ends there.
std::vector<char> on_border(const Mesh& mesh);

/// Per vertex of `mesh`: whether it lies where a marked one of `other` does.
std::vector<char> marked_as(const Mesh& mesh, const Mesh& other, const std::vector<char>& marks);

}  // namespace colod
