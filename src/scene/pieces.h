// Inside room `scene` only: meshes too large for one tile, as squares that lie on disk.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "core/geometry.h"
#include "scratch_file.h"

namespace colod {

/// What was cut lies in a temporary file; which images there are is kept in memory. Thread-safe.
class Pieces {
 public:
  /// Quarters of the plan, and of these, until each has at most `most` faces: each face goes whole
  /// to where its middle lies, so that neighbours have the same vertices. Returns the pieces'
  /// numbers.
  std::vector<std::size_t> cut(const Source& source, std::size_t most);
  Source get(std::size_t piece) const;
  Box box(std::size_t piece) const { return find(piece).box; }

 private:
  struct Piece {
    std::shared_ptr<const Source> frame;  ///< the path, images and materials that all have
    Box box;
    std::size_t at = 0, bytes = 0, vertices = 0, faces = 0;
    bool has_materials = false, has_uvs = false, has_colors = false;
  };
  void quarter(const Source& source, const std::shared_ptr<const Source>& frame,
               std::vector<int> faces, std::size_t most, int depth, std::vector<std::size_t>& out);
  std::size_t put(const Source& source, const std::shared_ptr<const Source>& frame,
                  const std::vector<int>& faces);
  Piece find(std::size_t piece) const;

  ScratchFile file_;
  mutable std::mutex mutex_;
  std::vector<Piece> pieces_;
};

}  // namespace colod
