// The only writer: bytes to a temporary name beside the target, then renamed. No half-written file
// is ever left.
#pragma once

#include "exporter.h"

namespace colod {

/// Writes `file` below `folder`, making folders as needed. Throws Error{kOutput} naming the path
/// and the cause.
void write_file(const std::string& folder, const Encoded& file);

}  // namespace colod
