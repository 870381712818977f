// Inside room `read` only: a file of any length, block after block.
#pragma once

#include <fstream>
#include <string>
#include <string_view>

namespace colod::mesh_io {

class Blocks {
 public:
  /// `in_lines`: a block ends where a line does, unless the file itself ends elsewhere. Throws
  /// Error{kInput} where the file cannot be opened.
  Blocks(const std::string& path, std::uint64_t begin, bool in_lines);

  /// `data`: what is left of the last block → that, and the next piece of the file. False: there is
  /// none. Throws Error{kInput} for a line longer than a block.
  bool next(std::string_view& data);

 private:
  std::string path_;
  std::ifstream in_;
  bool in_lines_;
  std::string buffer_;  // what was handed out …
  std::string ahead_;   // … and the line that was begun behind it
};

}  // namespace colod::mesh_io
