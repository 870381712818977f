// When layers switch, as a merge has left it: what an update goes by.
#pragma once

#include <optional>
#include <string>

#include "pipeline/pipeline.h"

namespace colod {

/// JSON.
std::string switching_text(const Switching& switching);

/// That of such a text, if it was decided by these options; none of a damaged one.
std::optional<Switching> switching_of(const std::string& text, const SwitchOptions& options);

}  // namespace colod
