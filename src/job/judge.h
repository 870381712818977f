// Inside room `job`: the layers of a scene held against a ground truth of parts.
#pragma once

#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "pipeline/pipeline.h"

namespace colod {

/// Keeps each source, since no depot keeps its faces' objects, until its layers are done.
class Judge {
 public:
  explicit Judge(const Truth& truth) : truth_(truth) {}

  /// Lives no longer than the judge.
  Observer observer();
  /// Of all buildings, by name.
  std::vector<PlacedPart> parts() const;

 private:
  void keep(const Building& building);
  void judge(const Building& building);

  const Truth& truth_;
  std::mutex mutex_;
  std::map<std::string, Source> sources_;
  std::map<std::string, std::vector<PlacedPart>> parts_;
};

}  // namespace colod
