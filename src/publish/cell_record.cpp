// Based on: CBOR (RFC 8949) for records with arrays of numbers.
#include "cell_record.h"

#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "cbor.h"
#include "core/error.h"

namespace colod {
namespace {

using Json = nlohmann::json;

/// Little-endian, as scene files are.
template <typename T>
Json packed(const T* values, std::size_t count) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(values);
  return Json::binary(std::vector<std::uint8_t>(bytes, bytes + count * sizeof(T)));
}
template <typename T>
Json packed(const std::vector<T>& values) {
  return packed(values.data(), values.size());
}

template <typename T>
std::vector<T> unpacked(const Json& json) {
  const auto& bytes = json.get_binary();
  std::vector<T> values(bytes.size() / sizeof(T));
  if (bytes.size() != values.size() * sizeof(T)) throw std::runtime_error("an array's length");
  if (!bytes.empty()) std::memcpy(static_cast<void*>(values.data()), bytes.data(), bytes.size());
  return values;
}

Json packed(const std::string& bytes) { return packed(bytes.data(), bytes.size()); }
std::string text_of(const Json& json) {
  const auto& bytes = json.get_binary();
  return {bytes.begin(), bytes.end()};
}

template <typename Read>
auto read_piece(const std::string& piece, const std::string& where, const Read& read) {
  try {
    return read(Json::from_cbor(piece));
  } catch (const std::exception& e) {
    throw Error(Stage::kInput, where,
                std::string("is damaged: run colod export again: ") + e.what());
  }
}

Json vec_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
Vec3 vec_of(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

Json outline_json(const TileOutline& o) {
  const StandInBox& s = o.stand_in;
  return {{"min", vec_json(o.box.min)},
          {"max", vec_json(o.box.max)},
          {"triangles", o.triangles},
          {"has_look", o.has_look},
          {"origin", vec_json(s.origin)},
          {"yaw", s.yaw},
          {"half", vec_json(s.half)},
          {"gsd", s.gsd},
          {"error", s.error}};
}

TileOutline outline_from(const Json& json) {
  TileOutline o;
  o.box = {vec_of(json.at("min")), vec_of(json.at("max"))};
  o.triangles = json.at("triangles");
  o.has_look = json.at("has_look");
  o.stand_in.origin = vec_of(json.at("origin"));
  o.stand_in.yaw = json.at("yaw");
  o.stand_in.half = vec_of(json.at("half"));
  o.stand_in.gsd = json.at("gsd");
  o.stand_in.error = json.at("error");
  return o;
}

/// The counts of a tally, in an order of their own.
template <typename T, typename Visit>
void visit_tally(T& t, const Visit& visit) {
  for (auto* count :
       {&t.buildings, &t.done, &t.lossy, &t.amiss, &t.failed, &t.failed_layers, &t.stand_in_layers,
        &t.lost_bodies, &t.lost_textures, &t.segments, &t.beyond_layer0})
    visit(*count);
}

Json tally_json(const Tally& t) {
  Json json = Json::array();
  visit_tally(t, [&](std::size_t count) { json.push_back(count); });
  json.push_back(t.rays);
  json.push_back(t.ray_seconds);
  return json;
}

Tally tally_from(const Json& json) {
  Tally t;
  std::size_t next = 0;
  visit_tally(t, [&](std::size_t& count) { count = json.at(next++); });
  t.rays = json.at(next++);
  t.ray_seconds = json.at(next);
  return t;
}

Json packed_building(const ExportBuilding& b) {
  Json levels = Json::array(), attributes = Json::array();
  for (const ExportLevel& level : b.levels)
    levels.push_back(
        {{"layers", level.layers}, {"gsd", level.gsd}, {"deviation", level.deviation}});
  for (const auto& [name, value] : b.attributes)
    attributes.push_back({packed(name), packed(value)});
  return {{"name", packed(b.name)},
          {"source", packed(b.source)},
          {"given_name", packed(b.given_name)},
          {"origin", vec_json(b.origin)},
          {"levels", levels},
          {"attributes", attributes}};
}

ExportBuilding building_from(const Json& json) {
  ExportBuilding b{.name = text_of(json.at("name")),
                   .source = text_of(json.at("source")),
                   .origin = vec_of(json.at("origin")),
                   .levels = {},
                   .given_name = text_of(json.at("given_name"))};
  for (const Json& l : json.at("levels")) {
    b.levels.emplace_back();
    b.levels.back().layers = l.at("layers").get<std::vector<int>>();
    b.levels.back().gsd = l.at("gsd");
    b.levels.back().deviation = l.at("deviation");
  }
  for (const Json& a : json.at("attributes"))
    b.attributes.emplace_back(text_of(a.at(0)), text_of(a.at(1)));
  return b;
}

std::string facts_of(const CellRecord& r) {
  Json messages = Json::array(), parts = Json::array(), files = Json::array();
  for (const Message& m : r.messages)
    messages.push_back({static_cast<int>(m.level), packed(m.text)});
  for (const PartFacts& p : r.parts) parts.push_back({p.layer, p.extent, p.area, p.is_flat});
  for (const WrittenFile& f : r.files) files.push_back({packed(f.path), f.bytes, f.hash});
  return cbor_of({{"key", r.key},
                  {"building", packed_building(r.building)},
                  {"path", packed(r.path)},
                  {"outline", outline_json(r.outline)},
                  {"not_in_tiles", packed(r.not_in_tiles)},
                  {"tally", tally_json(r.tally)},
                  {"messages", messages},
                  {"parts", parts},
                  {"files", files},
                  {"pictures", r.pictures}});
}

std::string level_bytes(const ExportLevel& level) {
  std::vector<int> planes, rings;  // rings: how many, then of each its length and indices
  std::vector<Vec3> normals;
  for (const PolygonMesh::Facet& f : level.mesh.facets) {
    normals.push_back(f.normal), planes.push_back(f.plane);
    rings.push_back(static_cast<int>(f.rings.size()));
    for (const std::vector<int>& ring : f.rings) {
      rings.push_back(static_cast<int>(ring.size()));
      rings.insert(rings.end(), ring.begin(), ring.end());
    }
  }
  const LevelLook& look = level.look;
  return cbor_of({{"vertices", packed(level.mesh.vertices)},
                  {"normals", packed(normals)},
                  {"planes", packed(planes)},
                  {"rings", packed(rings)},
                  {"triangles", packed(level.mesh.triangles)},
                  {"facet_of_triangle", packed(level.mesh.facet_of_triangle)},
                  {"uvs", packed(look.uvs)},
                  {"image", packed(look.image)},
                  {"fallback", packed(look.fallback)},
                  {"width", look.width},
                  {"height", look.height},
                  {"format", static_cast<int>(look.format)},
                  {"quality", look.quality},
                  {"has_fallback", look.has_fallback},
                  {"raster_width", look.raster.width},
                  {"raster_height", look.raster.height},
                  {"rgb", packed(look.raster.rgb)},
                  {"alpha", packed(look.raster.alpha)},
                  {"facet_colors", packed(look.facet_colors)}});
}

void read_facets(const Json& json, PolygonMesh& mesh) {
  const auto normals = unpacked<Vec3>(json.at("normals"));
  const auto planes = unpacked<int>(json.at("planes")), rings = unpacked<int>(json.at("rings"));
  std::size_t next = 0;
  for (std::size_t f = 0; f < normals.size(); ++f) {
    PolygonMesh::Facet facet{normals[f], planes.at(f), {}};
    for (int left = rings.at(next++); left > 0; --left) {
      const auto size = static_cast<std::size_t>(std::max(0, rings.at(next++)));
      if (size > rings.size() - next) throw std::runtime_error("a ring's length");
      const auto begin = rings.begin() + static_cast<std::ptrdiff_t>(next);
      facet.rings.emplace_back(begin, begin + static_cast<std::ptrdiff_t>(size));
      next += size;
    }
    mesh.facets.push_back(std::move(facet));
  }
}

/// What exporters take for granted.
void check_indices(const std::vector<Face>& faces, std::size_t vertices,
                   const std::vector<int>& facet_of_triangle, std::size_t facets) {
  const auto is_below = [](int i, std::size_t size) {
    return i >= 0 && static_cast<std::size_t>(i) < size;
  };
  bool is_sound = facet_of_triangle.size() == faces.size();
  for (const Face& f : faces)
    for (const int v : f) is_sound = is_sound && is_below(v, vertices);
  for (const int f : facet_of_triangle) is_sound = is_sound && is_below(f, facets);
  if (!is_sound) throw std::runtime_error("an index points nowhere");
}

Json descriptor_json(const Descriptor& d) {
  return {packed(d.d2.data(), d.d2.size()), vec_json(d.eigenvalues), static_cast<int>(d.kind)};
}

}  // namespace

std::string level_piece(std::size_t level) { return "level" + std::to_string(level); }
std::string picture_piece(std::size_t picture) { return "picture" + std::to_string(picture); }

Shelf::Pieces to_pieces(const CellRecord& record, const std::string& row, const std::string& lods,
                        const std::vector<Descriptor>& descriptors,
                        const std::vector<std::string>& pictures) {
  Shelf::Pieces pieces;
  pieces[kFacts] = facts_of(record);
  pieces[kRow] = row;
  pieces[kLods] = lods;
  const std::vector<ExportLevel>& levels = record.building.levels;
  for (std::size_t i = 0; i < levels.size(); ++i) pieces[level_piece(i)] = level_bytes(levels[i]);
  if (!levels.empty()) {
    const CoarsestLook look = coarsest_look(levels.front());
    pieces[kCoarsest] = cbor_of({{"vertices", packed(look.mesh.vertices)},
                                 {"faces", packed(look.mesh.faces)},
                                 {"facet_of_triangle", packed(look.facet_of_triangle)},
                                 {"facet_colors", packed(look.facet_colors)}});
  }
  Json list = Json::array();
  for (const Descriptor& d : descriptors) list.push_back(descriptor_json(d));
  pieces[kDescriptors] = cbor_of(list);
  for (std::size_t i = 0; i < pictures.size(); ++i) pieces[picture_piece(i)] = pictures[i];
  return pieces;
}

CellRecord record_of(const std::string& facts, const std::string& where) {
  return read_piece(facts, where, [](const Json& json) {
    CellRecord r;
    r.key = json.at("key");
    r.building = building_from(json.at("building"));
    r.path = text_of(json.at("path"));
    r.outline = outline_from(json.at("outline"));
    r.outline.source = source_id(r.building.source);
    r.not_in_tiles = text_of(json.at("not_in_tiles"));
    r.tally = tally_from(json.at("tally"));
    for (const Json& m : json.at("messages"))
      r.messages.push_back({static_cast<Level>(m.at(0).get<int>()), text_of(m.at(1))});
    for (const Json& p : json.at("parts")) r.parts.push_back({p.at(0), p.at(1), p.at(2), p.at(3)});
    for (const Json& f : json.at("files")) r.files.push_back({text_of(f.at(0)), f.at(1), f.at(2)});
    r.pictures = json.at("pictures");
    return r;
  });
}

void fill_level(const std::string& piece, ExportLevel& level, const std::string& where) {
  read_piece(piece, where, [&](const Json& json) {
    level.mesh = {};
    level.mesh.vertices = unpacked<Vec3>(json.at("vertices"));
    read_facets(json, level.mesh);
    level.mesh.triangles = unpacked<Face>(json.at("triangles"));
    level.mesh.facet_of_triangle = unpacked<int>(json.at("facet_of_triangle"));
    check_indices(level.mesh.triangles, level.mesh.vertices.size(), level.mesh.facet_of_triangle,
                  level.mesh.facets.size());
    LevelLook& look = level.look;
    look.uvs = unpacked<std::array<Vec2f, 3>>(json.at("uvs"));
    look.image = text_of(json.at("image"));
    look.fallback = text_of(json.at("fallback"));
    look.width = json.at("width"), look.height = json.at("height");
    look.format = static_cast<ImageFormat>(json.at("format").get<int>());
    look.quality = json.at("quality");
    look.has_fallback = json.at("has_fallback");
    look.raster.width = json.at("raster_width"), look.raster.height = json.at("raster_height");
    look.raster.rgb = unpacked<std::uint8_t>(json.at("rgb"));
    look.raster.alpha = unpacked<std::uint8_t>(json.at("alpha"));
    look.facet_colors = unpacked<Rgb>(json.at("facet_colors"));
    return true;
  });
}

CoarsestLook coarsest_of(const std::string& piece, const std::string& where) {
  return read_piece(piece, where, [](const Json& json) {
    CoarsestLook look;
    look.mesh.vertices = unpacked<Vec3>(json.at("vertices"));
    look.mesh.faces = unpacked<Face>(json.at("faces"));
    look.facet_of_triangle = unpacked<int>(json.at("facet_of_triangle"));
    look.facet_colors = unpacked<Rgb>(json.at("facet_colors"));
    const std::size_t facets = look.facet_colors.empty() ? std::numeric_limits<std::size_t>::max()
                                                         : look.facet_colors.size();
    check_indices(look.mesh.faces, look.mesh.vertices.size(), look.facet_of_triangle, facets);
    return look;
  });
}

Descriptor descriptor_of(const std::string& piece, std::size_t segment, const std::string& where) {
  return read_piece(piece, where, [&](const Json& json) {
    const Json& own = json.at(segment);
    Descriptor d;
    const auto d2 = unpacked<double>(own.at(0));
    if (d2.size() != d.d2.size()) throw std::runtime_error("a histogram's length");
    std::copy(d2.begin(), d2.end(), d.d2.begin());
    d.eigenvalues = vec_of(own.at(1));
    d.kind = static_cast<ElementKind>(own.at(2).get<int>());
    return d;
  });
}

}  // namespace colod
