// Inside the store: SQLite's statements, and the rows of one building.
#pragma once

#include <array>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "core/error.h"
#include "core/hash.h"
#include "store.h"

struct sqlite3;
struct sqlite3_stmt;

namespace colod {

/// Records of doubles and nothing else.
template <typename T>
constexpr bool kIsDoubles = std::is_same_v<T, Vec3> || std::is_same_v<T, std::array<double, 64>> ||
                            std::is_same_v<T, VisibleStep>;

/// One prepared statement of SQLite: bind in order, step, read columns in order.
class Statement {
 public:
  Statement(sqlite3* db, const std::string& path, Stage stage, const char* sql);
  /// The same with the first value bound.
  Statement(sqlite3* db, const std::string& path, Stage stage, const char* sql,
            const std::string& first);
  ~Statement();
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  Statement& bind(const std::string& v);
  Statement& bind(double v);
  Statement& bind(std::int64_t v);
  Statement& bind(int v) { return bind(static_cast<std::int64_t>(v)); }
  Statement& bind_bytes(const void* data, std::size_t size);
  template <typename T>
  Statement& bind(const std::vector<T>& v) {
    static_assert(sizeof(T) % 4 == 0);
    return bind_bytes(v.data(), v.size() * sizeof(T));
  }
  Statement& bind(const Vec3& v) { return bind_bytes(v.data(), sizeof(Vec3)); }
  Statement& bind_null();
  /// From now on every row that is stepped to is added, each column with its type and length.
  Statement& sum_into(Hash& hash);

  /// True when there is a row to read.
  bool step();
  /// Steps once and is ready to be bound again.
  void run();

  bool is_null() const;  ///< the next column
  void skip(int columns) { read_ += columns; }
  std::string text();
  std::string bytes();
  double real();
  std::int64_t integer();
  template <typename T>
  std::vector<T> array() {
    const std::span<const std::byte> bytes = blob();
    if (bytes.size() % sizeof(T) != 0)
      throw Error(Stage::kInput, path_, "damaged: an array has a wrong length");
    std::vector<T> v(bytes.size() / sizeof(T));
    if (!bytes.empty()) std::memcpy(static_cast<void*>(v.data()), bytes.data(), bytes.size());
    if constexpr (kIsDoubles<T>)
      check_numbers({reinterpret_cast<const double*>(v.data()), v.size() * sizeof(T) / 8});
    return v;
  }
  template <typename T>
  T value() {
    const std::vector<T> v = array<T>();
    if (v.size() != 1) throw Error(Stage::kInput, path_, "damaged: a record has a wrong length");
    return v.front();
  }

 private:
  std::span<const std::byte> blob();  ///< until the next step
  void check(int code) const;
  void sum_row() const;
  /// What follows takes finite numbers, no farther than a reader of meshes lets them be, for
  /// granted. Throws Error{kInput}.
  void check_numbers(std::span<const double> numbers) const;

  sqlite3* db_;
  const std::string& path_;
  Stage stage_;
  sqlite3_stmt* statement_ = nullptr;
  Hash* sum_ = nullptr;
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

/// Deletes a database's file, and what a killed run left beside it.
void remove_database(const std::string& path);

/// A database of SQLite, closed at the end.
struct Database {
  std::string path;
  sqlite3* db = nullptr;

  Database() = default;
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;
  ~Database();

  /// `flags` of SQLite. Throws Error, kOutput where it may be made.
  void open(int flags);
  /// To read and write what is there.
  void open_existing();
  /// Keeps few pages in memory: for a file of which each place is read once, beside many others.
  void keep_few_pages() const;
  /// Whether the last call failed since the file is no whole database.
  bool is_damaged() const;
  /// Whether all its pages and keys are as they must be; what rows hold may be anything.
  bool is_intact() const;

  Statement read(const char* sql) const { return {db, path, Stage::kInput, sql}; }
  Statement write(const char* sql) const { return {db, path, Stage::kOutput, sql}; }
  void execute(const char* sql, Stage stage) const;
  /// All of `body` or nothing.
  void transaction(const std::function<void()>& body) const;
};

/// Deletes the database of a path, if there is one that is damaged or no `Kind` to go on with, and
/// tells that it `is_what`.
template <class Kind>
void remove_foreign(const std::string& path, const char* is_what,
                    const std::function<void(const std::string&)>& tell) {
  if (!std::filesystem::exists(path)) return;
  Kind found;
  found.path = path;
  found.open_existing();
  if (found.is_intact() && found.is_of_its_kind()) return;
  tell(path + ": is " + is_what + ": made anew");
  remove_database(path);
}

/// What of a building is written together, and has one seal. The order is that of the file format.
enum class Section {
  kSource,
  kOutcome,
  kPlanes,
  kSegments,
  kCoverage,
  kLayering,  ///< which layer its segments lie on
  kSights,    ///< of its meshes
  kMeshes     ///< all of them, sights as well
};

struct Store::Impl : Database {
  bool has_row(const char* sql, const std::string& name) const;
  /// All tables, views and triggers as they were made.
  std::vector<std::string> schema() const;
  /// Whether it was segmented by the rules, and their numbers, of this colod.
  bool has_these_rules() const;
  bool has_own_schema() const;  ///< and none besides
  /// Of this format, or empty.
  bool is_of_its_kind() const;

  // seals.cpp: hashes by which a changed byte is seen. A temporary file has none.
  bool has_seals() const { return !path.empty(); }
  std::string sum_of(Section section, const std::string& name) const;
  void seal(Section section, const std::string& name) const;
  bool is_sealed(Section section, const std::string& name) const;
  bool are_sealed(std::initializer_list<Section> sections, const std::string& name) const;
  /// All rows of it. Throws Error{kInput}, with the stage that makes them anew, when they are not
  /// what was written: nothing of them is taken for a number before.
  Statement rows(Section section, const std::string& name) const;
  void forget_meshes(const std::string& name) const;
  void forget_layering() const;  ///< of all buildings, with their meshes
  void put_meta(const std::string& key, const std::string& value) const;
  bool has_whole_meta() const;
  /// None: not there. Throws Error{kInput} when it is damaged.
  std::optional<std::string> meta(const std::string& key) const;

  // rows.cpp
  void put_building(const Building& b, int order, const std::string& key) const;
  void put_planes(const Building& b) const;
  void put_segments(const Building& b) const;
  void put_layer(const Building& b, const Layer& layer) const;
  void put_outcome(const Building& b) const;  ///< what its meshing changed of the building itself
  void get_building(Building& b) const;       ///< the source with the outcome
  void get_outcome(Building& b) const;
  void get_planes(Building& b) const;
  void get_descriptors(Building& b) const;  ///< with layer_of_segment
  void get_coverage(Building& b) const;     ///< after them
  void get_segments(Building& b) const;     ///< after the planes: descriptors, coverage and planes
  void get_layers(Building& b) const;
};

/// Materials and images of a source's look.
std::string look_json(const Appearance& look);

/// The columns is_like_finer, deviation, profile.
LayerSight read_sight(Statement& s);

/// The columns form, volume, area, extent, is_flat, eigenvalues, context, d2.
Descriptor read_descriptor(Statement& s);

}  // namespace colod
