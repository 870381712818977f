#include "cell_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/error.h"

namespace colod {

CellLock::CellLock(const std::string& path)
    : descriptor_(open((path + ".lock").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666)) {
  if (descriptor_ < 0)
    throw Error(Stage::kOutput, path + ".lock",
                std::string("cannot be opened: ") + strerror(errno));
  if (flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  const int cause = errno;
  close(descriptor_);
  throw Error(Stage::kOutput, path,
              cause == EWOULDBLOCK
                  ? "another run is at work on it: wait for its end, or give each run a --shard"
                  : std::string("cannot be locked: ") + strerror(cause));
}

CellLock::~CellLock() { close(descriptor_); }

}  // namespace colod
