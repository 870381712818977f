// Based on: 3D Tiles 1.1 (OGC 22-025r4), Implicit Tiling; 3DTILES_implicit_tiling of 1.0.
// Differs: metadata and bounding volumes are not asked.
#include "implicit.h"

#include <cstring>
#include <nlohmann/json.hpp>

#include "files.h"
#include "formats.h"

namespace colod::mesh_io {

using Json = nlohmann::json;

namespace {

constexpr int kMostLevels = 32;
constexpr std::uint64_t kMostBits = std::uint64_t{1} << 27;  // of one subtree: 16 MiB
constexpr std::size_t kHeaderOfSubtree = 24;

const Json& any_member(const Json& json, const char* key) {
  static const Json none;
  const auto found = json.is_object() ? json.find(key) : json.end();
  return json.is_object() && found != json.end() ? *found : none;
}

/// A whole number from `least` to `most`; −1: it is none.
std::int64_t number(const Json& json, const char* key, std::int64_t least, std::int64_t most) {
  const Json& value = any_member(json, key);
  if (!value.is_number_integer()) return -1;
  const auto n = value.get<std::int64_t>();
  return n < least || n > most ? -1 : n;
}

std::uint64_t power(int base, int exponent) {
  std::uint64_t out = 1;
  for (int i = 0; i < exponent; ++i) out *= static_cast<std::uint64_t>(base);
  return out;
}

/// Of a subtree's file: its JSON and the bytes behind it.
std::pair<Json, std::string> parts_of(const std::string& path, const std::string& bytes) {
  std::string text = bytes, rest;
  if (bytes.starts_with("subt")) {
    std::uint64_t json = 0, binary = 0;
    if (bytes.size() >= kHeaderOfSubtree) {
      std::memcpy(&json, bytes.data() + 8, sizeof json);
      std::memcpy(&binary, bytes.data() + 16, sizeof binary);
    }
    const std::uint64_t room =
        bytes.size() < kHeaderOfSubtree ? 0 : bytes.size() - kHeaderOfSubtree;
    if (json == 0 || json > room || binary > room - json) fail(path, "is cut off");
    text = bytes.substr(kHeaderOfSubtree, json);
    rest = bytes.substr(kHeaderOfSubtree + json, binary);
  }
  Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) fail(path, "is no subtree: neither JSON nor its binary form");
  return {std::move(json), std::move(rest)};
}

}  // namespace

ImplicitTiling implicit_tiling(const std::string& path, const Json& tile) {
  const Json& own = any_member(tile, "implicitTiling");
  const Json& json =
      own.is_object() ? own : any_member(any_member(tile, "extensions"), "3DTILES_implicit_tiling");
  ImplicitTiling out;
  const Json& scheme = any_member(json, "subdivisionScheme");
  if (scheme == "OCTREE") out.branches = 8;
  out.subtree_levels = static_cast<int>(number(json, "subtreeLevels", 1, kMostLevels));
  const std::int64_t available = number(json, "availableLevels", 1, kMostLevels);
  const std::int64_t last = number(json, "maximumLevel", 0, kMostLevels - 1);
  out.levels = static_cast<int>(available > 0 ? available : last + 1);
  const Json& uri = any_member(any_member(json, "subtrees"), "uri");
  const bool is_known = scheme == "QUADTREE" || scheme == "OCTREE";
  if (!is_known || out.subtree_levels < 1 || out.levels < 1 || !uri.is_string())
    fail(path, "its implicit tiling makes no sense: scheme, levels or subtrees are missing");
  // 4^13 and 8^9 are the last ones within kMostBits.
  if (power(out.branches, std::min(out.subtree_levels, 14)) > kMostBits)
    fail(path, "its implicit tiling has more than " + std::to_string(kMostBits) +
                   " tiles in one subtree");
  out.subtrees = uri.get<std::string>();
  return out;
}

ImplicitPlace child_of(const ImplicitPlace& parent, int branch, int branches) {
  const auto bit = [&](int k) { return static_cast<std::uint64_t>(branch >> k & 1); };
  return {parent[0] + 1, 2 * parent[1] + bit(0), 2 * parent[2] + bit(1),
          branches == 8 ? 2 * parent[3] + bit(2) : 0};
}

std::string filled(std::string text, const ImplicitPlace& place) {
  constexpr const char* kNames[] = {"{level}", "{x}", "{y}", "{z}"};
  for (std::size_t k = 0; k < place.size(); ++k) {
    const std::string name = kNames[k], value = std::to_string(place[k]);
    for (std::size_t at = text.find(name); at != text.npos; at = text.find(name, at))
      text.replace(at, name.size(), value);
  }
  return text;
}

Subtree::Subtree(const std::string& path, const std::string& bytes, const ImplicitTiling& tiling,
                 const std::function<std::string(const std::string&)>& read)
    : branches_(tiling.branches) {
  const auto [json, inside] = parts_of(path, bytes);
  const auto view = [&, &own = json, &rest = inside](std::int64_t i) {
    const Json& views = any_member(own, "bufferViews");
    if (!views.is_array() || i < 0 || static_cast<std::size_t>(i) >= views.size())
      fail(path, "names a buffer view that it does not have");
    const Json& v = views[static_cast<std::size_t>(i)];
    constexpr std::int64_t kMost = std::int64_t{1} << 40;
    const std::int64_t buffer = number(v, "buffer", 0, kMost),
                       length = number(v, "byteLength", 1, kMost);
    const std::int64_t offset = v.contains("byteOffset") ? number(v, "byteOffset", 0, kMost) : 0;
    const Json& buffers = any_member(own, "buffers");
    if (!buffers.is_array() || buffer < 0 || static_cast<std::size_t>(buffer) >= buffers.size())
      fail(path, "names a buffer that it does not have");
    const Json& uri = any_member(buffers[static_cast<std::size_t>(buffer)], "uri");
    const std::string all = uri.is_string() ? read(uri.get<std::string>()) : rest;
    if (offset < 0 || length < 0 || static_cast<std::size_t>(offset + length) > all.size())
      fail(path, "a buffer view reaches beyond its buffer");
    return all.substr(static_cast<std::size_t>(offset), static_cast<std::size_t>(length));
  };
  const auto bits = [&](const Json& availability, std::uint64_t count) {
    Bits out;
    constexpr std::int64_t kMost = 1 << 20;
    std::int64_t at = number(availability, "bitstream", 0, kMost);
    if (at < 0) at = number(availability, "bufferView", 0, kMost);
    if (at < 0) {
      out.is_all = number(availability, "constant", 0, 1) == 1;
      return out;
    }
    out.bytes = view(at);
    if (out.bytes.size() < (count + 7) / 8) fail(path, "an availability is too short");
    return out;
  };
  const std::uint64_t leaves = power(branches_, tiling.subtree_levels);
  const std::uint64_t all = index_of(tiling.subtree_levels, 0);
  tiles_ = bits(any_member(json, "tileAvailability"), all);
  subtrees_ = bits(any_member(json, "childSubtreeAvailability"), leaves);
  const Json& contents = any_member(json, "contentAvailability");
  if (contents.is_array())
    for (const Json& content : contents) contents_.push_back(bits(content, all));
  else if (contents.is_object())
    contents_.push_back(bits(contents, all));
}

bool Subtree::Bits::at(std::uint64_t i) const {
  if (bytes.empty()) return is_all;
  return i / 8 < bytes.size() && (static_cast<unsigned char>(bytes[i / 8]) >> (i % 8) & 1) != 0;
}

std::uint64_t Subtree::index_of(int level, std::uint64_t morton) const {
  return (power(branches_, level) - 1) / static_cast<std::uint64_t>(branches_ - 1) + morton;
}

bool Subtree::has_tile(int level, std::uint64_t morton) const {
  return tiles_.at(index_of(level, morton));
}

bool Subtree::has_content(std::size_t content, int level, std::uint64_t morton) const {
  return content < contents_.size() && contents_[content].at(index_of(level, morton));
}

bool Subtree::has_subtree(std::uint64_t morton) const { return subtrees_.at(morton); }

}  // namespace colod::mesh_io
