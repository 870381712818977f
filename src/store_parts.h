// Inside the store: SQLite's statements, and the rows of one building.
#pragma once

#include <sqlite3.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "error.h"
#include "store.h"

namespace colod {

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

/// Reads JSON that `parse` takes apart; what it does not hold, or holds in another type, is damage.
template <typename Parse>
void read_json(const std::string& text, const std::string& path, const char* what,
               const Parse& parse) {
  try {
    parse(nlohmann::json::parse(text));
  } catch (const nlohmann::json::exception&) {
    throw Error(Stage::kInput, path, std::string("damaged: its ") + what + " are unreadable");
  }
}

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

  // store_rows.cpp
  void put_building(const Building& b, int order, const std::string& key) const;
  void put_planes(const Building& b) const;
  void put_segments(const Building& b) const;
  void put_layer(const Building& b, const Layer& layer) const;
  void get_building(Building& b) const;
  void get_planes(Building& b) const;
  void get_segments(Building& b) const;
  void get_layers(Building& b) const;
};

/// The columns form, volume, area, extent, is_flat, eigenvalues, d2.
Descriptor read_descriptor(Statement& s);

}  // namespace colod
