// Programs that are there on some systems, and files that they need for a moment.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace colod {

/// Its path; empty: it is not on the PATH.
std::string find_program(const std::string& name);

/// Its exit code, −1 where it was ended; what it says is not heard. `words`: its path, then what it
/// is told, without a shell.
int run_program(const std::vector<std::string>& words);

/// A new folder that goes away with all that is in it. Throws std::runtime_error.
class Workplace {
 public:
  Workplace();
  ~Workplace();
  Workplace(const Workplace&) = delete;
  Workplace& operator=(const Workplace&) = delete;

  std::string operator/(const std::string& name) const { return (folder_ / name).string(); }

 private:
  std::filesystem::path folder_;
};

}  // namespace colod
