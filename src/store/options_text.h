// Options as text: what a scene file and a plan keep of them.
#pragma once

#include <string>

#include "core/options.h"

namespace colod {

/// JSON on one line; equal options have equal texts.
std::string options_text(const Options& options);

/// The options of such a text. Throws Error{kInput} naming `where` for what is none, or out of its
/// range.
Options options_of(const std::string& text, const std::string& where);

}  // namespace colod
