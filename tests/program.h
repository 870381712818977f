// The program itself, run by a test.
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "temporary_folder.h"

#ifndef COLOD_BINARY  // the build's own, which tests of the program are given
#define COLOD_BINARY "colod"
#endif

namespace colod::test {

/// How it ended (−1: by a signal), and what it said.
struct Ended {
  int exit_code;
  std::string out, err;
};

/// Runs colod in a folder, which keeps its `stdout` and `stderr`; `before`: variables and programs
/// that stand before its name.
inline Ended run_colod(const std::filesystem::path& folder, const std::string& arguments,
                       const std::string& before = "") {
  const std::string command = "cd " + folder.string() + " && " + before + " " + COLOD_BINARY + " " +
                              arguments + " > stdout 2> stderr";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, slurp(folder / "stdout"),
          slurp(folder / "stderr")};
}

}  // namespace colod::test
