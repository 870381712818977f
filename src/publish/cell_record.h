// Inside room `publish`: what a cell's export keeps of a building for the merge, as pieces of
// bytes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cells.h"
#include "exporters/exporter.h"
#include "exporters/tiles3d/tiles3d.h"
#include "messages.h"
#include "report_parts.h"
#include "store/shelf.h"

namespace colod {

/// All of a building that the merge holds in memory.
struct CellRecord {
  std::string key;          ///< what its files were made from
  ExportBuilding building;  ///< its levels without meshes and looks; none: it has failed
  std::string path;         ///< of its source
  TileOutline outline;
  std::string not_in_tiles;  ///< why no tileset can hold it; empty: one can
  Tally tally;
  std::vector<Message> messages;
  std::vector<PartFacts> parts;
  std::vector<WrittenFile> files;
  std::size_t pictures = 0;
};

/// `descriptors` per segment. All pieces of a building; `building` and `pictures` are whole here.
Shelf::Pieces to_pieces(const CellRecord& record, const std::string& row, const std::string& lods,
                        const std::vector<Descriptor>& descriptors,
                        const std::vector<std::string>& pictures);

/// Each throws Error{kInput} naming `where` for what is damaged.
CellRecord record_of(const std::string& facts, const std::string& where);
void fill_level(const std::string& piece, ExportLevel& level, const std::string& where);
CoarsestLook coarsest_of(const std::string& piece, const std::string& where);
Descriptor descriptor_of(const std::string& piece, std::size_t segment, const std::string& where);

/// Names of pieces.
constexpr const char *kFacts = "facts", *kRow = "row", *kLods = "lods", *kCoarsest = "coarsest",
                     *kDescriptors = "descriptors";
std::string level_piece(std::size_t level);
std::string picture_piece(std::size_t picture);

}  // namespace colod
