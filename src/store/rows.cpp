// Based on: store.cpp.
// Differs: –
// Notation: –

#include <span>

#include "parts.h"

namespace colod {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(Validity, vertices, faces, polygons, least_width,
                                                is_watertight, is_manifold, boundary_edges,
                                                nonmanifold_edges, misoriented_edges,
                                                nonmanifold_vertices, self_intersections,
                                                degenerate_faces, components, enclosed_components,
                                                volume, area)
void to_json(nlohmann::json& json, const FaultPlace& f) {
  json = {f.size, f.place.x(), f.place.y(), f.place.z()};
}
void from_json(const nlohmann::json& json, FaultPlace& f) {
  f.size = json.at(0);
  for (int i = 0; i < 3; ++i) f.place[i] = json.at(1 + i);
}
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(Looks, triangles_ratio, wall_area, upright, aligned,
                                                level_eaves, narrow, unsupported, flaps, ragged,
                                                worst)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Spread, mean, p95, p99, max)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Distances, a_to_b, b_to_a, relative, mean_a_to_b, mean_b_to_a,
                                   rms_a_to_b, rms_b_to_a, taken)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(LeftOut, reason, area, share, farthest, volume,
                                                volume_share)

namespace {

using Json = nlohmann::json;

ElementKind kind_of(std::int64_t stored) {
  for (const ElementKind kind :
       {ElementKind::kBalcony, ElementKind::kLoggia, ElementKind::kDormer, ElementKind::kBay,
        ElementKind::kSpire, ElementKind::kWindow, ElementKind::kChimney})
    if (stored == static_cast<int>(kind)) return kind;
  return ElementKind::kPlain;
}

Wrap wrap_of(int stored) {
  return stored == 1 ? Wrap::kMirror : stored == 2 ? Wrap::kClamp : Wrap::kRepeat;
}

StandIn stand_in_of(std::int64_t stored) {
  for (const StandIn reason : {StandIn::kRicher, StandIn::kInvented, StandIn::kVolume})
    if (stored == static_cast<int>(reason)) return reason;
  return StandIn::kNone;
}

/// Rings as one flat array: length, indices, length, indices…
std::vector<int> flatten(const std::vector<std::vector<int>>& rings) {
  std::vector<int> flat;
  for (const auto& ring : rings) {
    flat.push_back(static_cast<int>(ring.size()));
    flat.insert(flat.end(), ring.begin(), ring.end());
  }
  return flat;
}

std::vector<std::vector<int>> unflatten(const std::vector<int>& flat, const std::string& path) {
  std::vector<std::vector<int>> rings;
  for (std::size_t i = 0; i < flat.size();) {
    const auto size = static_cast<std::size_t>(std::max(flat[i++], 0));
    if (size > flat.size() - i)
      throw Error(Stage::kInput, path, "damaged: a ring has a wrong length");
    rings.emplace_back(flat.begin() + static_cast<std::ptrdiff_t>(i),
                       flat.begin() + static_cast<std::ptrdiff_t>(i + size));
    i += size;
  }
  return rings;
}

/// Where a reader of meshes lets coordinates be, about an origin that is one as well.
void check_place(std::span<const Vec3> points, const std::string& path) {
  constexpr double kFarthest = 2e12;  // metres
  for (const Vec3& p : points)
    if (!(p.cwiseAbs().maxCoeff() <= kFarthest))
      throw Error(Stage::kInput, path, "damaged: a place is farther away than any");
}

/// What the other rooms take for granted: indices into arrays of `size`, none negative.
void check_range(std::span<const int> indices, std::size_t size, const std::string& path) {
  for (const int i : indices)
    if (i < 0 || static_cast<std::size_t>(i) >= size)
      throw Error(Stage::kInput, path, "damaged: an index points nowhere");
}

void check_range(const std::vector<Face>& faces, std::size_t size, const std::string& path) {
  for (const Face& f : faces) check_range(std::span<const int>(f), size, path);
}

void check_range(const std::vector<std::vector<int>>& rings, std::size_t size,
                 const std::string& path) {
  for (const std::vector<int>& ring : rings) check_range(ring, size, path);
}

void check_range(const PolygonMesh& mesh, const std::string& path) {
  for (const PolygonMesh::Facet& f : mesh.facets) check_range(f.rings, mesh.vertices.size(), path);
  check_range(mesh.triangles, mesh.vertices.size(), path);
  check_range(mesh.facet_of_triangle, mesh.facets.size(), path);
  if (mesh.facet_of_triangle.size() != mesh.triangles.size())
    throw Error(Stage::kInput, path, "damaged: a mesh has lost facets of its triangles");
}

void read_look(const Json& json, Appearance& look) {
  for (const Json& i : json.at("images"))
    look.images.push_back({.path = i.at("path").get<std::string>(),
                           .offset = i.at("offset").get<std::size_t>(),
                           .length = i.at("length").get<std::size_t>(),
                           .is_base64 = i.at("is_base64").get<bool>(),
                           .skip = i.at("skip").get<std::size_t>(),
                           .take = i.at("take").get<std::size_t>()});
  for (const Json& m : json.at("materials")) {
    Material material;
    material.name = m.at("name").get<std::string>();
    material.color = m.at("color").get<std::array<float, 3>>();
    material.image = m.at("image").get<int>();
    material.wrap_u = wrap_of(m.at("wrap_u").get<int>());
    material.wrap_v = wrap_of(m.at("wrap_v").get<int>());
    material.cutoff = m.value("cutoff", 0.f);
    look.materials.push_back(std::move(material));
  }
}

void check_look(const Source& source, const std::string& path) {
  const Appearance& look = source.look;
  const std::size_t points = source.is_mesh() ? 0 : source.cloud.points.size();
  const auto is_as_long = [&](const auto& list) {
    return list.empty() || list.size() == source.mesh.faces.size() + points;
  };
  const auto holds = [](int i, std::size_t size) { return i >= -1 && i < static_cast<int>(size); };
  bool is_sound = is_as_long(look.face_material) && is_as_long(look.uvs) && is_as_long(look.colors);
  for (const int m : look.face_material) is_sound = is_sound && holds(m, look.materials.size());
  for (const Material& m : look.materials)
    is_sound = is_sound && holds(m.image, look.images.size());
  if (!is_sound)
    throw Error(Stage::kInput, path, "damaged: a building's looks do not fit its faces");
}

/// A facet without its rings, as stored.
struct FacetRecord {
  Vec3 normal;
  std::int32_t plane;
  std::int32_t rings;
};

}  // namespace

std::string look_json(const Appearance& look) {
  Json images = Json::array(), materials = Json::array();
  for (const ImagePlace& i : look.images)
    images.push_back({{"path", i.path},
                      {"offset", i.offset},
                      {"length", i.length},
                      {"is_base64", i.is_base64},
                      {"skip", i.skip},
                      {"take", i.take}});
  for (const Material& m : look.materials)
    materials.push_back({{"name", m.name},
                         {"color", m.color},
                         {"image", m.image},
                         {"cutoff", m.cutoff},
                         {"wrap_u", static_cast<int>(m.wrap_u)},
                         {"wrap_v", static_cast<int>(m.wrap_v)}});
  return Json{{"images", images}, {"materials", materials}}.dump(-1, ' ', false,
                                                                 Json::error_handler_t::replace);
}

Descriptor read_descriptor(Statement& s) {
  Descriptor d;
  d.kind = kind_of(s.integer());
  d.volume = s.real();
  d.area = s.real();
  d.extent = s.real();
  d.is_flat = s.integer() != 0;
  d.eigenvalues = s.value<Vec3>();
  d.context = s.value<Vec3>();
  d.d2 = s.value<std::array<double, 64>>();
  return d;
}

LayerSight read_sight(Statement& s) {
  LayerSight sight;
  sight.is_like_finer = s.integer() != 0;
  sight.deviation = s.real();
  sight.profile = s.array<VisibleStep>();
  return sight;
}

void Store::Impl::put_building(const Building& b, int order, const std::string& key) const {
  const std::vector<Vec3> box{b.planes.box.min, b.planes.box.max};
  std::vector<std::string> own_warnings = b.warnings;
  write("INSERT INTO building VALUES(?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)")
      .bind(b.source.name)
      .bind(order)
      .bind(key)
      .bind(b.source.path)
      .bind(b.frame.origin.x())
      .bind(b.frame.origin.y())
      .bind(b.frame.origin.z())
      .bind(b.frame.yaw)
      .bind(b.planes.distance)
      .bind(b.planes.total_area)
      .bind(box)
      .bind(b.source.mesh.vertices)
      .bind(b.source.mesh.faces)
      .bind(b.source.cloud.points)
      .bind(b.source.cloud.normals)
      .bind(b.planes.plane_of_item)
      .bind(static_cast<std::int64_t>(b.segments.rays))
      .bind(b.failure)
      .bind(Json(own_warnings).dump(-1, ' ', false, Json::error_handler_t::replace))
      .bind(Json(b.left_out).dump())
      .bind(b.source.given_name)
      .bind(b.solid)
      .bind(look_json(b.source.look))
      .bind(b.source.look.face_material)
      .bind(b.source.look.uvs)
      .bind_bytes(b.source.look.colors.data(),
                  b.source.look.colors.size() * sizeof b.source.look.colors[0])
      .bind(b.source.is_found)
      .bind(b.is_dismissed)
      .run();
}

void Store::Impl::put_planes(const Building& b) const {
  Statement s = write("INSERT INTO plane VALUES(?,?,?,?,?,?,?,?,?,?,?,?,?)");
  for (std::size_t i = 0; i < b.planes.planes.size(); ++i) {
    const Plane& p = b.planes.planes[i];
    s.bind(b.source.name).bind(static_cast<int>(i));
    const int segment =
        i < b.segments.segment_of_plane.size() ? b.segments.segment_of_plane[i] : -1;
    segment < 0 ? s.bind_null() : s.bind(segment);
    s.bind(p.normal.x())
        .bind(p.normal.y())
        .bind(p.normal.z())
        .bind(p.offset)
        .bind(p.area)
        .bind(p.centroid)
        .bind(p.items)
        .bind(p.outline.vertices)
        .bind(flatten(p.outline.rings))
        .bind(p.outline.triangles)
        .run();
  }
}

void Store::Impl::put_segments(const Building& b) const {
  Statement s = write("INSERT INTO segment VALUES(?,?,NULL,?,?,?,?,?,?,?,?,?,?)");
  for (std::size_t i = 0; i < b.segments.segments.size(); ++i) {
    const Segment& g = b.segments.segments[i];
    const Descriptor& d = b.descriptors[i];
    s.bind(b.source.name)
        .bind(static_cast<int>(i))
        .bind(static_cast<int>(g.is_alcove))
        .bind(static_cast<int>(g.kind))
        .bind(g.voxels)
        .bind(g.volume)
        .bind(g.area)
        .bind(d.extent)
        .bind(static_cast<int>(d.is_flat))
        .bind(d.eigenvalues)
        .bind(d.context)
        .bind_bytes(d.d2.data(), sizeof d.d2)
        .run();
  }
  Statement c = write("INSERT INTO coverage VALUES(?,?,?,?)");
  for (std::size_t i = 0; i < b.segments.coverage.size(); ++i)
    c.bind(b.source.name)
        .bind(static_cast<int>(i))
        .bind(b.segments.coverage[i].segments)
        .bind(b.segments.coverage[i].share)
        .run();
}

void Store::Impl::put_layer(const Building& b, const Layer& layer) const {
  std::vector<FacetRecord> facets;
  std::vector<std::vector<int>> rings;
  for (const PolygonMesh::Facet& f : layer.mesh.facets) {
    facets.push_back({f.normal, f.plane, static_cast<std::int32_t>(f.rings.size())});
    rings.insert(rings.end(), f.rings.begin(), f.rings.end());
  }
  write("INSERT INTO layer VALUES(?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)")
      .bind(b.source.name)
      .bind(layer.layer)
      .bind(layer.segments)
      .bind(layer.sight.is_like_finer ? 1 : 0)
      .bind(layer.sight.deviation)
      .bind(layer.sight.profile)
      .bind(layer.failure)
      .bind(Json(layer.validity).dump())
      .bind(Json(layer.distances).dump())
      .bind(layer.mesh.vertices)
      .bind(facets)
      .bind(flatten(rings))
      .bind(layer.mesh.triangles)
      .bind(layer.mesh.facet_of_triangle)
      .bind(static_cast<int>(layer.stand_in))
      .bind(layer.invented)
      .bind(Json(layer.looks).dump())
      .run();
}

void Store::Impl::put_outcome(const Building& b) const {
  write(
      "UPDATE building SET failure = ?1, warnings = ?2, left_out = ?3, solid = ?4, is_dismissed = "
      "?5 WHERE name = ?6")
      .bind(b.failure)
      .bind(Json(b.warnings).dump(-1, ' ', false, Json::error_handler_t::replace))
      .bind(Json(b.left_out).dump())
      .bind(b.solid)
      .bind(b.is_dismissed)
      .bind(b.source.name)
      .run();
}

void Store::Impl::get_building(Building& b) const {
  Statement s = rows(Section::kSource, b.source.name);
  if (!s.step()) throw Error(Stage::kInput, path, "holds no building '" + b.source.name + "'");
  s.skip(3);  // name, position, key
  b.source.path = s.text();
  for (int i = 0; i < 3; ++i) b.frame.origin[i] = s.real();
  check_place({&b.frame.origin, 1}, path);
  b.frame.yaw = s.real();
  b.planes.distance = s.real();
  b.planes.surface = surface_at(b.planes.distance);
  b.planes.total_area = s.real();
  if (const auto box = s.array<double>(); box.size() == 6)  // infinite where there is no plane
    b.planes.box = {{box[0], box[1], box[2]}, {box[3], box[4], box[5]}};
  if (b.planes.box.is_empty()) b.planes.box = {};
  b.source.mesh.vertices = s.array<Vec3>();
  b.source.mesh.faces = s.array<Face>();
  b.source.cloud.points = s.array<Vec3>();
  b.source.cloud.normals = s.array<Vec3>();
  b.planes.plane_of_item = s.array<int>();
  b.segments.rays = static_cast<std::uint64_t>(s.integer());
  b.source.given_name = s.text();
  read_json(s.text(), path, "materials", [&](const Json& json) { read_look(json, b.source.look); });
  b.source.look.face_material = s.array<int>();
  b.source.look.uvs = s.array<std::array<Vec2f, 3>>();
  b.source.look.colors = s.array<std::array<Rgb, 3>>();
  b.source.is_found = s.integer() != 0;
  check_look(b.source, path);
  note_look(b);
  check_place(b.source.mesh.vertices, path);
  check_place(b.source.cloud.points, path);
  if (!b.planes.box.is_empty()) check_place({&b.planes.box.max, 1}, path);
  check_range(b.source.mesh.faces, b.source.mesh.vertices.size(), path);
  if (!b.source.cloud.normals.empty() &&
      b.source.cloud.normals.size() != b.source.cloud.points.size())
    throw Error(Stage::kInput, path, "damaged: a cloud has lost normals");
  get_outcome(b);
}

void Store::Impl::get_outcome(Building& b) const {
  Statement s = rows(Section::kOutcome, b.source.name);
  if (!s.step()) return;
  b.failure = s.text();
  read_json(s.text(), path, "warnings", [&](const Json& json) { json.get_to(b.warnings); });
  read_json(s.text(), path, "left out parts", [&](const Json& json) { json.get_to(b.left_out); });
  b.solid = s.real();
  b.is_dismissed = s.integer() != 0;
}

void Store::Impl::get_planes(Building& b) const {
  Statement s = rows(Section::kPlanes, b.source.name);
  const std::size_t items =
      b.source.is_mesh() ? b.source.mesh.faces.size() : b.source.cloud.points.size();
  while (s.step()) {
    s.skip(1);  // id
    const bool is_free = s.is_null();
    const auto segment = static_cast<int>(s.integer());
    b.segments.segment_of_plane.push_back(is_free ? -1 : segment);
    Plane p;
    for (int i = 0; i < 3; ++i) p.normal[i] = s.real();
    p.offset = s.real();
    p.area = s.real();
    p.centroid = s.value<Vec3>();
    p.items = s.array<int>();
    p.outline.vertices = s.array<Vec3>();
    p.outline.rings = unflatten(s.array<int>(), path);
    p.outline.triangles = s.array<Face>();
    check_range(p.items, items, path);
    check_range(p.outline.rings, p.outline.vertices.size(), path);
    check_range(p.outline.triangles, p.outline.vertices.size(), path);
    b.planes.planes.push_back(std::move(p));
  }
}

void Store::Impl::get_descriptors(Building& b) const {
  Statement s = rows(Section::kSegments, b.source.name);
  while (s.step()) {
    s.skip(1);  // id
    Segment g;
    g.is_alcove = s.integer() != 0;
    g.voxels = s.integer();
    const Descriptor d = read_descriptor(s);
    g.kind = d.kind;
    g.volume = d.volume;
    g.area = d.area;
    b.segments.segments.push_back(std::move(g));
    b.descriptors.push_back(d);
  }
  Statement layers = rows(Section::kLayering, b.source.name);
  while (layers.step()) {
    layers.skip(1);  // id
    b.layer_of_segment.push_back(static_cast<int>(layers.integer()));
  }
}

void Store::Impl::get_coverage(Building& b) const {
  Statement s = rows(Section::kCoverage, b.source.name);
  while (s.step()) {
    s.skip(1);  // id
    Coverage coverage;
    coverage.segments = s.array<int>();
    check_range(coverage.segments, b.segments.segments.size(), path);
    coverage.share = s.real();
    b.segments.coverage.push_back(std::move(coverage));
  }
}

void Store::Impl::get_segments(Building& b) const {
  get_descriptors(b);
  get_coverage(b);
  for (std::size_t p = 0; p < b.segments.segment_of_plane.size(); ++p) {
    const int segment = b.segments.segment_of_plane[p];
    if (segment >= static_cast<int>(b.segments.segments.size()))
      throw Error(Stage::kInput, path, "damaged: a plane names a segment that is not there");
    if (segment >= 0) b.segments.segments[segment].planes.push_back(static_cast<int>(p));
  }
}

void Store::Impl::get_layers(Building& b) const {
  Statement s = rows(Section::kMeshes, b.source.name);
  while (s.step()) {
    Layer layer;
    layer.layer = static_cast<int>(s.integer());
    layer.segments = static_cast<int>(s.integer());
    layer.sight = read_sight(s);
    layer.failure = s.text();
    read_json(s.text(), path, "measures", [&](const Json& json) { json.get_to(layer.validity); });
    read_json(s.text(), path, "measures", [&](const Json& json) { json.get_to(layer.distances); });
    layer.mesh.vertices = s.array<Vec3>();
    const auto facets = s.array<FacetRecord>();
    const auto rings = unflatten(s.array<int>(), path);
    std::size_t next = 0;
    for (const FacetRecord& f : facets) {
      check_place({&f.normal, 1}, path);
      const auto count = static_cast<std::size_t>(std::max(f.rings, 0));
      if (count > rings.size() - next)
        throw Error(Stage::kInput, path, "damaged: a facet has lost its rings");
      const auto begin = rings.begin() + static_cast<std::ptrdiff_t>(next);
      layer.mesh.facets.push_back(
          {f.normal, f.plane, {begin, begin + static_cast<std::ptrdiff_t>(count)}});
      next += count;
    }
    layer.mesh.triangles = s.array<Face>();
    layer.mesh.facet_of_triangle = s.array<int>();
    layer.stand_in = stand_in_of(s.integer());
    layer.invented = s.real();
    read_json(s.text(), path, "measures", [&](const Json& json) { json.get_to(layer.looks); });
    check_place(layer.mesh.vertices, path);
    check_range(layer.mesh, path);
    b.layers.push_back(std::move(layer));
  }
}

}  // namespace colod
