// Based on: map and reduce: all that a scene's files need of a building was measured where its
// cell was exported.
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>

#include "building_files.h"
#include "cell_record.h"
#include "cells.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "exporters/html_report/html_report.h"
#include "exporters/tiles3d/archive.h"
#include "kept_tiles.h"
#include "placement.h"
#include "publish.h"

namespace colod {
namespace {

[[noreturn]] void refuse(const MergedCell& cell, const std::string& cause) {
  throw Error(Stage::kInput, cell.path, cause + ": run " + cell.remedy);
}

/// A building and where its pieces are.
struct Entry {
  std::string name;
  std::uint32_t cell = 0, place = 0;  ///< which cell's, and which in it
};

void check_entry(const std::string& key, const MergedCell& cell, const CellBuilding& building,
                 const CellRecord& record) {
  if (record.key.empty()) refuse(cell, "lacks " + building.name);
  if (record.key != key)
    refuse(cell, building.name +
                     " was exported with other options, or before its layers, or when layers "
                     "switch, changed");
}

void check_files(const MergedCell& cell, const std::vector<CellRecord>& records,
                 const HasFile& has_file) {
  std::vector<std::string> lacking(records.size());
  parallel_for(records.size(), [&](std::size_t i) {
    for (const WrittenFile& f : records[i].files)
      if (!has_file(f)) lacking[i] = f.path;
  });
  for (const std::string& path : lacking)
    if (!path.empty()) refuse(cell, "its file " + path + " is missing or damaged");
}

/// The first source of each folder, by the place of its building: all that says where a scene is.
class Folders {
 public:
  void add(const std::string& path, std::size_t place) {
    const auto [found, is_new] = first_.try_emplace(place_key(path), place, path);
    if (!is_new && place < found->second.first) found->second = {place, path};
  }
  std::vector<std::string> paths() const {
    std::map<std::size_t, std::string> by_place;
    for (const auto& [key, first] : first_) by_place.insert(first);
    std::vector<std::string> all;
    for (const auto& [place, path] : by_place) all.push_back(path);
    return all;
  }

 private:
  std::map<std::string, std::pair<std::size_t, std::string>> first_;
};

class Merge {
 public:
  Merge(const CellScene& cells, Scene& scene, std::vector<MergedCell>& exported,
        const MergeTasks& tasks)
      : cells_(cells), scene_(scene), exported_(exported), tasks_(tasks), locks_(exported.size()) {
    if (tasks.tiles.kept) memory_.emplace(tasks.tiles);
    read();
  }

  void make_files() {
    Stopwatch watch(scene_.export_seconds);
    const SwitchFacts facts = switch_facts(scene_.switching);
    if (entry_of_.empty()) return;
    if (writes(cells_.output, "engine")) make_lods(facts);
    if ((writes(cells_.output, "3dtiles") || writes(cells_.output, "3tz")) &&
        scene_.tileset_failure.empty())
      make_tiles(facts);
  }

  void make_report(const RunTotals& totals) {
    const ReportFrame frame = report_frame(scene_, cells_.options, totals, outcome_.tally);
    if (!cells_.output.has_no_page) make_page(frame);
    tasks_.write("report.json", [&](const auto& append) {
      append(frame.before);
      for (std::size_t i = 0; i < entries_.size(); ++i) append((i > 0 ? "," : "") + piece(i, kRow));
      append((entries_.empty() ? "" : "\n  ") + frame.after);
    });
  }

  CellOutcome& outcome() { return outcome_; }

 private:
  /// What is kept of all records, by name, as one run would have them.
  void read() {
    for (std::size_t c = 0; c < exported_.size(); ++c)
      for (std::size_t i = 0; i < exported_[c].buildings.size(); ++i)
        entries_.push_back({exported_[c].buildings[i].name, static_cast<std::uint32_t>(c),
                            static_cast<std::uint32_t>(i)});
    std::sort(entries_.begin(), entries_.end(),
              [](const Entry& a, const Entry& b) { return a.name < b.name; });
    std::vector<std::vector<std::size_t>> entry_of(exported_.size());  // by cell and place
    for (std::size_t c = 0; c < exported_.size(); ++c)
      entry_of[c].resize(exported_[c].buildings.size());
    for (std::size_t i = 0; i < entries_.size(); ++i)
      entry_of[entries_[i].cell][entries_[i].place] = i;
    Read all(entries_.size());
    for (std::size_t c = 0; c < exported_.size(); ++c) read_cell(exported_[c], entry_of[c], all);
    keep(all);
  }

  /// Of entries, in their order, until all are read.
  struct Read {
    explicit Read(std::size_t count) : outlines(count), origins(count), has_levels(count) {}

    std::vector<TileOutline> outlines;
    std::vector<Vec3> origins;
    std::vector<char> has_levels;
    std::vector<BuildingKey> keys;
    std::map<std::size_t, std::vector<Message>> messages;  // by entry
    std::map<std::size_t, std::string> not_in_tiles;       // the same
  };

  void read_cell(MergedCell& cell, const std::vector<std::size_t>& entry_of, Read& all) {
    const std::string stamp = cells_.stamp();
    std::vector<CellRecord> records;
    for (const CellBuilding& b : cell.buildings) {
      const std::string facts = get(cell, b.name, kFacts);
      records.push_back(facts.empty() ? CellRecord{} : record_of(facts, cell.path));
      check_entry(key_of(cells_, stamp, b), cell, b, records.back());
    }
    check_files(cell, records, tasks_.has_file);
    for (std::size_t i = 0; i < records.size(); ++i) {
      CellRecord& r = records[i];
      const std::size_t entry = entry_of[i];
      outcome_.tally += r.tally;
      if (!r.messages.empty()) all.messages[entry] = std::move(r.messages);
      folders_.add(r.path, entry);
      all.has_levels[entry] = !r.building.levels.empty();
      if (!all.has_levels[entry]) continue;
      all.outlines[entry] = r.outline, all.origins[entry] = r.building.origin;
      if (!r.not_in_tiles.empty()) all.not_in_tiles[entry] = r.not_in_tiles;
      if (!memory_) continue;
      all.keys.resize(entries_.size());
      all.keys[entry] = memory_->key_of(r.building, r.key);
    }
    cell.buildings = {};  // names are with the entries
  }

  void keep(Read& all) {
    for (auto& [entry, messages] : all.messages)
      for (Message& m : messages) outcome_.messages.push_back(std::move(m));
    if (!all.not_in_tiles.empty()) scene_.tileset_failure = all.not_in_tiles.begin()->second;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      if (!all.has_levels[i]) continue;
      if (kept < i) {
        all.outlines[kept] = std::move(all.outlines[i]), all.origins[kept] = all.origins[i];
        if (memory_) all.keys[kept] = all.keys[i];
      }
      ++kept;
      entry_of_.push_back(static_cast<std::uint32_t>(i));
    }
    all.outlines.resize(kept), all.origins.resize(kept);
    outlines_ = std::move(all.outlines), origins_ = std::move(all.origins);
    if (!memory_) return;
    all.keys.resize(kept);
    memory_->set_keys(std::move(all.keys));
  }

  static std::string get(const MergedCell& cell, const std::string& name,
                         const std::string& piece) try {
    return cell.shelf.get(name, piece);
  } catch (const Error&) {
    refuse(cell, "is damaged");
  }

  /// Thread-safe.
  std::string piece(std::size_t entry, const std::string& name) {
    const std::size_t cell = entries_[entry].cell;
    const std::lock_guard lock(locks_[cell]);
    std::string bytes = get(exported_[cell], entries_[entry].name, name);
    if (bytes.empty())
      refuse(exported_[cell], "what it has of " + entries_[entry].name + " is missing or damaged");
    return bytes;
  }
  const std::string& path_of(std::size_t entry) const {
    return exported_[entries_[entry].cell].path;
  }

  void make_lods(const SwitchFacts& facts) {
    std::vector<std::string> entries;
    for (const std::size_t i : entry_of_) entries.push_back(piece(i, kLods));
    tasks_.take(encode_lods_json(entries, engine_options(cells_.output, facts)));
  }

  /// A building of the tileset without meshes and looks. Thread-safe.
  ExportBuilding building(int b) {
    const std::size_t entry = entry_of_[static_cast<std::size_t>(b)];
    return record_of(piece(entry, kFacts), path_of(entry)).building;
  }

  LevelDepot depot() {
    return {.open =
                [&](const std::vector<int>& buildings) {
                  for (const int b : buildings) open_[b] = building(b);
                },
            .close = [&] { open_.clear(); },
            .at = [&](int b) -> const ExportBuilding& { return open_.at(b); },
            .get =
                [&](int b) {
                  const std::size_t entry = entry_of_[static_cast<std::size_t>(b)];
                  std::vector<ExportLevel>& levels = open_.at(b).levels;
                  for (std::size_t i = 0; i < levels.size(); ++i)
                    fill_level(piece(entry, level_piece(i)), levels[i], path_of(entry));
                },
            .drop =
                [&](int b) {
                  for (ExportLevel& level : open_.at(b).levels) {
                    const ExportLevel gone = std::move(level);  // an emptied string keeps its room
                    level = {gone.layers, {}, gone.gsd, gone.deviation};
                  }
                },
            .named =
                [&](int b) {
                  const auto found = open_.find(b);
                  return found != open_.end() ? found->second : building(b);
                },
            .coarsest =
                [&](int b) {
                  const std::size_t entry = entry_of_[static_cast<std::size_t>(b)];
                  return coarsest_of(piece(entry, kCoarsest), path_of(entry));
                }};
  }

  void make_tiles(const SwitchFacts& facts) {
    const OutputOptions& a = cells_.output;
    const TilesOptions options{
        .compression = a.compression,
        .quantization = a.quantization,
        .target_sse = a.target_sse,
        .switching = facts,
        .largest_texture = a.texture.largest,
        .kept = memory_ ? &memory_->tiles() : nullptr,
        .lists_files = writes(a, "3tz"),
        .placement = find_placement(folders_.paths(), a.crs, a.origin, origins_, tasks_.tell)};
    origins_ = {};
    const std::vector<Encoded> files =
        encode_tileset(outlines_, depot(), options, tasks_.tiles.take);
    tasks_.tiles.take(files.front());  // all else is there
    if (writes(a, "3tz")) make_archive(files);
    if (!memory_) return;
    std::vector<const std::string*> names;
    std::vector<std::uint32_t> cells;
    for (const std::uint32_t i : entry_of_)
      names.push_back(&entries_[i].name), cells.push_back(entries_[i].cell);
    memory_->finish(names, cells, tasks_.tell);
  }

  void make_archive(const std::vector<Encoded>& files) {
    tasks_.write(kArchiveName, [&](const auto& append) {
      ArchiveWriter archive(append);
      for (const Encoded& file : files) archive.add(file.path, tasks_.tiles.read(file.path));
      archive.finish();
    });
  }

  void make_page(const ReportFrame& frame) {
    std::vector<std::vector<PartFacts>> parts;
    Pictures pictures;
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      CellRecord record = record_of(piece(i, kFacts), path_of(i));
      parts.push_back(std::move(record.parts));
      pictures.emplace_back();
      for (std::size_t k = 0; k < record.pictures; ++k)
        pictures.back().push_back(piece(i, picture_piece(k)));
    }
    const auto descriptor = [&](std::size_t building, std::size_t segment) {
      return descriptor_of(piece(building, kDescriptors), segment, path_of(building));
    };
    tasks_.take(encode_html_report({.report = frame.before + frame.after,
                                    .parts = parts_json(parts, descriptor, cells_.options),
                                    .pictures = std::move(pictures),
                                    .layer_colors = css_layer_colors(cells_.options.layers),
                                    .buildings = entries_.size(),
                                    .building = [&](std::size_t i) { return piece(i, kRow); }}));
  }

  const CellScene& cells_;
  Scene& scene_;
  std::vector<MergedCell>& exported_;
  const MergeTasks& tasks_;
  std::vector<std::mutex> locks_;  // one a cell
  std::vector<Entry> entries_;
  std::vector<std::uint32_t> entry_of_;  // per building of the tileset
  std::vector<TileOutline> outlines_;    // the same
  std::vector<Vec3> origins_;            // the same, until it has its place on Earth
  Folders folders_;
  std::map<int, ExportBuilding> open_;  // those of the cell of tiles that is made
  std::optional<MergeMemory> memory_;
  CellOutcome outcome_;
};

}  // namespace

CellOutcome merge_cells(const CellScene& cells, Scene& scene, std::vector<MergedCell>& exported,
                        const MergeTasks& tasks, const std::function<RunTotals()>& finish) {
  Merge merge(cells, scene, exported, tasks);
  merge.make_files();
  merge.make_report(finish());
  return std::move(merge.outcome());
}

}  // namespace colod
