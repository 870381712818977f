// The only writer: bytes to a temporary name beside the target, then renamed. No half-written file
// is ever left.
#pragma once

#include <functional>
#include <mutex>
#include <string>

#include "exporter.h"

namespace colod {

/// Makes `folder` unless it is there, and makes sure that files can be written to it. Throws
/// Error{kOutput}.
void make_folder(const std::string& folder);

/// While the result lives, no file is half-written: for whoever ends the process.
std::unique_lock<std::mutex> hold_writes();

/// Thread-safe. Writes `file` below `folder`, making folders as needed. Throws Error{kOutput}
/// naming the path and the cause.
void write_file(const std::string& folder, const Encoded& file);

/// The same of a file that is never in memory as a whole: `body` hands over its bytes, piece by
/// piece. What it throws leaves no file.
using Append = std::function<void(const std::string& bytes)>;
void write_file(const std::string& folder, const std::string& path,
                const std::function<void(const Append&)>& body);

}  // namespace colod
