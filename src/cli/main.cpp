#include <malloc.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <thread>
#include <utility>
#include <vector>

#include "cli.h"
#include "core/error.h"
#include "exporters/files.h"
#include "log.h"

namespace {

/// An interrupted run ends between two files. Call it before there are threads: they inherit the
/// blocked signals, which one thread waits for. Signals that the caller ignores stay ignored.
void end_between_files() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction action;
    if (sigaction(number, nullptr, &action) == 0 && action.sa_handler != SIG_IGN)
      sigaddset(&signals, number);
  }
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::thread([signals] {
    int number = 0;
    if (sigwait(&signals, &number) != 0) return;
    const auto lock = colod::hold_writes();
    std::signal(number, SIG_DFL);
    pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
    raise(number);
  }).detach();
}

/// A limit on the size of files is an error like a full disk, with a message and nothing left
/// half-written.
void let_large_writes_fail() { std::signal(SIGXFSZ, SIG_IGN); }

/// What is freed is kept for the next one who asks: glibc would give each larger block back to the
/// system, which clears the same pages again, half of all page faults of a build.
void keep_freed_memory() {
  constexpr int kMebibyte = 1 << 20;
  mallopt(M_MMAP_THRESHOLD, 32 * kMebibyte);  // the most that glibc takes
  mallopt(M_TRIM_THRESHOLD, 256 * kMebibyte);
}

int run(int argc, char** argv) {
  CLI::App app{
      "colod: chains of clean, watertight levels of detail, consistent over all buildings of a "
      "scene"};
  app.require_subcommand(1);
  app.set_version_flag("--version", "colod " COLOD_VERSION);
  std::vector<std::pair<CLI::App*, colod::cli::Run>> commands;
  const auto add = [&](const char* name, const char* help, colod::cli::Run (*make)(CLI::App&)) {
    CLI::App* command = app.add_subcommand(name, help);
    commands.emplace_back(command, make(*command));
  };
  add("build", "buildings in, LOD chains and a 3D Tiles tileset out", colod::cli::add_build);
  add("plan", "a scene in cells, which segment and mesh can work on apart", colod::cli::add_plan);
  add("segment", "stage 1 of build: sources to a scene file", colod::cli::add_segment);
  add("analyze", "stage 2: the layers of all segments of one or several scene files",
      colod::cli::add_analyze);
  add("mesh", "stage 3: one mesh a building and layer", colod::cli::add_mesh);
  add("export", "stage 4: a meshed scene file to GLB, 3D Tiles, OBJ, PLY", colod::cli::add_export);
  add("merge", "the files of a scene whose cells were exported apart", colod::cli::add_merge);
  add("eval", "metrics of one mesh against another, JSON on stdout", colod::cli::add_eval);
  add("info", "what a mesh, GLB or tileset holds, JSON on stdout", colod::cli::add_info);
  add("synth", "a procedural neighbourhood with ground truth", colod::cli::add_synth);
  add("preview", "pictures of meshes side by side, as one PNG", colod::cli::add_preview);
  add("rules", "the rules by which colod differs from its paper: list, page, JSON",
      colod::cli::add_rules);
  add("view", "a page on this machine that streams what build or export wrote",
      colod::cli::add_view);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    const bool is_request = e.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success);
    app.exit(e);
    return is_request ? 0 : static_cast<int>(colod::Stage::kUsage);
  }
  for (const auto& [command, action] : commands)
    if (command->parsed()) return action();
  return static_cast<int>(colod::Stage::kUsage);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    end_between_files();
    let_large_writes_fail();
    keep_freed_memory();
    return run(argc, argv);
  } catch (const colod::Error& e) {
    std::fprintf(stderr, "colod: %s\n", colod::cli::one_line(e.what()).c_str());
    return static_cast<int>(e.stage);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "colod: %s\n", colod::cli::one_line(e.what()).c_str());
    return static_cast<int>(colod::Stage::kProcess);
  }
}
