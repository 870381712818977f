// One run at a time works on a scene file.
#pragma once

#include <string>

namespace colod {

/// Held as long as it lives, by flock on a file beside `path` (PATH.lock), which stays; a run that
/// was killed holds nothing. Throws Error{kOutput} where another run holds it.
class CellLock {
 public:
  explicit CellLock(const std::string& path);
  ~CellLock();
  CellLock(const CellLock&) = delete;
  CellLock& operator=(const CellLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace colod
