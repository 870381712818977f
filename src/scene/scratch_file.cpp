// Based on: POSIX.
// Differs: nothing.
#include "scratch_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "core/error.h"

namespace colod {

namespace {

[[noreturn]] void give_up(const std::string& what) {
  throw Error(
      Stage::kOutput, std::filesystem::temp_directory_path().string(),
      what + " a temporary file: " + std::strerror(errno) + "; TMPDIR names another folder");
}

}  // namespace

ScratchFile::ScratchFile() {
  std::string name = (std::filesystem::temp_directory_path() / "colod-XXXXXX").string();
  file_ = mkstemp(name.data());
  if (file_ < 0) give_up("cannot make");
  unlink(name.c_str());
}

ScratchFile::~ScratchFile() { close(file_); }

std::size_t ScratchFile::append(const std::string& bytes) {
  const std::lock_guard lock(mutex_);
  const std::size_t at = size_;
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t n =
        pwrite(file_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(at + done));
    if (n <= 0) give_up("cannot write to");
    done += static_cast<std::size_t>(n);
  }
  size_ += bytes.size();
  return at;
}

std::string ScratchFile::read(std::size_t offset, std::size_t length) const {
  std::string bytes(length, '\0');
  for (std::size_t done = 0; done < length;) {
    const ssize_t n =
        pread(file_, bytes.data() + done, length - done, static_cast<off_t>(offset + done));
    if (n <= 0) give_up("cannot read from");
    done += static_cast<std::size_t>(n);
  }
  return bytes;
}

std::string ScratchFile::path() const { return "/dev/fd/" + std::to_string(file_); }

}  // namespace colod
