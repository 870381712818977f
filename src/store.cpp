// Based on: SQLite's own advice for application file formats (one file, transactions, blobs for
// bulk data).
//
// Scalars that a person may ask for are columns; arrays are blobs of little-endian numbers
// (docs/scene-file.md). Files written on a big-endian machine are not readable elsewhere, which is
// checked by the user_version.

#include "store.h"

#include <sqlite3.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <span>
#include <type_traits>

#include "error.h"

namespace colod {
namespace {

using Json = nlohmann::json;

constexpr int kFormat = 3;  // PRAGMA user_version

constexpr const char* kSchema = R"sql(
CREATE TABLE meta(key TEXT PRIMARY KEY, value TEXT NOT NULL);
CREATE TABLE building(name TEXT PRIMARY KEY, position INTEGER NOT NULL, key TEXT NOT NULL, path TEXT NOT NULL,
  origin_x REAL, origin_y REAL, origin_z REAL, yaw REAL, planes_distance REAL, total_area REAL,
  box BLOB, vertices BLOB, faces BLOB, points BLOB, normals BLOB, plane_of_item BLOB,
  rays INTEGER, failure TEXT NOT NULL, warnings TEXT NOT NULL);
CREATE TABLE plane(building TEXT NOT NULL REFERENCES building(name) ON DELETE CASCADE, id INTEGER NOT NULL,
  segment INTEGER, normal_x REAL, normal_y REAL, normal_z REAL, plane_offset REAL, area REAL,
  centroid BLOB, items BLOB, outline_vertices BLOB, outline_rings BLOB, outline_triangles BLOB,
  PRIMARY KEY(building, id)) WITHOUT ROWID;
CREATE TABLE segment(building TEXT NOT NULL REFERENCES building(name) ON DELETE CASCADE, id INTEGER NOT NULL,
  layer INTEGER, is_alcove INTEGER, form INTEGER, voxels INTEGER, volume REAL, area REAL, extent REAL, is_flat INTEGER,
  eigenvalues BLOB, d2 BLOB, PRIMARY KEY(building, id)) WITHOUT ROWID;
CREATE TABLE coverage(building TEXT NOT NULL REFERENCES building(name) ON DELETE CASCADE, id INTEGER NOT NULL,
  segments BLOB, share REAL, PRIMARY KEY(building, id)) WITHOUT ROWID;
CREATE TABLE layer(building TEXT NOT NULL REFERENCES building(name) ON DELETE CASCADE, layer INTEGER NOT NULL,
  segments INTEGER, geometric_error REAL, failure TEXT NOT NULL, validity BLOB, distances BLOB, vertices BLOB,
  facets BLOB, rings BLOB, triangles BLOB, facet_of_triangle BLOB, PRIMARY KEY(building, layer)) WITHOUT ROWID;
)sql";

Form form_of(std::int64_t stored) {
  for (const Form form : {Form::kTray, Form::kNiche, Form::kDormer, Form::kBay})
    if (stored == static_cast<int>(form)) return form;
  return Form::kPlain;
}

/// One prepared statement: bind in order, step, read columns in order.
class Statement {
 public:
  Statement(sqlite3* db, const std::string& path, Stage stage, const char* sql)
      : db_(db), path_(path), stage_(stage) {
    check(sqlite3_prepare_v2(db, sql, -1, &statement_, nullptr));
  }
  ~Statement() { sqlite3_finalize(statement_); }
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  Statement& bind(const std::string& v) {
    check(sqlite3_bind_text64(statement_, ++bound_, v.data(), v.size(), SQLITE_TRANSIENT,
                              SQLITE_UTF8));
    return *this;
  }
  Statement& bind(double v) { return check(sqlite3_bind_double(statement_, ++bound_, v)), *this; }
  Statement& bind(std::int64_t v) {
    return check(sqlite3_bind_int64(statement_, ++bound_, v)), *this;
  }
  Statement& bind(int v) { return bind(static_cast<std::int64_t>(v)); }
  Statement& bind_bytes(const void* data, std::size_t size) {
    check(sqlite3_bind_blob64(statement_, ++bound_, size ? data : "", size, SQLITE_TRANSIENT));
    return *this;
  }
  template <typename T>
  Statement& bind(const std::vector<T>& v) {
    static_assert(sizeof(T) % 4 == 0);
    return bind_bytes(v.data(), v.size() * sizeof(T));
  }
  Statement& bind(const Vec3& v) { return bind_bytes(v.data(), sizeof(Vec3)); }
  Statement& bind_null() { return check(sqlite3_bind_null(statement_, ++bound_)), *this; }

  /// True when there is a row to read.
  bool step() {
    const int code = sqlite3_step(statement_);
    read_ = 0;
    if (code != SQLITE_ROW && code != SQLITE_DONE) check(code);
    return code == SQLITE_ROW;
  }
  void run() {
    step();
    sqlite3_reset(statement_);
    bound_ = 0;
  }

  bool is_null() const { return sqlite3_column_type(statement_, read_) == SQLITE_NULL; }
  std::string text() {
    const auto* data = reinterpret_cast<const char*>(sqlite3_column_text(statement_, read_));
    const int size = sqlite3_column_bytes(statement_, read_++);
    return data ? std::string(data, static_cast<std::size_t>(size)) : std::string();
  }
  double real() { return sqlite3_column_double(statement_, read_++); }
  std::int64_t integer() { return sqlite3_column_int64(statement_, read_++); }
  template <typename T>
  std::vector<T> array() {
    const void* data = sqlite3_column_blob(statement_, read_);
    const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_, read_++));
    if (size % sizeof(T) != 0)
      throw Error(Stage::kInput, path_, "damaged: an array has a wrong length");
    std::vector<T> v(size / sizeof(T));
    if (size > 0) std::memcpy(static_cast<void*>(v.data()), data, size);
    return v;
  }
  template <typename T>
  T value() {
    const std::vector<T> v = array<T>();
    if (v.size() != 1) throw Error(Stage::kInput, path_, "damaged: a record has a wrong length");
    return v.front();
  }

 private:
  void check(int code) const {
    if (code != SQLITE_OK)
      throw Error(stage_, path_, std::string("scene file: ") + sqlite3_errmsg(db_));
  }
  sqlite3* db_;
  const std::string& path_;
  Stage stage_;
  sqlite3_stmt* statement_ = nullptr;
  int bound_ = 0, read_ = 0;
};

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

/// Reads JSON that `parse` takes apart; what it does not hold, or holds in another type, is damage.
template <typename Parse>
void read_json(const std::string& text, const std::string& path, const char* what,
               const Parse& parse) {
  try {
    parse(Json::parse(text));
  } catch (const Json::exception&) {
    throw Error(Stage::kInput, path, std::string("damaged: its ") + what + " are unreadable");
  }
}

/// A facet without its rings, as stored.
struct FacetRecord {
  Vec3 normal;
  std::int32_t plane;
  std::int32_t rings;
};

Json options_json(const Options& o) {
  Json json{{"rules", o.rules == Rules::kPaper ? "paper" : "robust"},
            {"visibility", name_of(o.visibility)},
            {"layering", o.is_size_layering ? "size" : "spectral"}};
  for (const OptionInfo& info : option_table()) json[info.name] = info.get(o);
  return json;
}

/// FNV-1a, 64 bits, of any bytes; two lanes make accidental equality as unlikely as needed for "did
/// the input change".
class Hash {
 public:
  void add(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < size; ++i) {
      a_ = (a_ ^ bytes[i]) * 1099511628211ULL;
      b_ = (b_ ^ bytes[i]) * 6364136223846793005ULL + 1442695040888963407ULL;
    }
  }
  template <typename T>
  void add(const std::vector<T>& v) {
    const std::size_t size = v.size();
    add(&size, sizeof size);
    add(v.data(), v.size() * sizeof(T));
  }
  std::string hex() const {
    char text[33];
    std::snprintf(text, sizeof text, "%016llx%016llx", static_cast<unsigned long long>(a_),
                  static_cast<unsigned long long>(b_));
    return text;
  }

 private:
  std::uint64_t a_ = 14695981039346656037ULL, b_ = 88172645463325252ULL;
};

}  // namespace

struct Store::Impl {
  std::string path;
  sqlite3* db = nullptr;

  ~Impl() { sqlite3_close(db); }

  Statement read(const char* sql) const { return {db, path, Stage::kInput, sql}; }
  Statement write(const char* sql) const { return {db, path, Stage::kOutput, sql}; }
  void execute(const char* sql, Stage stage) const {
    if (sqlite3_exec(db, sql, nullptr, nullptr, nullptr) != SQLITE_OK)
      throw Error(stage, path, std::string("scene file: ") + sqlite3_errmsg(db));
  }
  /// All of `body` or nothing.
  template <typename Body>
  void transaction(const Body& body) const {
    execute("BEGIN IMMEDIATE", Stage::kOutput);
    try {
      body();
      execute("COMMIT", Stage::kOutput);
    } catch (...) {
      sqlite3_exec(db, "ROLLBACK", nullptr, nullptr, nullptr);
      throw;
    }
  }

  bool has_row(const char* sql, const std::string& name) const {
    Statement s = read(sql);
    return s.bind(name).step();
  }

  void put_building(const Building& b, int order, const std::string& key) const;
  void put_planes(const Building& b) const;
  void put_segments(const Building& b) const;
  void put_layer(const Building& b, const Layer& layer) const;
  void get_building(Building& b) const;
  void get_planes(Building& b) const;
  void get_segments(Building& b) const;
  void get_layers(Building& b) const;
};

Store::Store(const std::string& path, bool is_new_allowed) : impl_(std::make_unique<Impl>()) {
  impl_->path = path;
  const int flags = SQLITE_OPEN_READWRITE | (is_new_allowed ? SQLITE_OPEN_CREATE : 0);
  if (sqlite3_open_v2(path.c_str(), &impl_->db, flags, nullptr) != SQLITE_OK)
    throw Error(is_new_allowed ? Stage::kOutput : Stage::kInput, path,
                std::string("cannot open the scene file: ") + sqlite3_errmsg(impl_->db));
  impl_->execute("PRAGMA foreign_keys = ON; PRAGMA synchronous = NORMAL", Stage::kInput);
  Statement version = impl_->read("PRAGMA user_version");
  version.step();
  const std::int64_t found = version.integer();
  if (found == kFormat) return;
  if (found != 0 || impl_->has_row("SELECT 1 FROM sqlite_master WHERE name <> ?1", ""))
    throw Error(Stage::kInput, path, "not a scene file of this version of colod");
  impl_->transaction([&] {
    impl_->execute(kSchema, Stage::kOutput);
    impl_->execute(("PRAGMA user_version = " + std::to_string(kFormat)).c_str(), Stage::kOutput);
  });
}

Store::~Store() = default;
Store::Store(Store&&) noexcept = default;

void Store::put_options(const Options& options) {
  const std::string text = options_json(options).dump();
  Statement old = impl_->read("SELECT value FROM meta WHERE key = 'options'");
  const bool is_there = old.step();
  if (is_there && old.text() == text) return;
  impl_->transaction([&] {
    if (is_there && this->options().layers != options.layers)
      impl_->execute("DELETE FROM layer; UPDATE segment SET layer = NULL", Stage::kOutput);
    impl_->execute("DELETE FROM meta WHERE key = 'coanalysis'", Stage::kOutput);
    impl_->write("INSERT OR REPLACE INTO meta VALUES('options', ?1)").bind(text).run();
  });
}

Options Store::options() const {
  Statement s = impl_->read("SELECT value FROM meta WHERE key = 'options'");
  if (!s.step())
    throw Error(Stage::kInput, impl_->path, "holds no options: colod segment has not finished");
  Options options;
  read_json(s.text(), impl_->path, "options", [&](const Json& json) {
    options.rules = json.value("rules", "robust") == "paper" ? Rules::kPaper : Rules::kRobust;
    options.visibility = visibility_of(json.value("visibility", "embree"));
    options.is_size_layering = json.value("layering", "spectral") == "size";
    for (const OptionInfo& info : option_table()) {
      const double value = json.value(info.name, info.get(options));
      if (!(value >= info.min && value <= info.max))
        throw Error(Stage::kInput, impl_->path, "damaged: its option " + info.name + " is wild");
      info.set(options, value);
    }
  });
  return options;
}

std::vector<std::string> Store::names() const {
  std::vector<std::string> result;
  Statement s = impl_->read("SELECT name FROM building ORDER BY position, name");
  while (s.step()) result.push_back(s.text());
  return result;
}

void Store::Impl::put_building(const Building& b, int order, const std::string& key) const {
  const std::vector<Vec3> box{b.planes.box.min, b.planes.box.max};
  std::vector<std::string> own_warnings = b.warnings;
  write("INSERT INTO building VALUES(?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)")
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
  Statement s = write("INSERT INTO segment VALUES(?,?,NULL,?,?,?,?,?,?,?,?,?)");
  for (std::size_t i = 0; i < b.segments.segments.size(); ++i) {
    const Segment& g = b.segments.segments[i];
    const Descriptor& d = b.descriptors[i];
    s.bind(b.source.name)
        .bind(static_cast<int>(i))
        .bind(static_cast<int>(g.is_alcove))
        .bind(static_cast<int>(g.form))
        .bind(g.voxels)
        .bind(g.volume)
        .bind(g.area)
        .bind(d.extent)
        .bind(static_cast<int>(d.is_flat))
        .bind(d.eigenvalues)
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

void Store::put_segments(const Building& b, int order, const std::string& key) {
  impl_->transaction([&] {
    impl_->write("DELETE FROM building WHERE name = ?1").bind(b.source.name).run();
    impl_->put_building(b, order, key);
    impl_->put_planes(b);
    impl_->put_segments(b);
  });
}

std::string Store::segments_key(const std::string& name) const {
  Statement s = impl_->read("SELECT key FROM building WHERE name = ?1");
  return s.bind(name).step() ? s.text() : std::string();
}

void Store::put_layers_of_segments(const Building& b) {
  impl_->transaction([&] {
    bool is_changed = false;
    Statement old = impl_->read("SELECT id, layer FROM segment WHERE building = ?1 ORDER BY id");
    old.bind(b.source.name);
    while (old.step()) {
      const auto id = static_cast<std::size_t>(old.integer());
      is_changed = is_changed || old.is_null() || id >= b.layer_of_segment.size() ||
                   old.integer() != b.layer_of_segment[id];
    }
    if (!is_changed) return;
    impl_->write("DELETE FROM layer WHERE building = ?1").bind(b.source.name).run();
    Statement s = impl_->write("UPDATE segment SET layer = ?1 WHERE building = ?2 AND id = ?3");
    for (std::size_t i = 0; i < b.layer_of_segment.size(); ++i)
      s.bind(b.layer_of_segment[i]).bind(b.source.name).bind(static_cast<int>(i)).run();
  });
}

bool Store::has_layers_of_segments(const std::string& name) const {
  return !impl_->has_row("SELECT 1 FROM segment WHERE building = ?1 AND layer IS NULL", name);
}

void Store::Impl::put_layer(const Building& b, const Layer& layer) const {
  std::vector<FacetRecord> facets;
  std::vector<std::vector<int>> rings;
  for (const PolygonMesh::Facet& f : layer.mesh.facets) {
    facets.push_back({f.normal, f.plane, static_cast<std::int32_t>(f.rings.size())});
    rings.insert(rings.end(), f.rings.begin(), f.rings.end());
  }
  write("INSERT INTO layer VALUES(?,?,?,?,?,?,?,?,?,?,?,?)")
      .bind(b.source.name)
      .bind(layer.layer)
      .bind(layer.segments)
      .bind(layer.geometric_error)
      .bind(layer.failure)
      .bind_bytes(&layer.validity, sizeof layer.validity)
      .bind_bytes(&layer.distances, sizeof layer.distances)
      .bind(layer.mesh.vertices)
      .bind(facets)
      .bind(flatten(rings))
      .bind(layer.mesh.triangles)
      .bind(layer.mesh.facet_of_triangle)
      .run();
}

void Store::put_meshes(const Building& b) {
  impl_->transaction([&] {
    impl_->write("DELETE FROM layer WHERE building = ?1").bind(b.source.name).run();
    for (const Layer& layer : b.layers) impl_->put_layer(b, layer);
    impl_->write("UPDATE building SET failure = ?1, warnings = ?2 WHERE name = ?3")
        .bind(b.failure)
        .bind(Json(b.warnings).dump(-1, ' ', false, Json::error_handler_t::replace))
        .bind(b.source.name)
        .run();
  });
}

bool Store::has_meshes(const std::string& name) const {
  return impl_->has_row("SELECT 1 FROM layer WHERE building = ?1", name);
}

void Store::Impl::get_building(Building& b) const {
  Statement s = read(
      "SELECT path, origin_x, origin_y, origin_z, yaw, planes_distance, total_area, box, vertices, "
      "faces,"
      " points, normals, plane_of_item, rays, failure, warnings FROM building WHERE name = ?1");
  if (!s.bind(b.source.name).step())
    throw Error(Stage::kInput, path, "holds no building '" + b.source.name + "'");
  b.source.path = s.text();
  for (int i = 0; i < 3; ++i) b.frame.origin[i] = s.real();
  b.frame.yaw = s.real();
  b.planes.distance = s.real();
  b.planes.total_area = s.real();
  const auto box = s.array<Vec3>();
  if (box.size() == 2) b.planes.box = {box[0], box[1]};
  b.source.mesh.vertices = s.array<Vec3>();
  b.source.mesh.faces = s.array<Face>();
  b.source.cloud.points = s.array<Vec3>();
  b.source.cloud.normals = s.array<Vec3>();
  b.planes.plane_of_item = s.array<int>();
  b.segments.rays = static_cast<std::uint64_t>(s.integer());
  b.failure = s.text();
  read_json(s.text(), path, "warnings", [&](const Json& json) { json.get_to(b.warnings); });
  check_range(b.source.mesh.faces, b.source.mesh.vertices.size(), path);
  if (!b.source.cloud.normals.empty() &&
      b.source.cloud.normals.size() != b.source.cloud.points.size())
    throw Error(Stage::kInput, path, "damaged: a cloud has lost normals");
}

void Store::Impl::get_planes(Building& b) const {
  Statement s = read(
      "SELECT segment, normal_x, normal_y, normal_z, plane_offset, area, centroid, items, "
      "outline_vertices,"
      " outline_rings, outline_triangles FROM plane WHERE building = ?1 ORDER BY id");
  s.bind(b.source.name);
  const std::size_t items =
      b.source.is_mesh() ? b.source.mesh.faces.size() : b.source.cloud.points.size();
  while (s.step()) {
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

void Store::Impl::get_segments(Building& b) const {
  Statement s = read(
      "SELECT is_alcove, form, voxels, volume, area, extent, is_flat, eigenvalues, d2, layer FROM "
      "segment"
      " WHERE building = ?1 ORDER BY id");
  s.bind(b.source.name);
  while (s.step()) {
    Segment g;
    Descriptor d;
    g.is_alcove = s.integer() != 0;
    g.form = d.form = form_of(s.integer());
    g.voxels = s.integer();
    g.volume = d.volume = s.real();
    g.area = d.area = s.real();
    d.extent = s.real();
    d.is_flat = s.integer() != 0;
    d.eigenvalues = s.value<Vec3>();
    d.d2 = s.value<std::array<double, 64>>();
    if (!s.is_null()) b.layer_of_segment.push_back(static_cast<int>(s.integer()));
    b.segments.segments.push_back(std::move(g));
    b.descriptors.push_back(d);
  }
  for (std::size_t p = 0; p < b.segments.segment_of_plane.size(); ++p) {
    const int segment = b.segments.segment_of_plane[p];
    if (segment >= static_cast<int>(b.segments.segments.size()))
      throw Error(Stage::kInput, path, "damaged: a plane names a segment that is not there");
    if (segment >= 0) b.segments.segments[segment].planes.push_back(static_cast<int>(p));
  }
  Statement c = read("SELECT segments, share FROM coverage WHERE building = ?1 ORDER BY id");
  c.bind(b.source.name);
  while (c.step()) {
    Coverage coverage;
    coverage.segments = c.array<int>();
    check_range(coverage.segments, b.segments.segments.size(), path);
    coverage.share = c.real();
    b.segments.coverage.push_back(std::move(coverage));
  }
}

void Store::Impl::get_layers(Building& b) const {
  Statement s = read(
      "SELECT layer, segments, geometric_error, failure, validity, distances, vertices, facets, "
      "rings,"
      " triangles, facet_of_triangle FROM layer WHERE building = ?1 ORDER BY layer");
  s.bind(b.source.name);
  while (s.step()) {
    Layer layer;
    layer.layer = static_cast<int>(s.integer());
    layer.segments = static_cast<int>(s.integer());
    layer.geometric_error = s.real();
    layer.failure = s.text();
    layer.validity = s.value<Validity>();
    layer.distances = s.value<Distances>();
    layer.mesh.vertices = s.array<Vec3>();
    const auto facets = s.array<FacetRecord>();
    const auto rings = unflatten(s.array<int>(), path);
    std::size_t next = 0;
    for (const FacetRecord& f : facets) {
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
    check_range(layer.mesh, path);
    b.layers.push_back(std::move(layer));
  }
}

Building Store::building(const std::string& name) const {
  Building b;
  b.source.name = name;
  impl_->get_building(b);
  impl_->get_planes(b);
  impl_->get_segments(b);
  impl_->get_layers(b);
  b.counts = count(b);
  return b;
}

Prior Store::prior() const {
  Prior prior;
  prior.layers = options().layers;
  Statement s = impl_->read(
      "SELECT b.name, s.layer, s.form, s.volume, s.area, s.extent, s.is_flat, s.eigenvalues, s.d2"
      " FROM segment s JOIN building b ON b.name = s.building ORDER BY b.position, b.name, s.id");
  std::string last;
  while (s.step()) {
    const std::string name = s.text();
    if (prior.buildings.empty() || name != last) prior.buildings.emplace_back();
    last = name;
    if (s.is_null())
      throw Error(Stage::kInput, impl_->path, "is not analysed yet: run colod analyze first");
    Descriptor d;
    const auto layer = static_cast<int>(s.integer());
    d.form = form_of(s.integer());
    d.volume = s.real();
    d.area = s.real();
    d.extent = s.real();
    d.is_flat = s.integer() != 0;
    d.eigenvalues = s.value<Vec3>();
    d.d2 = s.value<std::array<double, 64>>();
    if (layer < 0 || layer >= prior.layers)
      throw Error(Stage::kInput, impl_->path, "damaged: a segment lies on no layer");
    prior.buildings.back().segments.push_back(d);
    prior.buildings.back().layer.push_back(layer);
  }
  if (prior.buildings.empty())
    throw Error(Stage::kInput, impl_->path, "holds no segment to learn from");
  return prior;
}

void Store::put_coanalysis(const Scene& scene) {
  std::vector<std::string> warnings = scene.selection.warnings;
  warnings.insert(warnings.end(), scene.clustering.warnings.begin(),
                  scene.clustering.warnings.end());
  const Json json{{"objective", scene.selection.objective},
                  {"bound", scene.selection.bound},
                  {"gap", scene.selection.gap},
                  {"status", static_cast<int>(scene.selection.status)},
                  {"seconds", scene.coanalysis_seconds},
                  {"prior", scene.has_prior},
                  {"warnings", warnings}};
  impl_->write("INSERT OR REPLACE INTO meta VALUES('coanalysis', ?1)").bind(json.dump()).run();
}

void Store::get_coanalysis(Scene& scene) const {
  Statement s = impl_->read("SELECT value FROM meta WHERE key = 'coanalysis'");
  if (!s.step())
    throw Error(Stage::kInput, impl_->path, "is not analysed yet: run colod analyze first");
  read_json(s.text(), impl_->path, "figures of the analysis", [&](const Json& json) {
    scene.selection.objective = json.value("objective", 0.0);
    scene.selection.bound = json.value("bound", 0.0);
    scene.selection.gap = json.value("gap", 0.0);
    scene.selection.status = static_cast<SelectionStatus>(json.value("status", 0));
    scene.coanalysis_seconds = json.value("seconds", 0.0);
    scene.has_prior = json.value("prior", false);
    scene.selection.warnings = json.value("warnings", std::vector<std::string>{});
  });
}

// An empty name is SQLite's for a database on disk that nobody else sees.
TemporaryStore::TemporaryStore() : store_("", true) {}

void TemporaryStore::put(Building& b) {
  {
    const std::lock_guard lock(mutex_);
    store_.put_segments(b, 0, "");
  }
  drop(b);
}

void TemporaryStore::get(Building& b) {
  const std::lock_guard lock(mutex_);
  Building kept = store_.building(b.source.name);
  b.source.mesh = std::move(kept.source.mesh);
  b.source.cloud = std::move(kept.source.cloud);
  b.planes = std::move(kept.planes);
}

void TemporaryStore::drop(Building& b) { drop_geometry(b); }

std::string segments_key(const Source& source, const Options& options) {
  Hash hash;
  hash.add(source.mesh.vertices);
  hash.add(source.mesh.faces);
  hash.add(source.cloud.points);
  hash.add(source.cloud.normals);
  Options relevant = options;  // what only later rooms read does not outdate segments
  const Options defaults;
  relevant.layers = defaults.layers;
  relevant.beta = defaults.beta;
  relevant.lambda = defaults.lambda;
  relevant.eta = defaults.eta;
  relevant.gap = defaults.gap;
  relevant.is_size_layering = defaults.is_size_layering;
  const std::string text = options_json(relevant).dump();
  hash.add(text.data(), text.size());
  return hash.hex();
}

}  // namespace colod
