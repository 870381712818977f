// Based on: SQLite's own advice for application file formats (one file, transactions, blobs for
// bulk data).
//
// Scalars that a person may ask for are columns; arrays are blobs of little-endian numbers
// (docs/scene-file.md). Files written on a big-endian machine are not readable elsewhere, which is
// checked by the user_version.

#include "store.h"

#include <sqlite3.h>

#include <set>

#include "core/hash.h"
#include "image/cache.h"
#include "options_text.h"
#include "parts.h"
#include "rules/rules.h"

namespace colod {
namespace {

using Json = nlohmann::json;

constexpr int kFormat = 11;  // PRAGMA user_version

constexpr const char* kSchema = R"sql(
CREATE TABLE meta(key TEXT PRIMARY KEY, value TEXT NOT NULL, seal TEXT NOT NULL);
CREATE TABLE building(name TEXT PRIMARY KEY, position INTEGER NOT NULL, key TEXT NOT NULL, path TEXT NOT NULL,
  origin_x REAL, origin_y REAL, origin_z REAL, yaw REAL, planes_distance REAL, total_area REAL,
  box BLOB, vertices BLOB, faces BLOB, points BLOB, normals BLOB, plane_of_item BLOB,
  rays INTEGER, failure TEXT NOT NULL, warnings TEXT NOT NULL, left_out TEXT NOT NULL,
  given_name TEXT NOT NULL, solid REAL, look TEXT NOT NULL, face_material BLOB, uvs BLOB, colors BLOB,
  is_found INTEGER NOT NULL, is_dismissed INTEGER NOT NULL);
CREATE TABLE plane(building TEXT NOT NULL REFERENCES building(name) ON DELETE CASCADE, id INTEGER NOT NULL,
  segment INTEGER, normal_x REAL, normal_y REAL, normal_z REAL, plane_offset REAL, area REAL,
  centroid BLOB, items BLOB, outline_vertices BLOB, outline_rings BLOB, outline_triangles BLOB,
  PRIMARY KEY(building, id)) WITHOUT ROWID;
CREATE TABLE segment(building TEXT NOT NULL REFERENCES building(name) ON DELETE CASCADE, id INTEGER NOT NULL,
  layer INTEGER, is_alcove INTEGER, form INTEGER, voxels INTEGER, volume REAL, area REAL, extent REAL, is_flat INTEGER,
  eigenvalues BLOB, context BLOB, d2 BLOB, PRIMARY KEY(building, id)) WITHOUT ROWID;
CREATE TABLE coverage(building TEXT NOT NULL REFERENCES building(name) ON DELETE CASCADE, id INTEGER NOT NULL,
  segments BLOB, share REAL, PRIMARY KEY(building, id)) WITHOUT ROWID;
CREATE TABLE layer(building TEXT NOT NULL REFERENCES building(name) ON DELETE CASCADE, layer INTEGER NOT NULL,
  segments INTEGER, is_like_finer INTEGER, deviation REAL, profile BLOB, failure TEXT NOT NULL, validity TEXT NOT NULL, distances TEXT NOT NULL, vertices BLOB,
  facets BLOB, rings BLOB, triangles BLOB, facet_of_triangle BLOB, stand_in INTEGER, invented REAL, looks TEXT NOT NULL, PRIMARY KEY(building, layer)) WITHOUT ROWID;
CREATE TABLE seal(building TEXT NOT NULL REFERENCES building(name) ON DELETE CASCADE, section INTEGER NOT NULL,
  hash TEXT NOT NULL, PRIMARY KEY(building, section)) WITHOUT ROWID;
)sql";

}  // namespace

bool Store::Impl::has_row(const char* sql, const std::string& name) const {
  Statement s = read(sql);
  return s.bind(name).step();
}

std::vector<std::string> Store::Impl::schema() const {
  std::vector<std::string> made;
  Statement s = read("SELECT name, sql FROM sqlite_master WHERE sql IS NOT NULL ORDER BY name");
  while (s.step()) {
    made.push_back(s.text());
    made.back() += ' ' + s.text();
  }
  return made;
}

/// A file may say anything of what its tables are, and a view or trigger runs when one is read.
bool Store::Impl::has_own_schema() const {
  Impl own;
  if (sqlite3_open(":memory:", &own.db) != SQLITE_OK)
    throw Error(Stage::kProcess, path, "no memory for its schema");
  own.execute(kSchema, Stage::kProcess);
  return schema() == own.schema();
}

bool Store::Impl::is_of_its_kind() const {
  Statement version = read("PRAGMA user_version");
  version.step();
  return version.integer() == kFormat ? has_own_schema() : schema().empty();
}

Store::Store(const std::string& path, bool is_new_allowed) : impl_(std::make_unique<Impl>()) {
  impl_->path = path;
  impl_->open(SQLITE_OPEN_READWRITE | (is_new_allowed ? SQLITE_OPEN_CREATE : 0));
  if (!is_new_allowed) impl_->keep_few_pages();
  impl_->execute("PRAGMA foreign_keys = ON; PRAGMA synchronous = NORMAL", Stage::kInput);
  Statement version = impl_->read("PRAGMA user_version");
  version.step();
  const std::int64_t found = version.integer();
  if (found == kFormat) {
    if (!impl_->has_own_schema())
      throw Error(
          Stage::kInput, path,
          "damaged: its tables are not those of a scene file of format " + std::to_string(kFormat));
    return;
  }
  if (found != 0)
    throw Error(Stage::kInput, path,
                "is a scene file of format " + std::to_string(found) +
                    ", this colod reads and writes " + std::to_string(kFormat) +
                    ": run colod segment again into a new file");
  if (impl_->has_row("SELECT 1 FROM sqlite_master WHERE name <> ?1", ""))
    throw Error(Stage::kInput, path, "is a database, but not a scene file of colod");
  impl_->transaction([&] {
    impl_->execute(kSchema, Stage::kOutput);
    impl_->execute(("PRAGMA user_version = " + std::to_string(kFormat)).c_str(), Stage::kOutput);
  });
}

Store Store::open_or_renew(const std::string& path, const Tell& tell) {
  remove_foreign<Impl>(path, "damaged, or no scene file of this colod", tell);
  Store store(path, true);
  store.drop_damaged(tell);
  return store;
}

Store::~Store() = default;
Store::Store(Store&&) noexcept = default;

void Store::put_options(const Options& options) {
  const std::string text = options_text(options);
  const std::optional<std::string> old = impl_->meta("options");
  const bool has_same_rules = impl_->has_these_rules();
  if (old == text && has_same_rules) return;
  const auto outdates_meshes = [&] {
    if (!has_same_rules) return true;
    const Options before = this->options();
    return before.layers != options.layers || !(before.rules == options.rules);
  };
  impl_->transaction([&] {
    if (old && outdates_meshes()) impl_->forget_layering();
    impl_->execute("DELETE FROM meta WHERE key = 'coanalysis'", Stage::kOutput);
    impl_->put_meta("options", text);
    impl_->put_meta("rules", rules_version());
  });
}

bool Store::Impl::has_these_rules() const { return meta("rules") == rules_version(); }

void Store::check_rules() const {
  if (!impl_->has_these_rules())
    throw Error(Stage::kInput, impl_->path,
                "was segmented by a colod with other rules, or other numbers in them: run colod "
                "segment again");
}

Options Store::options() const {
  const std::optional<std::string> text = impl_->meta("options");
  if (!text)
    throw Error(Stage::kInput, impl_->path, "holds no options: colod segment has not finished");
  return options_of(*text, impl_->path);
}

void Store::keep_only(const std::vector<std::string>& names) {
  const std::set<std::string> kept(names.begin(), names.end());
  impl_->transaction([&] {
    for (const std::string& name : this->names())
      if (!kept.contains(name))
        impl_->write("DELETE FROM building WHERE name = ?1").bind(name).run();
  });
}

std::vector<std::string> Store::names() const {
  std::vector<std::string> result;
  Statement s = impl_->read("SELECT name FROM building ORDER BY position, name");
  while (s.step()) result.push_back(s.text());
  return result;
}

void Store::put_segments(const Building& b, int order, const std::string& key) {
  impl_->transaction([&] {
    impl_->write("DELETE FROM building WHERE name = ?1").bind(b.source.name).run();
    impl_->put_building(b, order, key);
    impl_->put_planes(b);
    impl_->put_segments(b);
    for (const Section section : {Section::kSource, Section::kOutcome, Section::kPlanes,
                                  Section::kSegments, Section::kCoverage})
      impl_->seal(section, b.source.name);
  });
}

std::string Store::segments_key(const std::string& name) const {
  Statement s = impl_->read("SELECT key FROM building WHERE name = ?1");
  return s.bind(name).step() ? s.text() : std::string();
}

void Store::put_layers_of_segments(const Building& b) {
  impl_->transaction([&] {
    bool is_changed = !impl_->is_sealed(Section::kLayering, b.source.name);
    Statement old = impl_->read("SELECT id, layer FROM segment WHERE building = ?1 ORDER BY id");
    old.bind(b.source.name);
    while (old.step()) {
      const auto id = static_cast<std::size_t>(old.integer());
      is_changed = is_changed || old.is_null() || id >= b.layer_of_segment.size() ||
                   old.integer() != b.layer_of_segment[id];
    }
    if (!is_changed) return;
    impl_->forget_meshes(b.source.name);
    Statement s = impl_->write("UPDATE segment SET layer = ?1 WHERE building = ?2 AND id = ?3");
    for (std::size_t i = 0; i < b.layer_of_segment.size(); ++i)
      s.bind(b.layer_of_segment[i]).bind(b.source.name).bind(static_cast<int>(i)).run();
    impl_->seal(Section::kLayering, b.source.name);
  });
}

bool Store::has_layers_of_segments(const std::string& name) const {
  return !impl_->has_row("SELECT 1 FROM segment WHERE building = ?1 AND layer IS NULL", name);
}

void Store::put_meshes(const Building& b) {
  impl_->transaction([&] {
    impl_->forget_meshes(b.source.name);
    for (const Layer& layer : b.layers) impl_->put_layer(b, layer);
    impl_->put_outcome(b);
    for (const Section section : {Section::kOutcome, Section::kSights, Section::kMeshes})
      impl_->seal(section, b.source.name);
  });
}

bool Store::has_meshes(const std::string& name) const {
  return impl_->has_row("SELECT 1 FROM layer WHERE building = ?1", name);
}

std::vector<std::string> Store::unmeshed() const {
  std::vector<std::string> names;
  Statement s = impl_->read(
      "SELECT name FROM building b WHERE failure = '' AND NOT EXISTS (SELECT 1 FROM layer WHERE "
      "building = b.name) ORDER BY name");
  while (s.step()) names.push_back(s.text());
  return names;
}

std::string Store::meshes_key(const std::string& name) const {
  std::string text = segments_key(name) + options_text(options()) + rules_version();
  Statement s = impl_->read("SELECT layer FROM segment WHERE building = ?1 ORDER BY id");
  s.bind(name);
  while (s.step()) text += ' ' + std::to_string(s.integer());
  Hash hash;
  hash.add(text.data(), text.size());
  return hash.hex();
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

Building Store::described(const std::string& name) const {
  Building b;
  b.source.name = name;
  impl_->get_descriptors(b);
  impl_->get_coverage(b);
  b.segments.segments = {};
  return b;
}

std::vector<BuildingSights> Store::sights() const {
  std::vector<BuildingSights> result;
  Statement meshed = impl_->read("SELECT DISTINCT building FROM layer ORDER BY building");
  while (meshed.step()) {
    BuildingSights own;
    Statement s = impl_->rows(Section::kSights, meshed.text());
    while (s.step()) {
      const auto layer = static_cast<int>(s.integer());
      if (!s.text().empty()) continue;  // failed
      own.layers.push_back(layer);
      own.sights.push_back(read_sight(s));
    }
    if (!own.layers.empty()) result.push_back(std::move(own));
  }
  return result;
}

Prior Store::prior() const {
  Prior prior;
  prior.layers = options().layers;
  for (const std::string& name : names()) {
    Building b;
    b.source.name = name;
    impl_->get_descriptors(b);
    if (b.layer_of_segment.size() != b.descriptors.size())
      throw Error(Stage::kInput, impl_->path, "is not analysed yet: run colod analyze first");
    for (const int layer : b.layer_of_segment)
      if (layer < 0 || layer >= prior.layers)
        throw Error(Stage::kInput, impl_->path, "damaged: a segment lies on no layer");
    if (!b.descriptors.empty())
      prior.buildings.push_back({std::move(b.descriptors), std::move(b.layer_of_segment)});
  }
  if (prior.buildings.empty())
    throw Error(Stage::kInput, impl_->path, "holds no segment to learn from");
  return prior;
}

void Store::put_coanalysis(const Scene& scene) {
  std::vector<std::string> warnings = scene.selection.warnings;
  warnings.insert(warnings.end(), scene.clustering.warnings.begin(),
                  scene.clustering.warnings.end());
  Json kinds = Json::array(), overruled = Json::array();
  for (const KindFacts& k : scene.clustering.kinds)
    kinds.push_back({k.layer, k.segments, k.extent});
  for (const OverruledSegment& o : scene.overruled)
    overruled.push_back({o.building, o.segment, name_of(o.kind)});
  const Json json{{"objective", scene.selection.objective},
                  {"bound", scene.selection.bound},
                  {"gap", scene.selection.gap},
                  {"status", static_cast<int>(scene.selection.status)},
                  {"lp_solve", scene.selection.is_lp_solve},
                  {"kinds", kinds},
                  {"overruled", overruled},
                  {"seconds", scene.coanalysis_seconds},
                  {"prior", scene.has_prior},
                  {"warnings", warnings}};
  impl_->transaction([&] {
    impl_->put_meta("coanalysis", json.dump());
    impl_->execute("DELETE FROM meta WHERE key = 'placed_later'", Stage::kOutput);
  });
}

bool Store::is_analysed() const {
  return impl_->has_row("SELECT 1 FROM meta WHERE key = ?1", "coanalysis");
}

void Store::put_placed_later(const std::set<std::string>& names) {
  impl_->put_meta("placed_later", Json(names).dump(-1, ' ', false, Json::error_handler_t::replace));
}

void Store::get_placed_later(Scene& scene) const {
  const std::optional<std::string> text = impl_->meta("placed_later");
  if (!text) return;
  read_json(*text, impl_->path, "buildings placed later",
            [&](const Json& json) { scene.placed_later.merge(json.get<std::set<std::string>>()); });
}

void Store::put_place(const std::string& record) { impl_->put_meta("place", record); }

std::string Store::place() const { return impl_->meta("place").value_or(""); }

void Store::put_attributes(const std::map<std::string, Attributes>& attributes) {
  Json json = Json::object();
  for (const auto& [building, own] : attributes)
    for (const auto& [name, value] : own) json[building].push_back({name, value});
  impl_->put_meta("attributes", json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

void Store::get_attributes(std::map<std::string, Attributes>& attributes) const {
  const std::optional<std::string> text = impl_->meta("attributes");
  if (!text) return;  // of no scene
  read_json(*text, impl_->path, "attributes", [&](const Json& json) {
    for (const auto& [building, own] : json.items())
      for (const Json& pair : own)
        attributes[building].emplace_back(pair.at(0).get<std::string>(),
                                          pair.at(1).get<std::string>());
  });
}

void Store::get_coanalysis(Scene& scene) const {
  const std::optional<std::string> text = impl_->meta("coanalysis");
  if (!text)
    throw Error(Stage::kInput, impl_->path, "is not analysed yet: run colod analyze first");
  read_json(*text, impl_->path, "figures of the analysis", [&](const Json& json) {
    scene.selection.objective = json.value("objective", 0.0);
    scene.selection.bound = json.value("bound", 0.0);
    scene.selection.gap = json.value("gap", 0.0);
    scene.selection.status = static_cast<SelectionStatus>(json.value("status", 0));
    scene.selection.is_lp_solve = json.value("lp_solve", false);
    for (const Json& k : json.value("kinds", Json::array()))
      scene.clustering.kinds.push_back({k.at(0), k.at(1), k.at(2)});
    for (const Json& o : json.value("overruled", Json::array()))
      scene.overruled.push_back({o.at(0), o.at(1), kind_named(o.at(2).get<std::string>())});
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
  b.source.look = std::move(kept.source.look);
  b.planes = std::move(kept.planes);
}

void TemporaryStore::drop(Building& b) { drop_geometry(b); }

namespace {

constexpr std::size_t kMostOfImage = std::size_t{1} << 30;  // bytes

/// What a file that is not there, or ends too early, adds differs from what it adds later.
void add_image(const ImagePlace& place, Hash& hash) {
  std::string bytes;
  try {
    bytes = read_image(place, kMostOfImage);
  } catch (const std::exception& e) {
    bytes = e.what();
  }
  hash.add(bytes.data(), bytes.size());
}

}  // namespace

std::string segments_key(const Source& source, const Options& options) {
  Hash hash;
  hash.add(source.mesh.vertices);
  hash.add(source.mesh.faces);
  hash.add(source.cloud.points);
  hash.add(source.cloud.normals);
  hash.add(std::vector<int>{source.is_found});
  hash.add(source.look.face_material);
  hash.add(source.look.uvs);
  hash.add(source.look.colors);
  const std::string look = look_json(source.look);
  hash.add(look.data(), look.size());
  for (const ImagePlace& place : source.look.images) add_image(place, hash);
  Options relevant = options;  // what only later rooms read does not outdate segments
  const Options defaults;
  relevant.layers = defaults.layers;
  relevant.beta = defaults.beta;
  relevant.lambda = defaults.lambda;
  relevant.eta = defaults.eta;
  relevant.gap = defaults.gap;
  relevant.is_size_layering = defaults.is_size_layering;
  for (const RuleInfo& info : rule_table())
    if (info.rule > kLastOfSegments) relevant.rules = relevant.rules.with(info.rule);
  const std::string text = rules_version() + options_text(relevant);
  hash.add(text.data(), text.size());
  return hash.hex();
}

}  // namespace colod
