// Inside room `scene` only: what does not fit into memory, for as long as the program runs.
#pragma once

#include <cstddef>
#include <mutex>
#include <string>

namespace colod {

/// A file in the system's folder for temporary ones that no name leads to: it is gone with the
/// program, however that ends. Thread-safe.
class ScratchFile {
 public:
  /// Throws Error{kOutput} where there is no room for one.
  ScratchFile();
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  /// Where the bytes begin. Throws Error{kOutput} where the disk is full.
  std::size_t append(const std::string& bytes);
  /// Throws Error{kOutput} where it cannot be read.
  std::string read(std::size_t offset, std::size_t length) const;
  /// By which this process can open it, for as long as this lives.
  std::string path() const;

 private:
  std::mutex mutex_;
  int file_ = -1;
  std::size_t size_ = 0;
};

}  // namespace colod
