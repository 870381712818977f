#include "kept_tiles.h"

#include <nlohmann/json.hpp>

namespace colod {
namespace {

using Json = nlohmann::json;

// Names of pieces; folders end in "/", so that no folder is called as the buildings are.
constexpr const char *kTiles = "tiles", *kBuildings = "buildings";
constexpr std::size_t kMostNames = 20;  // in a line

Json facts_json(const TileFacts& f) {
  return {f.key,         f.box.min.x(), f.box.min.y(), f.box.min.z(), f.box.max.x(),
          f.box.max.y(), f.box.max.z(), f.gsd,         f.bytes};
}

TileFacts facts_of(const Json& j) {
  const auto place = [&](std::size_t i) {
    return Vec3(j.at(i).get<double>(), j.at(i + 1).get<double>(), j.at(i + 2).get<double>());
  };
  return {.key = j.at(0), .box = {place(1), place(4)}, .gsd = j.at(7), .bytes = j.at(8)};
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

std::string bytes_of(const Json& json) {
  std::string bytes;
  Json::to_cbor(json, bytes);
  return bytes;
}

void tell_names(const char* what, const std::vector<std::string>& names, const Tell& tell) {
  if (names.empty()) return;
  std::string line =
      std::to_string(names.size()) + " buildings " + what + " since the last merge: ";
  for (std::size_t i = 0; i < std::min(kMostNames, names.size()); ++i)
    line += (i > 0 ? ", " : "") + names[i];
  if (names.size() > kMostNames)
    line += " and " + std::to_string(names.size() - kMostNames) + " more";
  tell({Level::kInfo, line});
}

}  // namespace

MergeMemory::MergeMemory(const TileFolder& folder) : folder_(folder), shelf_(*folder.kept) {
  tiles_.get = [this](const std::string& path) { return get(path); };
  tiles_.put = [this](const std::string& path, const auto& facts) { put(path, facts); };
}

void MergeMemory::add(const std::string& building, const std::string& key) {
  now_[building] = key;
  tiles_.keys.push_back(key + " in " + folder_.place);
}

std::map<std::string, TileFacts> MergeMemory::get(const std::string& folder) {
  folders_.push_back(folder);
  auto facts = read_or_nothing<std::map<std::string, TileFacts>>(
      shelf_.get(folder, kTiles), [](const Json& json) {
        std::map<std::string, TileFacts> all;
        for (const auto& [path, own] : json.items()) all[path] = facts_of(own);
        return all;
      });
  std::erase_if(facts, [&](const auto& f) { return !folder_.has_file(f.first, f.second.bytes); });
  return facts;
}

void MergeMemory::put(const std::string& folder, const std::map<std::string, TileFacts>& facts) {
  Json json = Json::object();
  for (const auto& [path, own] : facts) json[path] = facts_json(own);
  shelf_.put(folder, {{kTiles, bytes_of(json)}});
}

void MergeMemory::finish(const Tell& tell) {
  const auto before = read_or_nothing<std::map<std::string, std::string>>(
      shelf_.get(kBuildings, kBuildings), [](const Json& json) {
        std::map<std::string, std::string> all;
        json.get_to(all);
        return all;
      });
  std::vector<std::string> added, changed, gone;
  for (const auto& [name, key] : now_) {
    const auto old = before.find(name);
    if (old == before.end()) added.push_back(name);
    if (old != before.end() && old->second != key) changed.push_back(name);
  }
  for (const auto& [name, key] : before)
    if (!now_.contains(name)) gone.push_back(name);
  if (!before.empty()) {
    tell_names("are new", added, tell);
    tell_names("have changed", changed, tell);
    tell_names("are gone", gone, tell);
  }
  shelf_.put(kBuildings, {{kBuildings, bytes_of(Json(now_))}});
  folders_.push_back(kBuildings);
  shelf_.keep_only(folders_);
}

}  // namespace colod
