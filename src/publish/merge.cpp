// Based on: map and reduce: all that a scene's files need of a building was measured where its
// cell was exported.
#include <algorithm>
#include <mutex>

#include "building_files.h"
#include "cell_record.h"
#include "cells.h"
#include "core/error.h"
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
  std::size_t cell = 0;
  CellRecord record;
};

void check_entry(const std::string& key, const MergedCell& cell, const CellBuilding& building,
                 const CellRecord& record, const MergeTasks& tasks) {
  if (record.key.empty()) refuse(cell, "lacks " + building.name);
  if (record.key != key)
    refuse(cell, building.name +
                     " was exported with other options, or before its layers, or when layers "
                     "switch, changed");
  for (const WrittenFile& f : record.files)
    if (!tasks.has_file(f.path, f.bytes)) refuse(cell, "its file " + f.path + " is missing or cut");
}

class Merge {
 public:
  Merge(const CellScene& cells, Scene& scene, std::vector<MergedCell>& exported,
        const MergeTasks& tasks)
      : cells_(cells), scene_(scene), exported_(exported), tasks_(tasks), locks_(exported.size()) {
    read();
  }

  void make_files() {
    Stopwatch watch(scene_.export_seconds);
    const SwitchFacts facts = switch_facts(scene_.switching);
    std::vector<ExportBuilding> buildings;
    std::vector<TileOutline> outlines;
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      CellRecord& r = entries_[i].record;
      if (r.building.levels.empty()) continue;
      if (!r.not_in_tiles.empty() && scene_.tileset_failure.empty())
        scene_.tileset_failure = r.not_in_tiles;
      buildings.push_back(std::move(r.building)), outlines.push_back(r.outline);
      entry_of_.push_back(i);
    }
    if (buildings.empty()) return;
    if (writes(cells_.output, "engine")) make_lods(facts);
    if ((writes(cells_.output, "3dtiles") || writes(cells_.output, "3tz")) &&
        scene_.tileset_failure.empty())
      make_tiles(buildings, outlines, facts);
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
  /// All records, by name, as one run would have them.
  void read() {
    const std::string stamp = cells_.stamp();
    for (std::size_t c = 0; c < exported_.size(); ++c) {
      const MergedCell& cell = exported_[c];
      for (const CellBuilding& b : cell.buildings) {
        const std::string facts = cell.shelf.get(b.name, kFacts);
        entries_.push_back({b.name, c, facts.empty() ? CellRecord{} : record_of(facts, cell.path)});
        check_entry(key_of(cells_, stamp, b), cell, b, entries_.back().record, tasks_);
      }
    }
    std::sort(entries_.begin(), entries_.end(),
              [](const Entry& a, const Entry& b) { return a.name < b.name; });
    for (Entry& e : entries_) {
      outcome_.tally += e.record.tally;
      for (Message& m : e.record.messages) outcome_.messages.push_back(std::move(m));
      e.record.files = {};
    }
  }

  /// Thread-safe.
  std::string piece(std::size_t entry, const std::string& name) {
    const std::size_t cell = entries_[entry].cell;
    const std::lock_guard lock(locks_[cell]);
    std::string bytes = exported_[cell].shelf.get(entries_[entry].name, name);
    if (bytes.empty()) refuse(exported_[cell], "has lost a part of " + entries_[entry].name);
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

  void make_tiles(std::vector<ExportBuilding>& buildings, const std::vector<TileOutline>& outlines,
                  const SwitchFacts& facts) {
    const OutputOptions& a = cells_.output;
    const LevelDepot depot{
        .get =
            [&](int b) {
              const std::size_t entry = entry_of_[static_cast<std::size_t>(b)];
              std::vector<ExportLevel>& levels = buildings[static_cast<std::size_t>(b)].levels;
              for (std::size_t i = 0; i < levels.size(); ++i)
                fill_level(piece(entry, level_piece(i)), levels[i], path_of(entry));
            },
        .drop =
            [&](int b) {
              for (ExportLevel& level : buildings[static_cast<std::size_t>(b)].levels) {
                const ExportLevel gone = std::move(level);  // an emptied string keeps its room
                level = {gone.layers, {}, gone.gsd, gone.deviation};
              }
            },
        .coarsest =
            [&](int b) {
              const std::size_t entry = entry_of_[static_cast<std::size_t>(b)];
              return coarsest_of(piece(entry, kCoarsest), path_of(entry));
            }};
    std::vector<std::string> paths;
    for (const Entry& e : entries_) paths.push_back(e.record.path);
    std::optional<MergeMemory> memory;
    if (tasks_.tiles.kept) memory.emplace(tasks_.tiles);
    if (memory)
      for (const std::size_t i : entry_of_) memory->add(entries_[i].name, entries_[i].record.key);
    const TilesOptions options{
        .compression = a.compression,
        .quantization = a.quantization,
        .target_sse = a.target_sse,
        .switching = facts,
        .largest_texture = a.texture.largest,
        .kept = memory ? &memory->tiles() : nullptr,
        .placement = find_placement(paths, a.crs, a.origin, buildings, tasks_.tell)};
    const std::vector<Encoded> files =
        encode_tileset(buildings, outlines, depot, options, tasks_.tiles.take);
    tasks_.tiles.take(files.front());  // all else is there
    if (writes(a, "3tz")) make_archive(files);
    if (memory) memory->finish(tasks_.tell);
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
      parts.push_back(entries_[i].record.parts);
      pictures.emplace_back();
      const MergedCell& cell = exported_[entries_[i].cell];
      for (std::size_t k = 0; k < entries_[i].record.pictures; ++k)
        pictures.back().push_back(cell.shelf.get(entries_[i].name, picture_piece(k)));
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
  std::vector<std::size_t> entry_of_;  // per building of the tileset
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
