// Based on: SQLite's C interface.
// Differs: –
// Notation: –

#include <sqlite3.h>

#include <cmath>
#include <filesystem>

#include "parts.h"

namespace colod {

Statement::Statement(sqlite3* db, const std::string& path, Stage stage, const char* sql)
    : db_(db), path_(path), stage_(stage) {
  check(sqlite3_prepare_v2(db, sql, -1, &statement_, nullptr));
}

Statement::Statement(sqlite3* db, const std::string& path, Stage stage, const char* sql,
                     const std::string& first)
    : Statement(db, path, stage, sql) {
  bind(first);
}

Statement::~Statement() { sqlite3_finalize(statement_); }

Statement& Statement::bind(const std::string& v) {
  check(
      sqlite3_bind_text64(statement_, ++bound_, v.data(), v.size(), SQLITE_TRANSIENT, SQLITE_UTF8));
  return *this;
}

Statement& Statement::bind(double v) {
  check(sqlite3_bind_double(statement_, ++bound_, v));
  return *this;
}

Statement& Statement::bind(std::int64_t v) {
  check(sqlite3_bind_int64(statement_, ++bound_, v));
  return *this;
}

Statement& Statement::bind_bytes(const void* data, std::size_t size) {
  check(sqlite3_bind_blob64(statement_, ++bound_, size ? data : "", size, SQLITE_TRANSIENT));
  return *this;
}

Statement& Statement::bind_null() {
  check(sqlite3_bind_null(statement_, ++bound_));
  return *this;
}

Statement& Statement::sum_into(Hash& hash) {
  sum_ = &hash;
  return *this;
}

bool Statement::step() {
  const int code = sqlite3_step(statement_);
  read_ = 0;
  if (code != SQLITE_ROW && code != SQLITE_DONE) check(code);
  if (sum_ && code == SQLITE_ROW) sum_row();
  return code == SQLITE_ROW;
}

/// Types first: reading a number as bytes would make it a text.
void Statement::sum_row() const {
  for (int i = 0; i < sqlite3_column_count(statement_); ++i) {
    const int type = sqlite3_column_type(statement_, i);
    sum_->add(&type, sizeof type);
    if (type == SQLITE_INTEGER) {
      const std::int64_t value = sqlite3_column_int64(statement_, i);
      sum_->add(&value, sizeof value);
    } else if (type == SQLITE_FLOAT) {
      const double value = sqlite3_column_double(statement_, i);
      sum_->add(&value, sizeof value);
    } else if (type != SQLITE_NULL) {
      const void* data = sqlite3_column_blob(statement_, i);
      const int size = sqlite3_column_bytes(statement_, i);
      sum_->add(&size, sizeof size);
      sum_->add(data, static_cast<std::size_t>(size));
    }
  }
}

void Statement::run() {
  step();
  sqlite3_reset(statement_);
  bound_ = 0;
}

bool Statement::is_null() const { return sqlite3_column_type(statement_, read_) == SQLITE_NULL; }

std::string Statement::text() {
  const auto* data = reinterpret_cast<const char*>(sqlite3_column_text(statement_, read_));
  const int size = sqlite3_column_bytes(statement_, read_++);
  return data ? std::string(data, static_cast<std::size_t>(size)) : std::string();
}

std::string Statement::bytes() {
  const std::span<const std::byte> all = blob();
  return {reinterpret_cast<const char*>(all.data()), all.size()};
}

double Statement::real() {
  const double value = sqlite3_column_double(statement_, read_++);
  check_numbers({&value, 1});
  return value;
}

std::int64_t Statement::integer() { return sqlite3_column_int64(statement_, read_++); }

std::span<const std::byte> Statement::blob() {
  const auto* data = static_cast<const std::byte*>(sqlite3_column_blob(statement_, read_));
  return {data, static_cast<std::size_t>(sqlite3_column_bytes(statement_, read_++))};
}

void Statement::check_numbers(std::span<const double> numbers) const {
  constexpr double kMost = 1e25;  // square metres of a place 1e12 m wide
  for (const double x : numbers)
    if (!(std::abs(x) <= kMost))
      throw Error(Stage::kInput, path_, "damaged: a number is not finite, or out of all bounds");
}

void Statement::check(int code) const {
  if (code != SQLITE_OK)
    throw Error(stage_, path_, std::string("scene file: ") + sqlite3_errmsg(db_));
}

Database::~Database() { sqlite3_close(db); }

void Database::open(int flags) {
  if (sqlite3_open_v2(path.c_str(), &db, flags, nullptr) != SQLITE_OK)
    throw Error(flags & SQLITE_OPEN_CREATE ? Stage::kOutput : Stage::kInput, path,
                std::string("cannot be opened: ") + sqlite3_errmsg(db));
}

void Database::open_existing() { open(SQLITE_OPEN_READWRITE); }

/// SQLite's own bound is 2 MB a file: as much again as the rest of a step where a city's cells are
/// open together. The pages on the way to a row, and a large row's own, find room in 256 KiB.
void Database::keep_few_pages() const { execute("PRAGMA cache_size = -256", Stage::kInput); }

bool Database::is_damaged() const {
  const int code = sqlite3_errcode(db);
  return code == SQLITE_CORRUPT || code == SQLITE_NOTADB;
}

bool Database::is_intact() const try {
  Statement s = read("PRAGMA integrity_check(1)");
  return s.step() && s.text() == "ok";
} catch (const Error&) {
  if (is_damaged()) return false;
  throw;
}

void Database::execute(const char* sql, Stage stage) const {
  if (sqlite3_exec(db, sql, nullptr, nullptr, nullptr) != SQLITE_OK)
    throw Error(stage, path, std::string("scene file: ") + sqlite3_errmsg(db));
}

void Database::transaction(const std::function<void()>& body) const {
  execute("BEGIN IMMEDIATE", Stage::kOutput);
  try {
    body();
    execute("COMMIT", Stage::kOutput);
  } catch (...) {
    sqlite3_exec(db, "ROLLBACK", nullptr, nullptr, nullptr);
    throw;
  }
}

void remove_database(const std::string& path) {
  std::filesystem::remove(path);
  std::filesystem::remove(path + "-journal");
}

}  // namespace colod
