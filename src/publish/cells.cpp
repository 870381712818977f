#include "cells.h"

#include <algorithm>
#include <iomanip>
#include <mutex>
#include <sstream>

#include "building_files.h"
#include "cell_record.h"
#include "core/hash.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "pipeline/switches.h"
#include "publish.h"

namespace colod {
namespace {

/// The source lies in the building itself.
class OwnSource : public Depot {
 public:
  void put(Building&) override {}
  void get(Building&) override {}
  void drop(Building& b) override { drop_geometry(b); }
};

/// Whether a building's pieces and files are there, of the same meshes, options and switches;
/// `damage` gets what should be and is not.
bool is_exported(const std::string& key, const CellTasks& tasks, const CellBuilding& building,
                 const std::string& facts, std::string& damage) {
  if (facts.empty()) return false;
  const CellRecord record = record_of(facts, building.name);
  if (record.key != key) return false;
  for (const WrittenFile& f : record.files)
    if (!tasks.has_file(f)) damage = f.path + ": is missing or damaged: made anew";
  return damage.empty();
}

/// What one building hands over.
struct Exported {
  CellRecord record;
  Shelf::Pieces pieces;
};

class CellExporter {
 public:
  CellExporter(const CellScene& cells, const CellTasks& tasks)
      : cells_(cells),
        tasks_(tasks),
        stamp_(cells.stamp()),
        images_(static_cast<std::size_t>(cells.output.texture.memory * (1 << 20))),
        writer_{cells.output, switch_facts(cells.scene.switching), images_,
                picture_options(2 * cells.buildings, cells.options.layers)},
        gallery_(cells.buildings, cells.options.layers) {}

  std::string key(const CellBuilding& building) const { return key_of(cells_, stamp_, building); }

  Exported run(const CellBuilding& building) {
    Building b = tasks_.load(building.name);
    apply_switches(cells_.scene.switching, b);
    Exported result;
    CellRecord& r = result.record;
    std::vector<std::string> pictures;
    if (!cells_.output.has_no_page) gallery_.draw(b), pictures = gallery_.take(building.name);
    r.building = export_building(b);
    if (const auto own = cells_.scene.attributes.find(building.name);
        own != cells_.scene.attributes.end())
      r.building.attributes = own->second;
    std::string lods;
    if (!r.building.levels.empty()) lods = encode(b, r, pictures);
    drop_geometry(b);
    r.key = key(building);
    r.path = b.source.path;
    r.tally = tally_of(b);
    r.messages = problems_of(b);
    r.parts = parts_of(b);
    r.pictures = pictures.size();
    result.pieces = to_pieces(r, report_row(cells_.scene, b), lods, b.descriptors, pictures);
    return result;
  }

 private:
  /// Its files, and what the scene's are planned by; returns its entry of lods.json.
  std::string encode(Building& b, CellRecord& r, std::vector<std::string>& pictures) {
    Stopwatch watch(b.timings.export_);
    const Take take = [&](const Encoded& file) {
      tasks_.take(file);
      r.files.push_back({file.path, file.bytes.size(), hash_of(file.bytes)});
    };
    encode_building(r.building, writer_, source_, b, &pictures, take);
    if (!b.failure.empty()) {
      r.building.levels.clear();
      return {};
    }
    try {
      r.outline = outline_of(r.building, writer_.facts);
    } catch (const std::exception& e) {
      r.not_in_tiles = e.what();
    }
    return writes(cells_.output, "engine")
               ? lods_entry(r.building, engine_options(cells_.output, writer_.facts))
               : std::string();
  }

  const CellScene& cells_;
  const CellTasks& tasks_;
  std::string stamp_;
  ImageCache images_;
  Writer writer_;
  Gallery gallery_;
  OwnSource source_;
};

}  // namespace

CellOutcome& CellOutcome::operator+=(CellOutcome other) {
  tally += other.tally;
  for (Message& m : other.messages) messages.push_back(std::move(m));
  return *this;
}

std::string CellScene::stamp() const {
  std::ostringstream text;
  text << std::setprecision(17) << COLOD_VERSION << ' ' << scene.has_prior;
  if (!output.has_no_page) text << ' ' << buildings;  // the more, the smaller their pictures
  for (const std::string& format : output.formats) text << ' ' << format;
  const TextureOptions& t = output.texture;
  text << ' ' << static_cast<int>(output.compression) << ' ' << output.quantization << ' '
       << output.target_sse << ' ' << output.has_no_page << ' ' << static_cast<int>(t.mode) << ' '
       << t.texel << ' ' << t.largest << ' ' << static_cast<int>(t.format) << ' ' << t.has_fallback
       << ' ' << t.quality << ' ' << t.memory;
  const SwitchOptions& s = scene.switching.options;
  text << ' ' << to_string(s.measure) << ' ' << to_string(s.scope) << ' ' << s.visual_error << ' '
       << s.pixel_error << ' ' << s.share << ' ' << s.rounding;
  for (const SceneSwitch& layer : scene.switching.layers) text << ' ' << layer.gsd;
  return hash_of(text.str());
}

std::string key_of(const CellScene& cells, const std::string& stamp, const CellBuilding& building) {
  std::string own = cells.scene.placed_later.contains(building.name) ? "later" : "";
  if (const auto found = cells.scene.attributes.find(building.name);
      found != cells.scene.attributes.end())
    for (const auto& [name, value] : found->second) own += '\n' + name + ' ' + value;
  if (own.empty()) return stamp + building.meshes_key;
  return stamp + building.meshes_key + hash_of(own);
}

CellOutcome export_cell(const CellScene& cells, const CellTasks& tasks, Shelf& shelf) {
  std::vector<std::string> names;
  for (const CellBuilding& b : tasks.buildings) names.push_back(b.name);
  shelf.keep_only(names);
  CellExporter exporter(cells, tasks);
  std::vector<CellOutcome> of_building(names.size());
  std::mutex mutex;
  parallel_for(names.size(), [&](std::size_t i) {
    std::string facts, damage;
    {
      const std::lock_guard lock(mutex);
      const Shelf::State state = shelf.state(names[i]);
      if (state == Shelf::State::kWhole) facts = shelf.get(names[i], kFacts);
      if (state == Shelf::State::kDamaged)
        damage = names[i] + ": what was exported of it is damaged: made anew";
    }
    const bool is_there =
        is_exported(exporter.key(tasks.buildings[i]), tasks, tasks.buildings[i], facts, damage);
    Exported exported;
    if (is_there)
      exported.record = record_of(facts, names[i]);
    else
      exported = exporter.run(tasks.buildings[i]);
    const std::lock_guard lock(mutex);
    if (!damage.empty()) tasks.tell({Level::kWarning, damage});
    if (!is_there) shelf.put(names[i], exported.pieces);
    of_building[i] = {exported.record.tally, std::move(exported.record.messages)};
    tasks.progress(names[i], !is_there);
  });
  CellOutcome outcome;
  for (CellOutcome& own : of_building) outcome += std::move(own);
  return outcome;
}

}  // namespace colod
