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
#include <utility>

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

/// A file under another name until it is whole; goes away if it never is.
class Temporary {
 public:
  explicit Temporary(const fs::path& target)
      : target_(target),
        path_(target.string() + ".tmp" + std::to_string(getpid())),
        out_(std::fopen(path_.c_str(), "wb")) {
    if (!out_) fail(target_, std::string("cannot be written: ") + std::strerror(errno));
  }
  ~Temporary() {
    if (out_) std::fclose(out_);
    std::error_code error;
    if (!is_in_place_) fs::remove(path_, error);
  }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;

  void append(const std::string& bytes) {
    if (std::fwrite(bytes.data(), 1, bytes.size(), out_) != bytes.size())
      fail(target_, std::string("cannot be written: ") + std::strerror(errno));
  }
  void rename() {
    const bool is_closed = std::fclose(std::exchange(out_, nullptr)) == 0;
    if (!is_closed) fail(target_, std::string("cannot be written: ") + std::strerror(errno));
    std::error_code error;
    fs::rename(path_, target_, error);
    if (error) fail(target_, "cannot be put in place: " + error.message());
    is_in_place_ = true;
  }

 private:
  fs::path target_, path_;
  std::FILE* out_;
  bool is_in_place_ = false;
};

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
  write_file(folder, file.path, [&](const Append& append) { append(file.bytes); });
}

void write_file(const std::string& folder, const std::string& path,
                const std::function<void(const Append&)>& body) {
  check_relative(path);
  const fs::path target = fs::path(folder) / path;
  std::error_code error;
  fs::create_directories(target.parent_path(), error);
  if (error) fail(target.parent_path(), "the folder cannot be made: " + error.message());
  const std::lock_guard lock(writing());
  Temporary temporary(target);
  body([&](const std::string& bytes) { temporary.append(bytes); });
  temporary.rename();
}

}  // namespace colod
