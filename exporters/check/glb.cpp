// Based on: glTF 2.0, KHR_draco_mesh_compression, EXT_meshopt_compression, MSFT_lod,
// EXT_mesh_features, EXT_structural_metadata: what they demand and validators do not decode.
// Differs: reads what colod writes; of other files, what it does not know is left out, not guessed.
#include <algorithm>
#include <bit>
#include <climits>
#include <cmath>
#include <limits>
#include <new>
#include <set>
#include <stdexcept>

#include "accessors.h"
#include "check.h"
#include "core/error.h"
#include "exporters/gltf/draco.h"
#include "exporters/gltf/gltf.h"

namespace colod {

using Json = nlohmann::json;

namespace {

constexpr double kBoundsSlack = 1e-5;  // metres, and relative
constexpr double kLeastCosine = 0.5;   // between a face and its corners' normals
constexpr std::uint32_t kNoFeature = std::numeric_limits<std::uint32_t>::max();

/// Rounding moves each corner by half a cell's diagonal at most. A face that it turned by 60
/// degrees is therefore lower than 2.65 steps: its height's and its longest side's slopes are at
/// most that diagonal over their lengths, and the side is 2 / sqrt(3) times the height at least.
constexpr double kThinnest = 2.65;

using Glb = CheckedGlb;
using MeshContent = GlbContent::MeshContent;

std::vector<Vec3> as_points(const std::vector<double>& values) {
  std::vector<Vec3> out;
  for (std::size_t i = 0; i + 2 < values.size(); i += 3)
    out.push_back(from_gltf({values[i], values[i + 1], values[i + 2]}));
  return out;
}

/// Ids as they are stored; anything but a whole number becomes one that no table has.
std::vector<std::uint32_t> as_ids(const std::vector<double>& values) {
  std::vector<std::uint32_t> out;
  for (const double v : values)
    out.push_back(v >= 0 && v < 4294967295.0 && v == std::floor(v) ? static_cast<std::uint32_t>(v)
                                                                   : kNoFeature);
  return out;
}

/// Attributes by Draco unique id; false where the ids cannot be those of such attributes.
bool read_draco(Glb& glb, const Json& primitive, const std::string& place, MeshContent& out) {
  const Json& extension = primitive.at("extensions").at("KHR_draco_mesh_compression");
  const Json& view = glb.json.at("bufferViews").at(whole_number(extension.at("bufferView")));
  const std::string stream = slice(glb, view);
  const DracoCounts stated = stated_counts(stream);
  glb.spend(stated.faces + stated.vertices);
  const DracoContent draco = decode_draco(stream);
  const Json& attributes = extension.at("attributes");
  const auto attribute_of = [&](const char* name) {
    if (!attributes.contains(name)) return draco.attributes.end();
    const std::size_t id = whole_number(attributes.at(name));
    return id > INT_MAX ? draco.attributes.end() : draco.attributes.find(static_cast<int>(id));
  };
  const auto values = [&](const char* name, int components) -> const std::vector<double>* {
    const auto found = attribute_of(name);
    if (found == draco.attributes.end() || found->second.components != components) {
      glb.report("draco-ids", place,
                 std::string(name) + " names no Draco attribute of " + std::to_string(components) +
                     " components");
      return nullptr;
    }
    return &found->second.values;
  };
  for (const auto& [name, id] : attributes.items())
    if (!primitive.at("attributes").contains(name))
      glb.report("draco-ids", place, name + " is not an attribute of the primitive");
  const auto* positions = values("POSITION", 3);
  if (!positions) return false;
  out.positions = as_points(*positions);
  if (extension.at("attributes").contains("NORMAL")) {
    const auto* normals = values("NORMAL", 3);
    if (!normals) return false;
    out.normals = as_points(*normals);
  }
  if (extension.at("attributes").contains("_FEATURE_ID_0")) {
    const auto* ids = values("_FEATURE_ID_0", 1);
    if (!ids) return false;
    out.features = as_ids(*ids);
  }
  out.faces = draco.faces;
  const Json& accessors = glb.json.at("accessors");
  for (const auto& [name, accessor] : primitive.at("attributes").items())
    if (accessors.at(whole_number(accessor)).at("count") != draco.vertices)
      glb.report("draco-counts", place, name + "'s count is not the decoded number of vertices");
  if (accessors.at(whole_number(primitive.at("indices"))).at("count") != 3 * draco.faces.size())
    glb.report("draco-counts", place, "the indices' count is not that of the decoded faces");
  return true;
}

bool read_plain(Glb& glb, const Json& primitive, const std::string& place, MeshContent& out) {
  const Json& attributes = primitive.at("attributes");
  const auto read = [&](const Json& index, std::size_t components) {
    return read_accessor(glb, glb.json.at("accessors").at(whole_number(index)), components);
  };
  out.positions = as_points(read(attributes.at("POSITION"), 3));
  if (attributes.contains("NORMAL")) out.normals = as_points(read(attributes.at("NORMAL"), 3));
  if (attributes.contains("_FEATURE_ID_0"))
    out.features = as_ids(read(attributes.at("_FEATURE_ID_0"), 1));
  const std::vector<double> indices = read(primitive.at("indices"), 1);
  const auto beyond = static_cast<double>(out.positions.size());
  if (!std::all_of(indices.begin(), indices.end(),
                   [&](double i) { return i >= 0 && i < beyond && i == std::floor(i); })) {
    glb.report("accessor", place, "an index reaches beyond the vertices");
    return false;
  }
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
    out.faces.push_back({static_cast<int>(indices[i]), static_cast<int>(indices[i + 1]),
                         static_cast<int>(indices[i + 2])});
  return true;
}

/// Or none at all.
bool has_normals(const MeshContent& mesh) {
  return mesh.normals.empty() || mesh.normals.size() == mesh.positions.size();
}

/// Corners and values that exist, for all that looks at them.
bool is_whole(Glb& glb, const std::string& place, const MeshContent& mesh) {
  const int count = static_cast<int>(mesh.positions.size());
  const bool is_sound = std::all_of(mesh.faces.begin(), mesh.faces.end(), [&](const Face& f) {
    return std::all_of(f.begin(), f.end(), [&](int v) { return v >= 0 && v < count; });
  });
  if (!is_sound)
    glb.report("accessor", place, "an index reaches beyond the vertices");
  else if (!has_normals(mesh))
    glb.report("accessor", place, "normals and positions differ in number");
  return is_sound && has_normals(mesh);
}

bool is_unlit(const Glb& glb, const Json& primitive) {
  if (!primitive.contains("material")) return false;
  const Json& material = glb.json.at("materials").at(whole_number(primitive.at("material")));
  return material.value("extensions", Json::object()).contains("KHR_materials_unlit");
}

void check_bounds(Glb& glb, const Json& primitive, const std::string& place,
                  const MeshContent& mesh) {
  const std::size_t index = whole_number(primitive.at("attributes").at("POSITION"));
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

/// The step of the grid that positions were rounded to: the largest power of two that all
/// coordinates are multiples of.
double step_of(const std::vector<Vec3>& positions) {
  int least = std::numeric_limits<int>::max();
  for (const Vec3& p : positions)
    for (const double x : p) {
      int exponent = 0;
      if (x == 0 || !std::isfinite(x)) continue;
      const auto digits =
          static_cast<std::uint64_t>(std::ldexp(std::abs(std::frexp(x, &exponent)), 53));
      least = std::min(least, exponent - 53 + std::countr_zero(digits));
    }
  return least == std::numeric_limits<int>::max() ? 0 : std::ldexp(1.0, least);
}

/// Facets' normals are exact, the corners rounded: what light and shading see is the normal, and a
/// face that is thinner than rounding turns it is not seen.
std::size_t count_turned_faces(const MeshContent& mesh) {
  if (mesh.normals.empty()) return 0;
  const double thinnest = kThinnest * step_of(mesh.positions);
  return std::count_if(mesh.faces.begin(), mesh.faces.end(), [&](const Face& f) {
    const Vec3 a = mesh.positions[f[0]], ab = mesh.positions[f[1]] - a,
               ac = mesh.positions[f[2]] - a, cross = ab.cross(ac);
    const double longest = std::max({ab.norm(), ac.norm(), (ac - ab).norm()});
    return cross.norm() > thinnest * longest &&
           cross.normalized().dot(mesh.normals[f[0]]) < kLeastCosine;
  });
}

void check_surface(Glb& glb, const Json& primitive, const std::string& place,
                   const MeshContent& mesh) {
  if (mesh.normals.empty() && !is_unlit(glb, primitive))
    glb.report("normals", place, "no normals, though its material is lit");
  std::size_t not_finite = 0, not_unit = 0;
  for (const Vec3& p : mesh.positions) not_finite += !p.allFinite();
  for (const Vec3& n : mesh.normals) not_unit += !(std::abs(n.norm() - 1) < 0.05);
  if (not_finite) glb.report("positions", place, "positions that are not finite");
  if (not_unit)
    glb.report("normals", place, std::to_string(not_unit) + " normals are not of length 1");
  if (const std::size_t turned = count_turned_faces(mesh); turned > 0)
    glb.report("normals", place, std::to_string(turned) + " faces are wound against their normals");
}

void check_features(Glb& glb, const Json& primitive, const std::string& place,
                    const MeshContent& mesh, std::size_t rows) {
  const Json features =
      primitive.value("extensions", Json::object()).value("EXT_mesh_features", Json());
  if (features.is_null()) return;
  const Json& ids = features.at("featureIds").at(0);
  const std::size_t count = whole_number(ids.at("featureCount"));
  if (mesh.features.size() != mesh.positions.size())
    return glb.report("features", place, "no feature id for every vertex");
  if (std::any_of(mesh.features.begin(), mesh.features.end(),
                  [&](std::uint32_t id) { return id >= count; }))
    glb.report("features", place, "a feature id reaches beyond featureCount");
  if (ids.contains("propertyTable") && count > rows)
    glb.report("features", place, "more features than rows in the property table");
  for (const Face& f : mesh.faces)
    if (mesh.features[f[0]] != mesh.features[f[1]] || mesh.features[f[0]] != mesh.features[f[2]]) {
      glb.report("features", place, "a face belongs to two features");
      return;
    }
}

std::string column(const Glb& glb, const Json& properties, const char* name,
                   const char* part = "values") {
  return slice(glb, glb.json.at("bufferViews").at(whole_number(properties.at(name).at(part))));
}

void check_alignment(Glb& glb, const Json& properties) {
  for (const auto& [property, parts] : properties.items())
    for (const char* part : {"values", "stringOffsets"}) {
      if (!parts.contains(part)) continue;
      const Json& view = glb.json.at("bufferViews").at(whole_number(parts[part]));
      if (whole_number_of(view, "byteOffset") % 8 != 0)
        glb.report("table", property, "its bytes do not start at a multiple of 8");
    }
}

/// The rows of the property table; reports what cannot be read.
void read_table(Glb& glb, GlbContent& out) {
  const Json metadata =
      glb.json.value("extensions", Json::object()).value("EXT_structural_metadata", Json());
  if (metadata.is_null()) return;
  const Json& table = metadata.at("propertyTables").at(0);
  const std::size_t count = whole_number(table.at("count"));
  const Json& properties = table.at("properties");
  check_alignment(glb, properties);
  const std::string names = column(glb, properties, "name"),
                    offsets = column(glb, properties, "name", "stringOffsets"),
                    layers = column(glb, properties, "layer"),
                    coarsest = column(glb, properties, "coarsest_layer"),
                    gsds = column(glb, properties, "gsd"),
                    deviations = column(glb, properties, "deviation");
  if (count > glb.binary.size() || offsets.size() != 4 * (count + 1) || gsds.size() != 4 * count ||
      deviations.size() != 4 * count || layers.size() != 2 * count ||
      coarsest.size() != 2 * count) {
    glb.report("table", "name", "columns are not as long as the table");
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t from = u32_at(offsets, 4 * i), to = u32_at(offsets, 4 * i + 4);
    if (from > to || to > names.size()) {
      glb.report("table", "name", "string offsets fall or reach beyond the strings");
      return;
    }
    const GlbContent::Row row{names.substr(from, to - from),
                              static_cast<int>(element_at(layers, 2 * i, 5122)),
                              static_cast<int>(element_at(coarsest, 2 * i, 5122)),
                              element_at(gsds, 4 * i, 5126), element_at(deviations, 4 * i, 5126)};
    if (!(row.gsd >= 0) || !(row.deviation >= 0))
      glb.report("table", "gsd", "a gsd or deviation below zero");
    if (row.coarsest_layer > row.layer)
      glb.report("table", "layer", "coarsest_layer is finer than layer");
    out.rows.push_back(row);
  }
}

/// Whether every position of one mesh is one of the other's, to within what both are rounded by,
/// and both have as many faces.
bool is_alike(Glb& glb, const MeshContent& a, const MeshContent& b) {
  constexpr double kReach = 0.006;              // metres: a default grid, and the finest level's
  const Vec3 oblique(0.36, 0.48, 0.8);          // few walls lie across it
  const double reach = kReach * oblique.sum();  // along it
  if (a.faces.size() != b.faces.size() || a.positions.size() != b.positions.size()) return false;
  std::vector<std::pair<double, const Vec3*>> sorted;
  for (const Vec3& p : b.positions) sorted.emplace_back(oblique.dot(p), &p);
  std::sort(sorted.begin(), sorted.end());
  return std::all_of(a.positions.begin(), a.positions.end(), [&](const Vec3& p) {
    const double along = oblique.dot(p);
    const auto first = std::lower_bound(sorted.begin(), sorted.end(),
                                        std::pair<double, const Vec3*>(along - reach, nullptr));
    for (auto q = first; q != sorted.end() && q->first <= along + reach; ++q) {
      glb.spend(1);
      if ((*q->second - p).cwiseAbs().maxCoeff() <= kReach) return true;
    }
    return false;
  });
}

/// A switch's ground sample distance as the node says it.
double gsd_of(const Json& node) { return node.value("extras", Json::object()).value("gsd", 0.0); }

/// Coverages fall strictly from at most 1 to 0, and are D / (g·H) where the file says H.
void check_coverage(Glb& glb, const std::string& place, const Json& node,
                    const std::vector<double>& gsds, double diameter) {
  constexpr double kRounding =
      0.02;  // relative: D is of rounded positions, coverages are kept apart
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
    if (std::abs(told - measured) > kRounding * measured)
      glb.report("lod-coverage", place, "a coverage is not what the next level's gsd makes it");
  }
}

/// Joins a primitive to a mesh; where others have feature ids and it has none, no row has its.
void append(const MeshContent& part, MeshContent& mesh) {
  const auto first = static_cast<int>(mesh.positions.size());
  const bool has_features = !part.features.empty() || !mesh.features.empty();
  mesh.positions.insert(mesh.positions.end(), part.positions.begin(), part.positions.end());
  if (has_features) {
    mesh.features.resize(static_cast<std::size_t>(first), kNoFeature);
    mesh.features.insert(mesh.features.end(), part.features.begin(), part.features.end());
    mesh.features.resize(mesh.positions.size(), kNoFeature);
  }
  for (Face f : part.faces) {
    for (int& v : f) v += first;
    mesh.faces.push_back(f);
  }
}

/// Primitive by primitive; empty where one of them is damaged.
void read_mesh(Glb& glb, const Json& primitives, const std::string& where, GlbContent& out) {
  MeshContent& mesh = out.meshes.emplace_back();
  if (primitives.empty()) return glb.report("json", where, "a mesh without primitives");
  bool is_whole_mesh = true;
  for (std::size_t p = 0; p < primitives.size(); ++p) {
    const Json& primitive = primitives.at(p);
    const std::string place =
        where + (primitives.size() > 1 ? ", primitive " + std::to_string(p) : "");
    const bool is_draco =
        primitive.value("extensions", Json::object()).contains("KHR_draco_mesh_compression");
    MeshContent part;
    if (!(is_draco ? read_draco : read_plain)(glb, primitive, place, part) ||
        !is_whole(glb, place, part)) {
      is_whole_mesh = false;
      continue;
    }
    check_bounds(glb, primitive, place, part);
    check_surface(glb, primitive, place, part);
    check_features(glb, primitive, place, part, out.rows.size());
    append(part, mesh);
  }
  if (!is_whole_mesh) mesh = {};
}

std::set<std::size_t> scene_roots(const Json& json) {
  std::set<std::size_t> roots;
  for (const Json& scene : json.value("scenes", Json::array()))
    for (const Json& root : scene.value("nodes", Json::array())) roots.insert(whole_number(root));
  return roots;
}

/// The levels' nodes, finest first: in no scene, named, lighter and lighter, for farther and
/// farther away, no two alike.
void check_levels(Glb& glb, const GlbContent& content) {
  const Json nodes = glb.json.value("nodes", Json::array());
  const std::set<std::size_t> roots = scene_roots(glb.json);
  const auto mesh = [&](const Json& of) -> const MeshContent& {
    return content.meshes.at(whole_number(of.at("mesh")));
  };
  const auto layer = [](const Json& of) {
    return of.value("extras", Json::object()).value("layer", -1.0);  // anything may stand there
  };
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const Json lod = nodes[n].value("extensions", Json::object()).value("MSFT_lod", Json());
    if (lod.is_null()) continue;
    const std::string place = "node " + std::to_string(n);
    std::vector<std::size_t> levels = {n};
    for (const Json& id : lod.at("ids")) levels.push_back(whole_number(id));
    for (std::size_t i = 0; i < levels.size(); ++i) {
      const Json& node = nodes.at(levels[i]);
      if (!node.value("name", std::string()).ends_with("_LOD" + std::to_string(i)))
        glb.report("lod-names", place,
                   "level " + std::to_string(i) + " is not named _LOD" + std::to_string(i));
      if (i == 0) continue;
      if (roots.contains(levels[i]))
        glb.report("lod-nodes", place, "a lower level stands in a scene");
      const Json& finer = nodes.at(levels[i - 1]);
      glb.spend(mesh(node).positions.size());
      if (layer(node) >= layer(finer) || mesh(node).faces.size() > mesh(finer).faces.size())
        glb.report("lod-order", place, "levels do not go from fine to coarse");
      if (!(gsd_of(node) > gsd_of(finer)))
        glb.report("lod-gsd", place, "a coarser level's gsd is not greater than the finer one's");
      if (is_alike(glb, mesh(node), mesh(finer)))
        glb.report("lod-alike", place, "two levels are the same mesh");
    }
    std::vector<double> gsds;
    for (const std::size_t level : levels) gsds.push_back(gsd_of(nodes.at(level)));
    if (gsds.front() != 0) glb.report("lod-gsd", place, "the finest level's gsd is not 0");
    Box box;
    for (const Vec3& p : mesh(nodes[n]).positions) box.extend(p);
    check_coverage(glb, place, nodes[n], gsds, box.diagonal());
  }
}

}  // namespace

GlbContent check_glb(const std::string& bytes, const std::string& where,
                     std::vector<Finding>& findings) {
  Glb glb{where, findings, {}, {}, 0};
  GlbContent out;
  if (!open_container(glb, bytes)) return out;
  try {
    read_table(glb, out);
    const Json meshes = glb.json.value("meshes", Json::array());
    for (std::size_t m = 0; m < meshes.size(); ++m)
      read_mesh(glb, meshes[m].at("primitives"), "mesh " + std::to_string(m), out);
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
  } catch (const std::length_error& error) {
    glb.report("too-large", "", error.what());
  } catch (const std::bad_alloc&) {
    glb.report("too-large", "", "what it states does not fit into memory");
  }
  out.json = std::move(glb.json);
  return out;
}

}  // namespace colod
