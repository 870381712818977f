#include "kept_tiles.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cbor.h"
#include "core/hash.h"
#include "core/parallel.h"

namespace colod {
namespace {

using Json = nlohmann::json;

// Names of pieces; folders begin with "tiles/".
constexpr const char *kTiles = "tiles", *kBuildings = "buildings";
constexpr std::size_t kMostNames = 20;  // in a line

Json facts_json(const TileFacts& f) {
  return {f.key,         f.box.min.x(), f.box.min.y(), f.box.min.z(), f.box.max.x(),
          f.box.max.y(), f.box.max.z(), f.gsd,         f.bytes,       f.hash};
}

TileFacts tile_facts(const Json& j) {
  const auto place = [&](std::size_t i) {
    return Vec3(j.at(i).get<double>(), j.at(i + 1).get<double>(), j.at(i + 2).get<double>());
  };
  return {.key = j.at(0),
          .box = {place(1), place(4)},
          .gsd = j.at(7),
          .bytes = j.at(8),
          .hash = j.at(9)};
}

/// Whatever cannot be read was never there.
template <typename T, typename Read>
T read_or_nothing(const std::string& piece, const Read& read) {
  try {
    return piece.empty() ? T{} : read(Json::from_cbor(piece));
  } catch (const Json::exception&) {
    return {};
  }
}

void tell_names(Level level, const std::string& what, const std::vector<std::string>& names,
                const Tell& tell) {
  if (names.empty()) return;
  std::string line = std::to_string(names.size()) + " " + what + ": ";
  for (std::size_t i = 0; i < std::min(kMostNames, names.size()); ++i)
    line += (i > 0 ? ", " : "") + names[i];
  if (names.size() > kMostNames)
    line += " and " + std::to_string(names.size() - kMostNames) + " more";
  tell({level, line});
}

void tell_buildings(const std::string& what, const std::vector<std::string>& names,
                    const Tell& tell) {
  tell_names(Level::kInfo, "buildings " + what + " since the last merge", names, tell);
}

/// Names that are new, have changed or are gone; one that is both new and gone went to another
/// cell.
struct Changes {
  std::vector<std::string> added, changed, gone;
  bool is_first = true;  // nothing is known of an earlier merge

  void compare(const std::map<std::string, std::string>& before,
               const std::map<std::string, std::string>& now) {
    is_first = is_first && before.empty();
    for (const auto& [name, key] : now) {
      const auto old = before.find(name);
      if (old == before.end()) added.push_back(name);
      if (old != before.end() && old->second != key) changed.push_back(name);
    }
    for (const auto& [name, key] : before)
      if (!now.contains(name)) gone.push_back(name);
  }

  void tell_all(const Tell& tell) {
    if (is_first) return;
    for (auto* names : {&added, &changed, &gone}) std::sort(names->begin(), names->end());
    std::vector<std::string> moved;
    std::set_intersection(added.begin(), added.end(), gone.begin(), gone.end(),
                          std::back_inserter(moved));
    const auto is_moved = [&](const std::string& name) {
      return std::binary_search(moved.begin(), moved.end(), name);
    };
    std::erase_if(added, is_moved), std::erase_if(gone, is_moved);
    tell_buildings("are new", added, tell);
    tell_buildings("have changed", changed, tell);
    tell_buildings("are gone", gone, tell);
  }
};

std::string hex_of(const BuildingKey& key) {
  std::ostringstream text;
  text << std::hex << key[0] << '.' << key[1];
  return text.str();
}

}  // namespace

MergeMemory::MergeMemory(const TileFolder& folder) : folder_(folder), shelf_(*folder.kept) {
  tiles_.find = [this](const std::string& below, const std::string& path, const std::string& key) {
    return find(below, path, key);
  };
  tiles_.put = [this](const std::string& path, const auto& facts) { put(path, facts); };
}

BuildingKey MergeMemory::key_of(const ExportBuilding& building, const std::string& key) const {
  Hash hash;
  for (const std::string* text :
       {&building.name, &building.given_name, &building.source, &key, &folder_.place}) {
    const std::size_t size = text->size();
    hash.add(&size, sizeof size);
    hash.add(text->data(), size);
  }
  return hash.value();
}

std::optional<TileFacts> MergeMemory::find(const std::string& folder, const std::string& path,
                                           const std::string& key) {
  if (folders_.empty() || folders_.back() != folder) enter(folder);
  const auto found = there_.find(path);
  if (found == there_.end() || found->second.key != key) return {};
  return found->second;
}

void MergeMemory::enter(const std::string& folder) {
  folders_.push_back(folder);
  there_.clear();
  if (shelf_.state(folder) == Shelf::State::kDamaged) damaged_.push_back(folder);
  const Json json = read_or_nothing<Json>(shelf_.get(folder, kTiles), [](Json all) { return all; });
  std::vector<std::pair<std::string, TileFacts>> known;
  try {
    for (const auto& [path, own] : json.items()) known.emplace_back(path, tile_facts(own));
  } catch (const Json::exception&) {
    known.clear();
  }
  std::vector<char> is_there(known.size());
  parallel_for(known.size(), [&](std::size_t i) {
    const TileFacts& facts = known[i].second;
    is_there[i] = folder_.has_file({known[i].first, facts.bytes, facts.hash});
  });
  for (std::size_t i = 0; i < known.size(); ++i)
    if (is_there[i])
      there_.insert(std::move(known[i]));
    else
      damaged_.push_back(known[i].first);
}

void MergeMemory::put(const std::string& folder, const std::map<std::string, TileFacts>& facts) {
  Json json = Json::object();
  for (const auto& [path, own] : facts) json[path] = facts_json(own);
  shelf_.put(folder, {{kTiles, cbor_of(json)}});
}

void MergeMemory::finish(const std::vector<const std::string*>& names,
                         const std::vector<std::uint32_t>& cells, const Tell& tell) {
  tell_names(Level::kWarning,
             "tiles, or what was known of a folder of them, were missing or damaged and are made "
             "anew",
             damaged_, tell);
  std::map<std::string, std::vector<std::size_t>> now;  // by the piece's name
  for (std::size_t i = 0; i < names.size(); ++i)
    now[kBuildings + std::to_string(cells[i])].push_back(i);
  for (const std::string& name : shelf_.names())
    if (name.starts_with(kBuildings)) now.try_emplace(name);  // cells that are gone
  Changes changes;
  for (const auto& [piece, own] : now) {
    const auto before = read_or_nothing<std::map<std::string, std::string>>(
        shelf_.get(piece, kBuildings),
        [](const Json& json) { return json.get<std::map<std::string, std::string>>(); });
    std::map<std::string, std::string> keys;
    for (const std::size_t i : own) keys[*names[i]] = hex_of(tiles_.keys[i]);
    changes.compare(before, keys);
    if (before != keys) shelf_.put(piece, {{kBuildings, cbor_of(Json(keys))}});
    if (!own.empty()) folders_.push_back(piece);
  }
  changes.tell_all(tell);
  shelf_.keep_only(folders_);
}

}  // namespace colod
