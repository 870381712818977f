#include "judge.h"

namespace colod {

Observer Judge::observer() {
  return {.segmented = [this](const Building& b) { keep(b); },
          .meshed = [this](Building& b) { judge(b); }};
}

void Judge::keep(const Building& b) {
  const std::lock_guard lock(mutex_);
  sources_[b.source.name] = b.source;
}

void Judge::judge(const Building& b) {
  Source source;
  {
    const std::lock_guard lock(mutex_);
    source = std::move(sources_[b.source.name]);
  }
  std::vector<PlacedPart> parts = place_parts(b, source, truth_);
  const std::lock_guard lock(mutex_);
  parts_[b.source.name] = std::move(parts);
}

std::vector<PlacedPart> Judge::parts() const {
  std::vector<PlacedPart> all;
  for (const auto& [name, parts] : parts_) all.insert(all.end(), parts.begin(), parts.end());
  return all;
}

}  // namespace colod
