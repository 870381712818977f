// The scene file: one SQLite database with inputs, planes, segments, layers and meshes
// (docs/scene-file.md).
//
// Stages write one building per transaction, so a killed run leaves whole buildings only and goes
// on with the missing ones.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "core/options.h"
#include "pipeline/pipeline.h"

namespace colod {

/// Not thread-safe. Every function throws Error{kInput} (reading) or Error{kOutput} (writing)
/// naming the file. What is read is compared with hashes that were written with it; a byte that
/// changed meanwhile is an Error{kInput} with the stage that makes it anew.
class Store {
 public:
  /// Gets a line for the user.
  using Tell = std::function<void(const std::string& line)>;

  /// Opens a scene file; `is_new_allowed` makes it when there is none.
  Store(const std::string& path, bool is_new_allowed);
  ~Store();
  Store(Store&&) noexcept;
  /// Opens or makes a file that a run can make again: one that is damaged, or no scene file of this
  /// colod, is deleted, `tell` gets a line that says so, and a new one is begun. Reads all of it.
  static Store open_or_renew(const std::string& path, const Tell& tell);

  /// Lets go what does not have the bytes that were written, with all that was made of it, and
  /// tells so: a building, or its meshes, or what is said of the scene. Reads all of it.
  void drop_damaged(const Tell& tell);
  void drop_damaged_meshes(const Tell& tell);

  /// Other options outdate the analysis, another number of layers, other rules or a colod with
  /// other ones the meshes too: they go away.
  void put_options(const Options& options);
  Options options() const;
  /// Throws Error{kInput} when it was segmented by a colod whose rules, or their numbers, were
  /// others: what it holds is not what this one would make.
  void check_rules() const;

  /// Buildings with other names go away.
  void keep_only(const std::vector<std::string>& names);

  /// Names of all buildings, in the order of the input.
  std::vector<std::string> names() const;

  /// `read` to `coanalysis`: replaces the building of this name and all that hung on it. `order`
  /// sorts names(); `key` says what it was made from.
  void put_segments(const Building& building, int order, const std::string& key);
  /// The key that the building was put with; empty: not there.
  std::string segments_key(const std::string& name) const;

  /// `coanalysis`: layer_of_segment of a building; its meshes, which they outdate,
  /// go away when a layer changed.
  void put_layers_of_segments(const Building& building);
  bool has_layers_of_segments(const std::string& name) const;

  /// `partition` and `extraction`: the meshes with their measures.
  void put_meshes(const Building& building);
  bool has_meshes(const std::string& name) const;

  /// Names of buildings that have neither failed nor meshes yet.
  std::vector<std::string> unmeshed() const;
  /// What a building's meshes are made from: a hash of its segments' key, their layers, the options
  /// and the rules.
  std::string meshes_key(const std::string& name) const;

  /// All that is there of a building; timings are not kept.
  Building building(const std::string& name) const;
  /// Of a building what an analysis asks for, name, descriptors, coverage and, where they are
  /// decided, layers; the rest is not read.
  Building described(const std::string& name) const;

  /// What the buildings with meshes bring to the decision when layers switch.
  std::vector<BuildingSights> sights() const;

  /// What the analysed scene learnt. Throws Error{kInput} when it is not analysed.
  Prior prior() const;

  /// What the co-analysis reported, for the report.
  /// `put` says that no building was placed later.
  void put_coanalysis(const Scene& scene);
  void get_coanalysis(Scene& scene) const;
  bool is_analysed() const;

  /// Buildings whose layers are not of this analysis, but were learnt from it; `get` adds to
  /// Scene::placed_later.
  void put_placed_later(const std::set<std::string>& names);
  void get_placed_later(Scene& scene) const;

  /// How the place was opened that its buildings are of, a line that says so to whoever opens it
  /// again; empty: it is of files with buildings.
  void put_place(const std::string& record);
  std::string place() const;

  /// What footprints say of buildings; `get` adds to what is there.
  void put_attributes(const std::map<std::string, Attributes>& attributes);
  void get_attributes(std::map<std::string, Attributes>& attributes) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Sources and planes in a temporary database that the system's folder for such files holds and
/// that goes away by itself. Throws Error{kOutput} where there is no room.
class TemporaryStore : public Depot {
 public:
  TemporaryStore();
  void put(Building& building) override;
  void get(Building& building) override;
  void drop(Building& building) override;

 private:
  std::mutex mutex_;
  Store store_;
};

/// A key for Store::put_segments: a hash of the source's content, its images' bytes, of the options
/// and rules that rooms up to `segments` depend on, and of this colod's own rules and their
/// numbers.
std::string segments_key(const Source& source, const Options& options);

}  // namespace colod
