// Based on: write beside, then rename, which POSIX makes atomic within a folder.
// Differs: not flushed to the disk; a power cut is not guarded against. A run that is interrupted
// (hold_writes) leaves whole files only; one killed with SIGKILL may leave a temporary name as
// well.
#include "files.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <mutex>

#include "core/error.h"

namespace colod {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const fs::path& path, const std::string& cause) {
  throw Error(Stage::kOutput, path.string(), cause);
}

std::mutex& writing() {
  static std::mutex mutex;
  return mutex;
}

/// Only names below the folder: a building called ../../x must not leave it.
void check_relative(const fs::path& path) {
  const bool leaves = path.is_absolute() || path.empty() ||
                      std::any_of(path.begin(), path.end(), [](const fs::path& part) {
                        return part == ".." || part.string().find('\0') != std::string::npos;
                      });
  if (leaves) fail(path, "not a path below the output folder");
}

}  // namespace

void make_folder(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) fail(folder, "the folder cannot be made: " + error.message());
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    fail(folder, std::string("cannot be written to: ") + std::strerror(errno));
}

std::unique_lock<std::mutex> hold_writes() { return std::unique_lock(writing()); }

void write_file(const std::string& folder, const Encoded& file) {
  check_relative(file.path);
  const fs::path target = fs::path(folder) / file.path;
  std::error_code error;
  fs::create_directories(target.parent_path(), error);
  if (error) fail(target.parent_path(), "the folder cannot be made: " + error.message());
  const std::lock_guard lock(writing());
  const fs::path temporary = target.string() + ".tmp" + std::to_string(getpid());
  std::FILE* out = std::fopen(temporary.c_str(), "wb");
  if (!out) fail(target, std::string("cannot be written: ") + std::strerror(errno));
  const bool is_written =
      std::fwrite(file.bytes.data(), 1, file.bytes.size(), out) == file.bytes.size();
  const int cause = errno;
  const bool is_closed = std::fclose(out) == 0;
  if (!is_written || !is_closed) {
    const std::string why = std::strerror(is_written ? errno : cause);
    fs::remove(temporary, error);
    fail(target, "cannot be written: " + why);
  }
  fs::rename(temporary, target, error);
  if (!error) return;
  const std::string why = error.message();
  fs::remove(temporary, error);
  fail(target, "cannot be put in place: " + why);
}

}  // namespace colod
