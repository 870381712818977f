// Based on: own work.
#include "blocks.h"

#include "formats.h"

namespace colod::mesh_io {

namespace {

constexpr std::size_t kBlockBytes = std::size_t{1} << 20;

}  // namespace

Blocks::Blocks(const std::string& path, std::uint64_t begin, bool in_lines)
    : path_(path), in_(path, std::ios::binary), in_lines_(in_lines) {
  if (!in_) fail(path, "cannot be opened");
  in_.seekg(static_cast<std::streamoff>(begin));
}

bool Blocks::next(std::string_view& data) {
  std::string next = std::string(data) + ahead_;
  const std::size_t old = next.size();
  ahead_.clear();
  next.resize(old + kBlockBytes);
  in_.read(next.data() + old, static_cast<std::streamsize>(kBlockBytes));
  const auto read = static_cast<std::size_t>(in_.gcount());
  next.resize(old + read);
  if (in_lines_ && read == kBlockBytes) {
    std::size_t end = next.rfind('\n');
    if (end == next.npos) end = next.rfind('\r');
    if (end == next.npos) fail(path_, "a line is longer than a mebibyte");
    ahead_ = next.substr(end + 1);
    next.resize(end + 1);
  }
  const bool is_new = next.size() > data.size();
  buffer_ = std::move(next);
  data = buffer_;
  return is_new;
}

}  // namespace colod::mesh_io
