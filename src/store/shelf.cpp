// Based on: SQLite as an application file format, as the scene file is.
// Differs: –
// Notation: –

#include "shelf.h"

#include <sqlite3.h>

#include <set>

#include "core/hash.h"
#include "parts.h"

namespace colod {
namespace {

constexpr int kShelfFormat = 0x434c4402;  // PRAGMA user_version, far from those of scene files

constexpr const char* kShelfSchema =
    "CREATE TABLE piece(name TEXT NOT NULL, part TEXT NOT NULL, parts INTEGER NOT NULL, "
    "hash TEXT NOT NULL, bytes BLOB NOT NULL, PRIMARY KEY(name, part))";

enum class Content { kNothing, kShelf, kOther };

/// Of a piece, and of how many there are under its name.
std::string seal_of(const std::string& name, const std::string& part, std::int64_t parts,
                    const std::string& bytes) {
  return hash_of(name + '\0' + part + '\0' + std::to_string(parts) + '\0' + bytes);
}

}  // namespace

struct Shelf::Impl : Database {
  /// A view or a trigger, which a file may have, would run when it is read.
  bool has_own_schema() const {
    Statement s = read("SELECT sql FROM sqlite_master WHERE sql IS NOT NULL");
    return s.step() && s.text() == kShelfSchema && !s.step();
  }
  /// What is no database at all is something else.
  Content content() const try {
    execute("PRAGMA synchronous = NORMAL", Stage::kInput);
    Statement version = read("PRAGMA user_version");
    version.step();
    const std::int64_t found = version.integer();
    if (found == kShelfFormat && has_own_schema()) return Content::kShelf;
    Statement tables = read("SELECT 1 FROM sqlite_master");
    return found == 0 && !tables.step() ? Content::kNothing : Content::kOther;
  } catch (const Error&) {
    if (is_damaged()) return Content::kOther;
    throw;
  }
  bool is_of_its_kind() const { return content() != Content::kOther; }
};

Shelf::Shelf(const std::string& path, bool is_new_allowed) : impl_(std::make_unique<Impl>()) {
  impl_->path = path;
  impl_->open(SQLITE_OPEN_READWRITE | (is_new_allowed ? SQLITE_OPEN_CREATE : 0));
  impl_->keep_few_pages();
  switch (impl_->content()) {
    case Content::kShelf:
      return;
    case Content::kOther:
      throw Error(Stage::kInput, path, "is damaged, or not what this colod writes");
    case Content::kNothing:
      break;
  }
  impl_->transaction([&] {
    impl_->execute(kShelfSchema, Stage::kOutput);
    impl_->execute(("PRAGMA user_version = " + std::to_string(kShelfFormat)).c_str(),
                   Stage::kOutput);
  });
}

Shelf::~Shelf() = default;
Shelf::Shelf(Shelf&&) noexcept = default;

Shelf Shelf::open_or_renew(const std::string& path,
                           const std::function<void(const std::string&)>& tell) {
  remove_foreign<Impl>(path, "damaged, or not what this colod writes", tell);
  return {path, true};
}

std::vector<std::string> Shelf::names() const {
  std::vector<std::string> result;
  Statement s = impl_->read("SELECT DISTINCT name FROM piece ORDER BY name");
  while (s.step()) result.push_back(s.text());
  return result;
}

void Shelf::put(const std::string& name, const Pieces& pieces) {
  impl_->transaction([&] {
    impl_->write("DELETE FROM piece WHERE name = ?1").bind(name).run();
    Statement s = impl_->write("INSERT INTO piece VALUES(?1, ?2, ?3, ?4, ?5)");
    const auto parts = static_cast<std::int64_t>(pieces.size());
    for (const auto& [part, bytes] : pieces)
      s.bind(name)
          .bind(part)
          .bind(parts)
          .bind(seal_of(name, part, parts, bytes))
          .bind_bytes(bytes.data(), bytes.size())
          .run();
  });
}

Shelf::State Shelf::state(const std::string& name) const {
  Statement s = impl_->read("SELECT part, parts, hash, bytes FROM piece WHERE name = ?1");
  s.bind(name);
  std::int64_t found = 0, parts = 0;
  while (s.step()) {
    ++found;
    const std::string part = s.text();
    parts = s.integer();
    const std::string seal = s.text();
    if (seal != seal_of(name, part, parts, s.bytes())) return State::kDamaged;
  }
  if (found == 0) return State::kAbsent;
  return found == parts ? State::kWhole : State::kDamaged;
}

std::string Shelf::get(const std::string& name, const std::string& piece) const {
  Statement s = impl_->read("SELECT parts, hash, bytes FROM piece WHERE name = ?1 AND part = ?2");
  if (!s.bind(name).bind(piece).step()) return {};
  const std::int64_t parts = s.integer();
  const std::string seal = s.text();
  std::string bytes = s.bytes();
  return seal == seal_of(name, piece, parts, bytes) ? bytes : std::string();
}

void Shelf::keep_only(const std::vector<std::string>& names) {
  const std::set<std::string> kept(names.begin(), names.end());
  impl_->transaction([&] {
    for (const std::string& name : this->names())
      if (!kept.contains(name)) impl_->write("DELETE FROM piece WHERE name = ?1").bind(name).run();
  });
}

}  // namespace colod
