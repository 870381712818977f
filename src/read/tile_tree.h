// The tree of tiles that a tileset.json and those that it names make, none of which is read.
#pragma once

#include <string>

#include "archive.h"
#include "tileset.h"

namespace colod {

/// Of a tileset.json; `archive`: that its files were unpacked from, or nullptr. Throws
/// Error{kInput} for what is no tileset, nested too deeply, or names no tile that can be read.
TileTree read_tile_tree(const std::string& path, const ReadOptions& options, Unpacked* archive);

}  // namespace colod
