// What a person is told: one line a problem, and how a job ended.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "pipeline/pipeline.h"
#include "tally.h"

namespace colod {

enum class Level { kInfo, kWarning, kError };

struct Message {
  Level level = Level::kInfo;
  std::string text;  ///< one line, unless a name in it holds something else
};

/// Takes messages as they come. Called from one thread.
using Tell = std::function<void(const Message&)>;

/// Failures as errors, the rest as warnings, in the order of the buildings.
std::vector<Message> problems_of(const Scene& scene);

/// Of one building.
std::vector<Message> problems_of(const Building& building);

/// For a person: warnings of more than five buildings that differ in names and numbers alone are
/// one line, where the first of them stands.
std::vector<Message> gathered(const std::vector<Message>& messages);

/// "n of m buildings in s s, written to OUT …". `tally` is the sum of the scene's buildings, which
/// need not be there.
Message summary_of(const Scene& scene, const Tally& tally, double seconds, const std::string& out);

/// 0, 1, or 3 and 4 when nothing could be read or made.
int exit_code(const Scene& scene, const Tally& tally);
int exit_code(const Scene& scene);

}  // namespace colod
