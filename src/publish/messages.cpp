#include "messages.h"

#include <algorithm>
#include <iomanip>
#include <sstream>

#include "core/error.h"
#include "pipeline/losses.h"

namespace colod {
namespace {

void add_building(const Building& b, std::vector<Message>& to) {
  if (!b.failure.empty()) to.push_back({Level::kError, b.failure});
  for (const Layer& layer : b.layers) {
    const std::string place = b.source.name + ", layer " + std::to_string(layer.layer) + ": ";
    if (!layer.failure.empty())
      to.push_back({Level::kError, place + layer.failure});
    else if (is_failure(layer.stand_in))
      to.push_back({Level::kError, place + describe(layer.stand_in)});
  }
  for (const std::string& w : loss_warnings(b))
    to.push_back({b.has_lost_shape() ? Level::kError : Level::kWarning, b.source.name + ": " + w});
  for (const std::string& w : b.lost_looks) to.push_back({Level::kError, b.source.name + ": " + w});
  for (const std::string& w : b.warnings) to.push_back({Level::kWarning, b.source.name + ": " + w});
}

}  // namespace

std::vector<Message> problems_of(const Scene& scene) {
  std::vector<Message> all;
  for (const std::string& w : scene.warnings) all.push_back({Level::kWarning, w});
  for (const std::string& w : scene.switching.warnings) all.push_back({Level::kWarning, w});
  if (!scene.tileset_failure.empty())
    all.push_back({Level::kError, "tileset.json is not written: " + scene.tileset_failure});
  for (const ReadFailure& f : scene.failures)
    all.push_back({Level::kError, f.path + ": " + f.message});
  for (const Building& b : scene.buildings) add_building(b, all);
  return all;
}

Message summary_of(const Scene& scene, double seconds, const std::string& out) {
  const auto done = std::count_if(scene.buildings.begin(), scene.buildings.end(),
                                  [](const Building& b) { return b.failure.empty(); });
  const auto lossy = std::count_if(
      scene.buildings.begin(), scene.buildings.end(),
      [](const Building& b) { return b.failure.empty() && (b.has_lost() || b.has_failed()); });
  std::ostringstream text;
  text << done << " of " << scene.buildings.size() << " buildings in " << std::fixed
       << std::setprecision(1) << seconds << " s, written to " << out
       << " (layer 0 is the coarsest)";
  if (lossy > 0) text << "; of " << lossy << " of them something is lost, as said above";
  if (!scene.failures.empty())
    text << "; inputs have " << scene.failures.size() << " failures of their own, as said above";
  return {Level::kInfo, text.str()};
}

int exit_code(const Scene& scene) {
  std::size_t failed = scene.failures.size() + !scene.tileset_failure.empty();
  for (const Building& b : scene.buildings) failed += b.has_failed() || b.has_lost();
  if (failed == 0) return 0;
  const bool is_any_done = std::any_of(scene.buildings.begin(), scene.buildings.end(),
                                       [](const Building& b) { return b.failure.empty(); });
  if (is_any_done) return 1;
  return static_cast<int>(scene.buildings.empty() ? Stage::kInput : Stage::kProcess);
}

}  // namespace colod
