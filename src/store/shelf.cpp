// Based on: SQLite as an application file format, as the scene file is.
// Differs: –
// Notation: –

#include "shelf.h"

#include <sqlite3.h>

#include <set>

#include "parts.h"

namespace colod {
namespace {

constexpr int kShelfFormat = 0x434c4401;  // PRAGMA user_version, far from those of scene files

constexpr const char* kShelfSchema =
    "CREATE TABLE piece(name TEXT NOT NULL, part TEXT NOT NULL, bytes BLOB NOT NULL, "
    "PRIMARY KEY(name, part))";

enum class Content { kNothing, kShelf, kOther };

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
    return Content::kOther;
  }
};

Shelf::Shelf(const std::string& path, bool is_new_allowed) : impl_(std::make_unique<Impl>()) {
  impl_->path = path;
  const int flags = SQLITE_OPEN_READWRITE | (is_new_allowed ? SQLITE_OPEN_CREATE : 0);
  if (sqlite3_open_v2(path.c_str(), &impl_->db, flags, nullptr) != SQLITE_OK)
    throw Error(is_new_allowed ? Stage::kOutput : Stage::kInput, path,
                std::string("cannot be opened: ") + sqlite3_errmsg(impl_->db));
  switch (impl_->content()) {
    case Content::kShelf:
      return;
    case Content::kOther:
      throw Error(Stage::kInput, path,
                  "is damaged, or not what this colod exports of a cell: delete it, and run colod "
                  "export again");
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

std::vector<std::string> Shelf::names() const {
  std::vector<std::string> result;
  Statement s = impl_->read("SELECT DISTINCT name FROM piece ORDER BY name");
  while (s.step()) result.push_back(s.text());
  return result;
}

void Shelf::put(const std::string& name, const Pieces& pieces) {
  impl_->transaction([&] {
    impl_->write("DELETE FROM piece WHERE name = ?1").bind(name).run();
    Statement s = impl_->write("INSERT INTO piece VALUES(?1, ?2, ?3)");
    for (const auto& [part, bytes] : pieces)
      s.bind(name).bind(part).bind_bytes(bytes.data(), bytes.size()).run();
  });
}

std::string Shelf::get(const std::string& name, const std::string& piece) const {
  Statement s = impl_->read("SELECT bytes FROM piece WHERE name = ?1 AND part = ?2");
  if (!s.bind(name).bind(piece).step()) return {};
  const std::vector<char> bytes = s.array<char>();
  return {bytes.begin(), bytes.end()};
}

void Shelf::keep_only(const std::vector<std::string>& names) {
  const std::set<std::string> kept(names.begin(), names.end());
  impl_->transaction([&] {
    for (const std::string& name : this->names())
      if (!kept.contains(name)) impl_->write("DELETE FROM piece WHERE name = ?1").bind(name).run();
  });
}

}  // namespace colod
