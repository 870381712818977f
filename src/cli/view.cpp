// Differs from what a web server does: loopback only, two folders, nothing but reading.
#include <httplib.h>

#include <cstdio>
#include <filesystem>
#include <memory>

#include "../error.h"
#include "cli.h"

namespace colod::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kHost = "127.0.0.1";

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

/// Another site that leads its own name to this host is not answered.
httplib::Server::HandlerResponse refuse_strangers(const httplib::Request& request,
                                                  httplib::Response& response) {
  const std::string host = request.get_header_value("Host");
  const std::string name = host.substr(0, host.rfind(':'));
  if (name == kHost || name == "localhost") return httplib::Server::HandlerResponse::Unhandled;
  response.status = 403;
  return httplib::Server::HandlerResponse::Handled;
}

void prepare(httplib::Server& server, const std::string& out, const std::string& page) {
  server.set_mount_point("/out", out);
  server.set_mount_point("/", page);
  server.set_file_extension_and_mimetype_mapping("glb", "model/gltf-binary");
  server.set_file_extension_and_mimetype_mapping("3tz", "application/zip");
  server.set_default_headers({{"Cache-Control", "no-cache"}});  // the next export is seen
  server.set_pre_routing_handler(refuse_strangers);
  server.set_tcp_nodelay(true);
  server.set_keep_alive_max_count(1000);
  // The library's own options would let two servers share a port.
  server.set_socket_options([](socket_t socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
}

/// Serves until the process is interrupted.
int view(const ViewArguments& a) {
  if (!fs::is_regular_file(fs::path(a.folder) / "tileset.json"))
    throw Error(Stage::kInput, a.folder,
                "holds no tileset.json (colod writes one with --format 3dtiles)");
  httplib::Server server;
  prepare(server, a.folder, page_folder());
  int port = a.port;
  if (port == 0)
    port = server.bind_to_any_port(kHost);
  else if (!server.bind_to_port(kHost, port))
    port = -1;
  if (port < 0)
    throw Error(Stage::kOutput, "--port " + std::to_string(a.port),
                "cannot be opened; without --port a free one is taken");
  std::printf("http://%s:%d/\n", kHost, port);
  std::fflush(stdout);
  std::fprintf(stderr, "Open the address in a browser; Ctrl-C ends.\n");
  return server.listen_after_bind() ? 0 : static_cast<int>(Stage::kOutput);
}

}  // namespace

Run add_view(CLI::App& app) {
  auto a = std::make_shared<ViewArguments>();
  app.add_option("OUT", a->folder, "folder that colod build or export wrote")->required();
  app.add_option("--port", a->port, "of the address on this machine, default: a free one")
      ->check(CLI::Range(1, 65535));
  return [a] { return view(*a); };
}

}  // namespace colod::cli
