// Based on: glTF 2.0, KHR_draco_mesh_compression, EXT_meshopt_compression, MSFT_lod,
// EXT_mesh_features, EXT_structural_metadata: what they demand and validators do not decode.
// Differs: reads what colod writes; of other files, what it does not know is left out, not guessed.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "../src/error.h"
#include "check.h"
#include "draco.h"
#include "gltf.h"
#include "meshopt.h"

namespace colod {

using Json = nlohmann::json;

namespace {

constexpr double kBoundsSlack = 1e-5;  // metres, and relative
constexpr double kLeastCosine = 0.5;   // between a face and its corners' normals

struct Glb {
  const std::string& where;
  std::vector<Finding>& findings;
  Json json;
  std::string binary;

  void report(const std::string& code, const std::string& place, const std::string& message) {
    findings.push_back({code, where + (place.empty() ? "" : " " + place), message});
  }
};

std::uint32_t u32(const std::string& bytes, std::size_t at) {
  std::uint32_t value;
  std::memcpy(&value, bytes.data() + at, 4);
  return value;
}

bool open_container(Glb& glb, const std::string& bytes) {
  const auto fail = [&](const char* cause) {
    glb.report("glb-container", "", cause);
    return false;
  };
  if (bytes.size() < 20 || bytes.compare(0, 4, "glTF") != 0 || u32(bytes, 4) != 2)
    return fail("not a binary glTF 2.0");
  if (u32(bytes, 8) != bytes.size()) return fail("the header's length is not the file's");
  const std::size_t length = u32(bytes, 12);
  if (bytes.compare(16, 4, "JSON") != 0 || length > bytes.size() - 20)
    return fail("the first chunk is not JSON, or longer than the file");
  glb.json = Json::parse(bytes.substr(20, length), nullptr, false);
  if (!glb.json.is_object()) return fail("the JSON chunk does not parse");
  const std::size_t bin = 20 + length;
  if (bin + 8 > bytes.size()) return true;
  if (bytes.compare(bin + 4, 4, std::string("BIN\0", 4)) != 0 ||
      u32(bytes, bin) > bytes.size() - bin - 8)
    return fail("the second chunk is not BIN, or longer than the file");
  glb.binary = bytes.substr(bin + 8, u32(bytes, bin));
  return true;
}

/// Bytes of a range of the BIN chunk; throws std::out_of_range with a readable message.
std::string slice(const Glb& glb, const Json& range) {
  const auto offset = range.value("byteOffset", std::size_t{0});
  const auto length = range.at("byteLength").get<std::size_t>();
  if (range.value("buffer", 0) != 0 || offset > glb.binary.size() ||
      length > glb.binary.size() - offset)
    throw std::out_of_range("a buffer view lies outside the BIN chunk");
  return glb.binary.substr(offset, length);
}

struct View {
  std::string bytes;
  std::size_t stride = 0;  // 0: tight
};

View read_view(const Glb& glb, const Json& index) {
  const Json& view = glb.json.at("bufferViews").at(index.get<std::size_t>());
  const Json packed =
      view.value("extensions", Json::object()).value("EXT_meshopt_compression", Json());
  if (packed.is_null()) return {slice(glb, view), view.value("byteStride", std::size_t{0})};
  const std::string payload = slice(glb, packed);
  const auto count = packed.at("count").get<std::size_t>();
  const auto stride = packed.at("byteStride").get<std::size_t>();
  View out{{}, stride};
  if (packed.at("mode") == "TRIANGLES") {
    for (const std::uint32_t i : decode_meshopt_indices(payload, count))
      out.bytes.append(reinterpret_cast<const char*>(&i), 4);
    out.stride = 4;
  } else {
    out.bytes = decode_meshopt_vertices(payload, count, stride);
  }
  if (out.bytes.empty()) throw std::out_of_range("a meshopt stream does not decode");
  return out;
}

double element(const std::string& bytes, std::size_t at, int type) {
  const auto get = [&](auto value) {
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return static_cast<double>(value);
  };
  switch (type) {
    case 5120:
      return get(std::int8_t{});
    case 5121:
      return get(std::uint8_t{});
    case 5122:
      return get(std::int16_t{});
    case 5123:
      return get(std::uint16_t{});
    case 5125:
      return get(std::uint32_t{});
    default:
      return get(float{});
  }
}

std::size_t size_of(int type) { return type <= 5121 ? 1 : type <= 5123 ? 2 : 4; }

/// All numbers of an accessor with a buffer view, `components` an element.
std::vector<double> read_accessor(const Glb& glb, const Json& accessor, std::size_t components) {
  const View view = read_view(glb, accessor.at("bufferView"));
  const int type = accessor.at("componentType");
  const std::size_t size = size_of(type), tight = size * components;
  const std::size_t stride = view.stride ? view.stride : tight, count = accessor.at("count");
  const std::size_t offset = accessor.value("byteOffset", std::size_t{0});
  if (count == 0 || offset + (count - 1) * stride + tight > view.bytes.size())
    throw std::out_of_range("an accessor reaches beyond its buffer view");
  const double scale = !accessor.value("normalized", false) ? 1 : type == 5120 ? 127 : 255;
  std::vector<double> out;
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = 0; k < components; ++k)
      out.push_back(element(view.bytes, offset + i * stride + k * size, type) / scale);
  return out;
}

using MeshContent = GlbContent::MeshContent;

std::vector<Vec3> as_points(const std::vector<double>& values) {
  std::vector<Vec3> out;
  for (std::size_t i = 0; i + 2 < values.size(); i += 3)
    out.push_back(from_gltf({values[i], values[i + 1], values[i + 2]}));
  return out;
}

/// Attributes by Draco unique id; false where the ids cannot be those of such attributes.
bool read_draco(Glb& glb, const Json& primitive, const std::string& place, MeshContent& out) {
  const Json& extension = primitive.at("extensions").at("KHR_draco_mesh_compression");
  const Json& view = glb.json.at("bufferViews").at(extension.at("bufferView").get<std::size_t>());
  const DracoContent draco = decode_draco(slice(glb, view));
  const auto values = [&](const char* name, int components) -> const std::vector<double>* {
    const auto found = draco.attributes.find(extension.at("attributes").value(name, -1));
    if (found == draco.attributes.end() || found->second.components != components) {
      glb.report("draco-ids", place,
                 std::string(name) + " names no Draco attribute of " + std::to_string(components) +
                     " components");
      return nullptr;
    }
    return &found->second.values;
  };
  for (const auto& [name, id] : extension.at("attributes").items())
    if (!primitive.at("attributes").contains(name))
      glb.report("draco-ids", place, name + " is not an attribute of the primitive");
  const auto *positions = values("POSITION", 3), *normals = values("NORMAL", 3);
  if (!positions || !normals) return false;
  out.positions = as_points(*positions);
  out.normals = as_points(*normals);
  if (extension.at("attributes").contains("_FEATURE_ID_0")) {
    const auto* ids = values("_FEATURE_ID_0", 1);
    if (!ids) return false;
    for (const double id : *ids) out.features.push_back(static_cast<std::uint32_t>(id));
  }
  out.faces = draco.faces;
  const Json& accessors = glb.json.at("accessors");
  for (const auto& [name, accessor] : primitive.at("attributes").items())
    if (accessors.at(accessor.get<std::size_t>()).at("count") != draco.vertices)
      glb.report("draco-counts", place, name + "'s count is not the decoded number of vertices");
  if (accessors.at(primitive.at("indices").get<std::size_t>()).at("count") !=
      3 * draco.faces.size())
    glb.report("draco-counts", place, "the indices' count is not that of the decoded faces");
  return true;
}

bool read_plain(Glb& glb, const Json& primitive, const std::string& place, MeshContent& out) {
  const Json& attributes = primitive.at("attributes");
  const auto accessor = [&](const Json& index) -> const Json& {
    return glb.json.at("accessors").at(index.get<std::size_t>());
  };
  out.positions = as_points(read_accessor(glb, accessor(attributes.at("POSITION")), 3));
  out.normals = as_points(read_accessor(glb, accessor(attributes.at("NORMAL")), 3));
  if (attributes.contains("_FEATURE_ID_0"))
    for (const double id : read_accessor(glb, accessor(attributes.at("_FEATURE_ID_0")), 1))
      out.features.push_back(static_cast<std::uint32_t>(id));
  const std::vector<double> indices = read_accessor(glb, accessor(primitive.at("indices")), 1);
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
    out.faces.push_back({static_cast<int>(indices[i]), static_cast<int>(indices[i + 1]),
                         static_cast<int>(indices[i + 2])});
  const auto beyond = static_cast<double>(out.positions.size());
  if (std::any_of(indices.begin(), indices.end(), [&](double i) { return i >= beyond; })) {
    glb.report("accessor", place, "an index reaches beyond the vertices");
    return false;
  }
  return true;
}

void check_bounds(Glb& glb, const Json& primitive, const std::string& place,
                  const MeshContent& mesh) {
  const std::size_t index = primitive.at("attributes").at("POSITION");
  const Json& accessor = glb.json.at("accessors").at(index);
  Box box;
  for (const Vec3& p : mesh.positions) box.extend(to_gltf(p));
  const double slack = kBoundsSlack * (1 + box.diagonal());
  for (int k = 0; k < 3; ++k)
    if (!accessor.contains("min") || !accessor.contains("max") ||
        std::abs(accessor["min"].at(k).get<double>() - box.min[k]) > slack ||
        std::abs(accessor["max"].at(k).get<double>() - box.max[k]) > slack) {
      glb.report("bounds", place, "POSITION's min and max are not those of the decoded positions");
      return;
    }
}

void check_surface(Glb& glb, const std::string& place, const MeshContent& mesh) {
  if (mesh.normals.size() != mesh.positions.size()) {
    glb.report("accessor", place, "normals and positions differ in number");
    return;
  }
  std::size_t not_finite = 0, not_unit = 0, against = 0;
  for (const Vec3& p : mesh.positions) not_finite += !p.allFinite();
  for (const Vec3& n : mesh.normals) not_unit += !(std::abs(n.norm() - 1) < 0.05);
  for (const Face& f : mesh.faces) {
    const Vec3 cross = (mesh.positions[f[1]] - mesh.positions[f[0]])
                           .cross(mesh.positions[f[2]] - mesh.positions[f[0]]);
    if (cross.norm() < 1e-3) continue;  // a sliver of rounded corners has any direction
    against += cross.normalized().dot(mesh.normals[f[0]]) < kLeastCosine;
  }
  if (not_finite) glb.report("positions", place, "positions that are not finite");
  if (not_unit)
    glb.report("normals", place, std::to_string(not_unit) + " normals are not of length 1");
  if (against > mesh.faces.size() / 100)
    glb.report("normals", place,
               std::to_string(against) + " faces are wound against their normals");
}

void check_features(Glb& glb, const Json& primitive, const std::string& place,
                    const MeshContent& mesh, std::size_t rows) {
  const Json features =
      primitive.value("extensions", Json::object()).value("EXT_mesh_features", Json());
  if (features.is_null()) return;
  const Json& ids = features.at("featureIds").at(0);
  const std::size_t count = ids.at("featureCount");
  if (mesh.features.size() != mesh.positions.size())
    glb.report("features", place, "no feature id for every vertex");
  if (std::any_of(mesh.features.begin(), mesh.features.end(),
                  [&](std::uint32_t id) { return id >= count; }))
    glb.report("features", place, "a feature id reaches beyond featureCount");
  if (ids.contains("propertyTable") && count > rows)
    glb.report("features", place, "more features than rows in the property table");
  for (const Face& f : mesh.faces)
    if (!mesh.features.empty() && (mesh.features[f[0]] != mesh.features[f[1]] ||
                                   mesh.features[f[0]] != mesh.features[f[2]])) {
      glb.report("features", place, "a face belongs to two features");
      return;
    }
}

std::string column(const Glb& glb, const Json& properties, const char* name,
                   const char* part = "values") {
  return slice(glb, glb.json["bufferViews"].at(properties.at(name).at(part).get<std::size_t>()));
}

void check_alignment(Glb& glb, const Json& properties) {
  for (const auto& [property, parts] : properties.items())
    for (const char* part : {"values", "stringOffsets"}) {
      if (!parts.contains(part)) continue;
      const Json& view = glb.json.at("bufferViews").at(parts[part].get<std::size_t>());
      if (view.value("byteOffset", std::size_t{0}) % 8 != 0)
        glb.report("table", property, "its bytes do not start at a multiple of 8");
    }
}

/// The rows of the property table; reports what cannot be read.
void read_table(Glb& glb, GlbContent& out) {
  const Json metadata =
      glb.json.value("extensions", Json::object()).value("EXT_structural_metadata", Json());
  if (metadata.is_null()) return;
  const Json& table = metadata.at("propertyTables").at(0);
  const std::size_t count = table.at("count");
  const Json& properties = table.at("properties");
  check_alignment(glb, properties);
  const std::string names = column(glb, properties, "name"),
                    offsets = column(glb, properties, "name", "stringOffsets"),
                    layers = column(glb, properties, "layer"),
                    coarsest = column(glb, properties, "coarsest_layer"),
                    gsds = column(glb, properties, "gsd"),
                    deviations = column(glb, properties, "deviation");
  if (offsets.size() != 4 * (count + 1) || gsds.size() != 4 * count ||
      deviations.size() != 4 * count || layers.size() != 2 * count ||
      coarsest.size() != 2 * count) {
    glb.report("table", "name", "columns are not as long as the table");
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t from = u32(offsets, 4 * i), to = u32(offsets, 4 * i + 4);
    if (from > to || to > names.size()) {
      glb.report("table", "name", "string offsets fall or reach beyond the strings");
      return;
    }
    const GlbContent::Row row{names.substr(from, to - from),
                              static_cast<int>(element(layers, 2 * i, 5122)),
                              static_cast<int>(element(coarsest, 2 * i, 5122)),
                              element(gsds, 4 * i, 5126), element(deviations, 4 * i, 5126)};
    if (!(row.gsd >= 0) || !(row.deviation >= 0))
      glb.report("table", "gsd", "a gsd or deviation below zero");
    if (row.coarsest_layer > row.layer)
      glb.report("table", "layer", "coarsest_layer is finer than layer");
    out.rows.push_back(row);
  }
}

/// Whether every position of one mesh is one of the other's, to within what both are rounded by,
/// and both have as many faces.
bool is_alike(const MeshContent& a, const MeshContent& b) {
  constexpr double kReach = 0.006;  // metres: a default grid, and the finest level's
  if (a.faces.size() != b.faces.size() || a.positions.size() != b.positions.size()) return false;
  const auto by_x = [](const Vec3& u, const Vec3& v) { return u.x() < v.x(); };
  std::vector<Vec3> sorted = b.positions;
  std::sort(sorted.begin(), sorted.end(), by_x);
  return std::all_of(a.positions.begin(), a.positions.end(), [&](const Vec3& p) {
    const Vec3 before = p - Vec3::Constant(kReach);
    for (auto q = std::lower_bound(sorted.begin(), sorted.end(), before, by_x);
         q != sorted.end() && q->x() <= p.x() + kReach; ++q)
      if ((*q - p).cwiseAbs().maxCoeff() <= kReach) return true;
    return false;
  });
}

/// A switch's ground sample distance as the node says it.
double gsd_of(const Json& node) { return node.value("extras", Json::object()).value("gsd", 0.0); }

/// Coverages fall strictly from at most 1 to 0, and are D / (g·H) where the file says H.
void check_coverage(Glb& glb, const std::string& place, const Json& node,
                    const std::vector<double>& gsds, double diameter) {
  constexpr double kSlack = 0.02;  // relative: D is of rounded positions, coverages are kept apart
  const Json coverage =
      node.value("extras", Json::object()).value("MSFT_screencoverage", Json::array());
  bool falls = coverage.size() == gsds.size();
  for (std::size_t i = 0; falls && i < coverage.size(); ++i)
    falls = coverage[i].get<double>() <= 1 && (i == 0 || coverage[i] < coverage[i - 1]);
  if (!falls || coverage.back() != 0) {
    glb.report("lod-coverage", place, "coverages do not fall strictly from at most 1 to 0");
    return;
  }
  const double height = glb.json.value("/asset/extras/switching/viewportHeight"_json_pointer, 0.0);
  for (std::size_t i = 0; height > 0 && i + 1 < gsds.size(); ++i) {
    const double told = coverage[i], measured = std::min(1.0, diameter / (gsds[i + 1] * height));
    if (std::abs(told - measured) > kSlack * measured)
      glb.report("lod-coverage", place, "a coverage is not what the next level's gsd makes it");
  }
}

/// The levels' nodes, finest first: in no scene, named, lighter and lighter, for farther and
/// farther away, no two alike.
void check_levels(Glb& glb, const GlbContent& content) {
  const Json nodes = glb.json.value("nodes", Json::array());
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const Json lod = nodes[n].value("extensions", Json::object()).value("MSFT_lod", Json());
    if (lod.is_null()) continue;
    const std::string place = "node " + std::to_string(n);
    std::vector<std::size_t> levels = {n};
    for (const Json& id : lod.at("ids")) levels.push_back(id.get<std::size_t>());
    for (std::size_t i = 0; i < levels.size(); ++i) {
      const Json& node = nodes.at(levels[i]);
      if (!node.value("name", std::string()).ends_with("_LOD" + std::to_string(i)))
        glb.report("lod-names", place,
                   "level " + std::to_string(i) + " is not named _LOD" + std::to_string(i));
      if (i == 0) continue;
      for (const Json& scene : glb.json.value("scenes", Json::array()))
        for (const Json& root : scene.value("nodes", Json::array()))
          if (root == levels[i]) glb.report("lod-nodes", place, "a lower level stands in a scene");
      const Json& finer = nodes.at(levels[i - 1]);
      const auto mesh = [&](const Json& of) -> const MeshContent& {
        return content.meshes.at(of.at("mesh").get<std::size_t>());
      };
      const auto layer = [](const Json& of) {
        return of.value("extras", Json::object()).value("layer", -1);
      };
      if (layer(node) >= layer(finer) || mesh(node).faces.size() > mesh(finer).faces.size())
        glb.report("lod-order", place, "levels do not go from fine to coarse");
      if (!(gsd_of(node) > gsd_of(finer)))
        glb.report("lod-gsd", place, "a coarser level's gsd is not greater than the finer one's");
      if (is_alike(mesh(node), mesh(finer)))
        glb.report("lod-alike", place, "two levels are the same mesh");
    }
    std::vector<double> gsds;
    for (const std::size_t level : levels) gsds.push_back(gsd_of(nodes.at(level)));
    if (gsds.front() != 0) glb.report("lod-gsd", place, "the finest level's gsd is not 0");
    Box box;
    for (const Vec3& p : content.meshes.at(nodes[n].at("mesh").get<std::size_t>()).positions)
      box.extend(p);
    check_coverage(glb, place, nodes[n], gsds, box.diagonal());
  }
}

}  // namespace

GlbContent check_glb(const std::string& bytes, const std::string& where,
                     std::vector<Finding>& findings) {
  Glb glb{where, findings, {}, {}};
  GlbContent out;
  if (!open_container(glb, bytes)) return out;
  try {
    read_table(glb, out);
    const Json meshes = glb.json.value("meshes", Json::array());
    for (std::size_t m = 0; m < meshes.size(); ++m) {
      const std::string place = "mesh " + std::to_string(m);
      const Json& primitive = meshes[m].at("primitives").at(0);
      const bool is_draco =
          primitive.value("extensions", Json::object()).contains("KHR_draco_mesh_compression");
      MeshContent& mesh = out.meshes.emplace_back();
      if (!(is_draco ? read_draco : read_plain)(glb, primitive, place, mesh)) {
        mesh = {};
        continue;
      }
      check_bounds(glb, primitive, place, mesh);
      check_surface(glb, place, mesh);
      check_features(glb, primitive, place, mesh, out.rows.size());
    }
    check_levels(glb, out);
    for (const Json& node : glb.json.value("nodes", Json::array()))
      for (const char* key : {"matrix", "translation", "rotation", "scale"})
        out.has_transforms |= node.contains(key);
  } catch (const Error& error) {
    glb.report("draco", "", error.what());
  } catch (const Json::exception& error) {
    glb.report("json", "", error.what());
  } catch (const std::out_of_range& error) {
    glb.report("accessor", "", error.what());
  }
  out.json = std::move(glb.json);
  return out;
}

}  // namespace colod
