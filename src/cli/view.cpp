#include <cstdio>
#include <filesystem>
#include <memory>

#include "cli.h"
#include "core/error.h"
#include "log.h"
#include "numbers.h"
#include "viewer/viewer.h"

namespace colod::cli {
namespace {

namespace fs = std::filesystem;

struct ViewArguments {
  std::string folder;
  int port = 0;
};

/// Where a build (beside the program) or an install (in share/) put the page.
std::string page_folder() {
  const fs::path program = fs::read_symlink("/proc/self/exe").parent_path();
  for (const fs::path& folder : {program / "viewer", program.parent_path() / "share/colod/viewer"})
    if (fs::exists(folder / "index.html")) return folder.string();
  throw Error(Stage::kProcess, "view",
              "the page has not been built: cmake --build --preset release --target viewer "
              "(needs npm and a network, once)");
}

/// Serves until the process is interrupted.
int view(const ViewArguments& a) {
  std::error_code error;  // such as a link that leads to itself
  if (!fs::is_regular_file(fs::path(a.folder) / "tileset.json", error))
    throw Error(Stage::kInput, a.folder,
                "holds no tileset.json (colod writes one with --format 3dtiles)");
  ViewServer server(a.folder, page_folder());
  const int port = server.bind(a.port);
  if (port < 0)
    throw Error(Stage::kOutput, "--port " + std::to_string(a.port),
                "cannot be opened; without --port a free one is taken");
  print_answer("http://127.0.0.1:" + std::to_string(port) + "/");
  std::fprintf(stderr, "Open the address in a browser; Ctrl-C ends.\n");
  return server.listen() ? 0 : static_cast<int>(Stage::kOutput);
}

}  // namespace

Run add_view(CLI::App& app) {
  auto a = std::make_shared<ViewArguments>();
  app.add_option("OUT", a->folder, "folder that colod build or export wrote")->required();
  app.add_option("--port", a->port, "of the address on this machine, default: a free one")
      ->check(number_between(1, 65535));
  return [a] { return view(*a); };
}

}  // namespace colod::cli
