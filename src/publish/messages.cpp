#include "messages.h"

#include <cctype>
#include <iomanip>
#include <map>
#include <set>
#include <sstream>

#include "core/error.h"
#include "pipeline/losses.h"
#include "pipeline/stand_ins.h"

namespace colod {
namespace {

constexpr std::size_t kMostAlike = 5;  // buildings, whose lines of one kind are told each

/// Where the name of what a message is about ends; 0: it has none.
std::size_t place_end(const std::string& text) {
  const std::size_t end = text.find(": ");
  return end == std::string::npos ? 0 : end;
}

/// A message without its name and its numbers.
std::string kind_of(const std::string& text) {
  std::string kind = text.substr(place_end(text));
  std::erase_if(kind, [](unsigned char c) { return std::isdigit(c) || c == '.'; });
  return kind;
}

}  // namespace

std::vector<Message> problems_of(const Building& b) {
  std::vector<Message> to;
  if (!b.failure.empty())
    to.push_back({b.is_dismissed ? Level::kWarning : Level::kError, b.failure});
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
  return to;
}

std::vector<Message> problems_of(const Scene& scene) {
  std::vector<Message> all;
  for (const std::string& w : scene.warnings) all.push_back({Level::kWarning, w});
  for (const std::string& w : scene.switching.warnings) all.push_back({Level::kWarning, w});
  if (!scene.tileset_failure.empty())
    all.push_back({Level::kError, "tileset.json is not written: " + scene.tileset_failure});
  for (const ReadFailure& f : scene.failures)
    all.push_back({Level::kError, f.path + ": " + f.message});
  for (const Building& b : scene.buildings)
    for (Message& m : problems_of(b)) all.push_back(std::move(m));
  return all;
}

std::vector<Message> gathered(const std::vector<Message>& messages) {
  std::map<std::string, std::vector<std::size_t>> alike;
  for (std::size_t i = 0; i < messages.size(); ++i)
    if (messages[i].level == Level::kWarning && place_end(messages[i].text) > 0)
      alike[kind_of(messages[i].text)].push_back(i);
  std::vector<Message> told = messages;
  std::vector<char> is_told(messages.size(), 1);
  for (const auto& [kind, which] : alike) {
    std::set<std::string> names;
    for (const std::size_t i : which)
      names.insert(messages[i].text.substr(0, place_end(messages[i].text)));
    if (names.size() <= kMostAlike) continue;
    for (const std::size_t i : which) is_told[i] = i == which[0];
    std::string& first = told[which[0]].text;
    first.insert(place_end(first), " and " + std::to_string(names.size() - 1) + " others");
    first += "; --log-json tells of each";
  }
  std::size_t next = 0;
  std::erase_if(told, [&](const Message&) { return !is_told[next++]; });
  return told;
}

Message summary_of(const Scene& scene, const Tally& tally, double seconds, const std::string& out) {
  std::ostringstream text;
  text << tally.done << " of " << tally.buildings << " buildings in " << std::fixed
       << std::setprecision(1) << seconds << " s, written to " << out
       << " (layer 0 is the coarsest)";
  if (tally.lossy > 0)
    text << "; of " << tally.lossy << " of them something is lost, as said above";
  if (!scene.failures.empty())
    text << "; inputs have " << scene.failures.size() << " failures of their own, as said above";
  return {Level::kInfo, text.str()};
}

int exit_code(const Scene& scene, const Tally& tally) {
  if (scene.failures.size() + !scene.tileset_failure.empty() + tally.amiss == 0) return 0;
  if (tally.done > 0) return 1;
  return static_cast<int>(tally.buildings == 0 ? Stage::kInput : Stage::kProcess);
}

int exit_code(const Scene& scene) { return exit_code(scene, tally_of(scene)); }

}  // namespace colod
