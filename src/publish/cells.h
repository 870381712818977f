// A scene in cells: each cell's buildings are exported apart, on any machine, and a merge makes the
// files of the whole scene of what they hand over. Together the bytes of encode_scene and
// encode_report, times and memory apart.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/options.h"
#include "messages.h"
#include "outputs.h"
#include "report.h"
#include "store/shelf.h"

namespace colod {

/// What the exports of all cells have in common.
struct CellScene {
  const OutputOptions& output;
  const Options& options;
  /// Warnings, failures, coanalysis, switching and attributes of the whole scene; no buildings.
  const Scene& scene;
  std::size_t buildings = 0;  ///< in all cells

  /// What files are made from besides the buildings: changes with the options of what is written
  /// and with when layers switch.
  std::string stamp() const;
};

struct CellBuilding;
/// What a building's files and pieces are made from. `stamp`: of the scene.
std::string key_of(const CellScene& scene, const std::string& stamp, const CellBuilding& building);

/// A building of a cell, and what its meshes are made from.
struct CellBuilding {
  std::string name, meshes_key;
};

/// A file below OUT.
struct WrittenFile {
  std::string path;
  std::size_t bytes = 0;
  std::string hash;  ///< of its bytes
};

/// Whether OUT has this file with these bytes. Thread-safe.
using HasFile = std::function<bool(const WrittenFile&)>;

struct CellTasks {
  std::vector<CellBuilding> buildings;
  std::function<Building(const std::string& name)> load;  ///< source and layers; thread-safe
  Take take;
  HasFile has_file;
  std::function<void(const std::string& building, bool is_done_anew)> progress;  ///< one at a time
  Tell tell;  ///< one at a time: what was there, but damaged
};

/// Makes the own files of a cell's buildings, several at once, and puts on the shelf what the merge
/// needs of each; what is there already, of the same meshes, options and switches, and has its
/// files, byte for byte, is left as it is. Buildings with other names leave the shelf. Returns what
/// is to be told of the cell's buildings.
struct CellOutcome {
  Tally tally;
  std::vector<Message> messages;

  CellOutcome& operator+=(CellOutcome other);
};
CellOutcome export_cell(const CellScene& scene, const CellTasks& tasks, Shelf& shelf);

/// A cell that has been exported.
struct MergedCell {
  std::string path;  ///< of the shelf's file, for messages
  Shelf shelf;
  std::vector<CellBuilding> buildings;
  std::string remedy;  ///< the command that exports it again
};

/// Where tiles lie.
struct TileFolder {
  Take take;
  HasFile has_file;
  std::function<std::string(const std::string& path)> read;
  Shelf* kept = nullptr;  ///< of tiles that are there already; null: all are made anew
  std::string place;      ///< what was made for another place is not there
};

struct MergeTasks {
  Take take;
  std::function<void(const std::string& path,
                     const std::function<void(const std::function<void(const std::string&)>&)>&)>
      write;  ///< a file whose bytes come piece by piece
  HasFile has_file;
  Tell tell;
  TileFolder tiles;  ///< in OUT, or for an archive alone elsewhere
};

/// lods.json, the tileset cell by cell, then `finish` says the totals, and report.html and
/// report.json are made. In memory are what CellRecord holds of each building and one cell of
/// tiles; with report.html the page as well. Throws Error{kInput}, with the cell's remedy, where a
/// building is missing, is older than its meshes, was exported with other options, or lacks a file,
/// before it writes anything. `scene` gets what went wrong. Returns the sum of the buildings and
/// what is to be told of them.
CellOutcome merge_cells(const CellScene& cells, Scene& scene, std::vector<MergedCell>& exported,
                        const MergeTasks& tasks, const std::function<RunTotals()>& finish);

}  // namespace colod
