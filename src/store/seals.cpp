// Based on: own work; a seal is a hash of rows as a SELECT gives them (core/hash.h).
// Differs: SQLite's own sums of pages (its extension cksumvfs) would need every reader to load it.
// Notation: –

#include <algorithm>
#include <array>

#include "parts.h"

namespace colod {
namespace {

struct SectionFacts {
  const char* sql;     ///< all rows of ?1 that the seal is of
  const char* what;    ///< is damaged, and …
  const char* remedy;  ///< … how it is made anew
};

/// By Section. What reads a section reads these columns, in this order.
constexpr std::array<SectionFacts, 8> kSections = {
    {{"SELECT name, position, key, path, origin_x, origin_y, origin_z, yaw, planes_distance, "
      "total_area, box, vertices, faces, points, normals, plane_of_item, rays, given_name, look, "
      "face_material, uvs, colors, is_found FROM building WHERE name = ?1",
      "numbers", "segment"},
     {"SELECT failure, warnings, left_out, solid, is_dismissed FROM building WHERE name = ?1",
      "messages", "segment"},
     {"SELECT id, segment, normal_x, normal_y, normal_z, plane_offset, area, centroid, items, "
      "outline_vertices, outline_rings, outline_triangles FROM plane WHERE building = ?1 ORDER BY "
      "id",
      "planes", "segment"},
     {"SELECT id, is_alcove, voxels, form, volume, area, extent, is_flat, eigenvalues, context, d2 "
      "FROM segment WHERE building = ?1 ORDER BY id",
      "segments", "segment"},
     {"SELECT id, segments, share FROM coverage WHERE building = ?1 ORDER BY id", "shares",
      "segment"},
     {"SELECT id, layer FROM segment WHERE building = ?1 AND layer IS NOT NULL ORDER BY id",
      "segments' layers", "analyze"},
     {"SELECT layer, failure, is_like_finer, deviation, profile FROM layer WHERE building = ?1 "
      "ORDER BY layer",
      "meshes", "mesh"},
     {"SELECT layer, segments, is_like_finer, deviation, profile, failure, validity, distances, "
      "vertices, facets, rings, triangles, facet_of_triangle, stand_in, invented, looks FROM layer "
      "WHERE building = ?1 ORDER BY layer",
      "meshes", "mesh"}}};

const SectionFacts& facts_of(Section section) {
  return kSections[static_cast<std::size_t>(section)];
}

std::string seal_of_meta(const std::string& key, const std::string& value) {
  return hash_of(key + '\0' + value);
}

}  // namespace

std::string Store::Impl::sum_of(Section section, const std::string& name) const {
  Hash sum;
  Statement s = read(facts_of(section).sql);
  s.bind(name).sum_into(sum);
  while (s.step()) {
  }
  return sum.hex();
}

void Store::Impl::seal(Section section, const std::string& name) const {
  if (!has_seals()) return;
  write("INSERT OR REPLACE INTO seal VALUES(?1, ?2, ?3)")
      .bind(name)
      .bind(static_cast<int>(section))
      .bind(sum_of(section, name))
      .run();
}

/// No rows need no seal: nothing was written yet.
bool Store::Impl::is_sealed(Section section, const std::string& name) const {
  if (!has_seals()) return true;
  Statement s = read("SELECT hash FROM seal WHERE building = ?1 AND section = ?2");
  s.bind(name).bind(static_cast<int>(section));
  return sum_of(section, name) == (s.step() ? s.text() : Hash().hex());
}

bool Store::Impl::are_sealed(std::initializer_list<Section> sections,
                             const std::string& name) const {
  return std::all_of(sections.begin(), sections.end(),
                     [&](Section section) { return is_sealed(section, name); });
}

Statement Store::Impl::rows(Section section, const std::string& name) const {
  const SectionFacts& facts = facts_of(section);
  if (!is_sealed(section, name))
    throw Error(Stage::kInput, path,
                std::string("damaged: the ") + facts.what + " of '" + name +
                    "' are not what was written: run colod " + facts.remedy + " again");
  return {db, path, Stage::kInput, facts.sql, name};
}

void Store::Impl::forget_meshes(const std::string& name) const {
  write("DELETE FROM layer WHERE building = ?1").bind(name).run();
  write("DELETE FROM seal WHERE building = ?1 AND section >= ?2")
      .bind(name)
      .bind(static_cast<int>(Section::kSights))
      .run();
}

void Store::Impl::forget_layering() const {
  execute("DELETE FROM layer; UPDATE segment SET layer = NULL", Stage::kOutput);
  write("DELETE FROM seal WHERE section >= ?1").bind(static_cast<int>(Section::kLayering)).run();
}

void Store::Impl::put_meta(const std::string& key, const std::string& value) const {
  write("INSERT OR REPLACE INTO meta VALUES(?1, ?2, ?3)")
      .bind(key)
      .bind(value)
      .bind(seal_of_meta(key, value))
      .run();
}

std::optional<std::string> Store::Impl::meta(const std::string& key) const {
  Statement s = read("SELECT value, seal FROM meta WHERE key = ?1");
  if (!s.bind(key).step()) return std::nullopt;
  std::string value = s.text();
  if (s.text() != seal_of_meta(key, value))
    throw Error(Stage::kInput, path,
                "damaged: its '" + key + "' are not what was written: run colod segment again");
  return value;
}

bool Store::Impl::has_whole_meta() const {
  Statement s = read("SELECT key, value, seal FROM meta");
  while (s.step()) {
    const std::string key = s.text(), value = s.text();
    if (s.text() != seal_of_meta(key, value)) return false;
  }
  return true;
}

void Store::drop_damaged(const Tell& tell) {
  if (!impl_->has_whole_meta()) {
    tell(impl_->path + ": what it says of the scene is damaged: analysed and meshed anew");
    impl_->transaction([&] {
      impl_->forget_layering();
      impl_->execute("DELETE FROM meta", Stage::kOutput);
    });
  }
  for (const std::string& name : names()) {
    const bool is_whole =
        impl_->are_sealed({Section::kSource, Section::kOutcome, Section::kPlanes,
                           Section::kSegments, Section::kCoverage, Section::kLayering},
                          name);
    if (is_whole) continue;
    tell(impl_->path + ": '" + name + "' is damaged: segmented, analysed and meshed anew");
    impl_->write("DELETE FROM building WHERE name = ?1").bind(name).run();
  }
  drop_damaged_meshes(tell);
}

void Store::drop_damaged_meshes(const Tell& tell) {
  for (const std::string& name : names()) {
    if (impl_->are_sealed({Section::kSights, Section::kMeshes}, name)) continue;
    tell(impl_->path + ": the meshes of '" + name + "' are damaged: made anew");
    impl_->transaction([&] { impl_->forget_meshes(name); });
  }
}

}  // namespace colod
