// Based on: own work.
#include "update_analysis.h"

#include <map>
#include <set>
#include <utility>

#include "core/error.h"
#include "pipeline/pipeline.h"

namespace colod::cli {

namespace {

/// Scene files that were analysed together, some of whose buildings may be newer.
class Update {
 public:
  Update(const std::vector<std::string>& files, std::vector<Store>& stores, Scene scene,
         std::vector<std::size_t> file_of)
      : stores_(stores),
        options_(stores.front().options()),
        scene_(std::move(scene)),
        file_of_(std::move(file_of)) {
    for (std::size_t f = 0; f < files.size(); ++f) {
      stores[f].get_placed_later(scene_);
      if (!stores[f].is_analysed()) unanalysed_.insert(f);
    }
    prior_.layers = options_.layers;
    for (std::size_t i = 0; i < scene_.buildings.size(); ++i) sort_in(i, files);
    if (prior_.buildings.empty())
      throw Error(Stage::kInput, files.front(),
                  "nothing of an analysis is left to go by: run colod analyze without --update");
  }

  void run(const Log& log) {
    Scene placed;
    for (const std::size_t i : fresh_) placed.buildings.push_back(std::move(scene_.buildings[i]));
    if (!fresh_.empty()) analyze_scene(placed, options_, &prior_);
    std::map<std::size_t, std::set<std::string>> later;  // per file
    for (std::size_t i = 0; i < fresh_.size(); ++i) {
      const Building& b = placed.buildings[i];
      stores_[file_of_[fresh_[i]]].put_layers_of_segments(b);
      later[file_of_[fresh_[i]]].insert(b.source.name);
      log.message({Level::kInfo, b.source.name + ": its " +
                                     std::to_string(b.layer_of_segment.size()) +
                                     " segments lie where those lie that they are like"});
    }
    if (fresh_.empty()) log.message({Level::kInfo, "nothing is new since the last analysis"});
    keep_facts(later);
  }

 private:
  void sort_in(std::size_t i, const std::vector<std::string>& files) {
    const Building& b = scene_.buildings[i];
    const std::size_t file = file_of_[i];
    if (b.descriptors.empty()) return;
    if (!stores_[file].has_layers_of_segments(b.source.name)) return fresh_.push_back(i);
    if (unanalysed_.contains(file))
      throw Error(
          Stage::kInput, files[file],
          "has other options than when it was analysed: run colod analyze without --update");
    if (!scene_.placed_later.contains(b.source.name))
      prior_.buildings.push_back({b.descriptors, b.layer_of_segment});
  }

  /// What the analysis told stays; a file without it gets it.
  void keep_facts(const std::map<std::size_t, std::set<std::string>>& later) {
    for (std::size_t f = 0; f < stores_.size() && !unanalysed_.empty(); ++f) {
      if (unanalysed_.contains(f)) continue;
      Scene facts;
      stores_[f].get_coanalysis(facts);
      for (const std::size_t other : unanalysed_) stores_[other].put_coanalysis(facts);
      break;
    }
    for (const auto& [file, names] : later) {
      Scene before;
      stores_[file].get_placed_later(before);
      before.placed_later.insert(names.begin(), names.end());
      stores_[file].put_placed_later(before.placed_later);
    }
  }

  std::vector<Store>& stores_;
  Options options_;
  Scene scene_;
  std::vector<std::size_t> file_of_;  // per building
  Prior prior_;                       // what was analysed together
  std::set<std::size_t> unanalysed_;  // files
  std::vector<std::size_t> fresh_;    // buildings
};

}  // namespace

void update_analysis(const std::vector<std::string>& files, std::vector<Store>& stores, Scene scene,
                     std::vector<std::size_t> file_of, const Log& log) {
  Update(files, stores, std::move(scene), std::move(file_of)).run(log);
}

}  // namespace colod::cli
