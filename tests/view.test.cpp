// `colod view` from outside: a copy of the program beside a page of our own, asked over HTTP.
#include <httplib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "temporary_folder.h"

namespace fs = std::filesystem;

namespace {

/// colod, a page and an output folder, in a folder that goes away with the test.
class Place {
 public:
  Place() {
    fs::copy_file(COLOD_BINARY, folder_ / "colod");
    write("viewer/index.html", "the page");
    write("viewer/draco/draco_decoder.wasm", "wasm");
    write("city/tileset.json", "{}");
    write("city/tiles/a house.glb", "0123456789");
    write("secret", "secret");
  }
  fs::path operator/(const std::string& name) const { return folder_ / name; }
  void write(const std::string& name, const std::string& text) const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }

 private:
  colod::test::TemporaryFolder folder_;
};

/// A running `colod view`; `said` is what it printed up to the end of the first line.
class Viewer {
 public:
  Viewer(const Place& place, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"colod", "view"});
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    int ends[2];
    REQUIRE(pipe(ends) == 0);
    pid_ = fork();
    if (pid_ == 0) {
      std::signal(SIGINT, SIG_DFL);  // ignored where the tests run in the background
      dup2(ends[1], STDOUT_FILENO);
      dup2(ends[1], STDERR_FILENO);
      close(ends[0]);
      execv((place / "colod").c_str(), argv.data());
      _exit(127);
    }
    close(ends[1]);
    output_ = ends[0];
    for (char c = 0; c != '\n' && read(output_, &c, 1) == 1;) said += c;
  }
  ~Viewer() {
    if (pid_ > 0) end(SIGKILL);
    close(output_);
  }
  int port() const { return std::stoi(said.substr(said.rfind(':') + 1)); }
  /// The status of waitpid, after a signal unless that is 0.
  int end(int signal) {
    int status = 0;
    if (signal != 0) kill(pid_, signal);
    waitpid(pid_, &status, 0);
    pid_ = 0;
    return status;
  }
  std::string said;

 private:
  pid_t pid_ = 0;
  int output_ = -1;
};

}  // namespace

TEST_CASE("view serves the page and the folder, whole and in ranges, until it is interrupted") {
  const Place place;
  Viewer viewer(place, {place / "city"});
  INFO(viewer.said);
  REQUIRE(viewer.said.starts_with("http://127.0.0.1:"));
  httplib::Client client("127.0.0.1", viewer.port());
  CHECK(client.Get("/")->body == "the page");
  CHECK(client.Get("/")->get_header_value("Content-Type") == "text/html");
  CHECK(client.Get("/draco/draco_decoder.wasm")->get_header_value("Content-Type") ==
        "application/wasm");
  CHECK(client.Get("/out/tileset.json")->get_header_value("Content-Type") == "application/json");
  const auto whole = client.Get("/out/tiles/a%20house.glb");
  CHECK(whole->get_header_value("Content-Type") == "model/gltf-binary");
  CHECK(whole->body == "0123456789");
  const auto part = client.Get("/out/tiles/a%20house.glb", {httplib::make_range_header({{2, 4}})});
  CHECK(part->status == 206);
  CHECK(part->get_header_value("Content-Range") == "bytes 2-4/10");
  CHECK(part->body == "234");
  CHECK(client.Get("/out/none.glb")->status == 404);
  CHECK(client.Post("/out/tileset.json", "x", "text/plain")->status == 404);
  const int status = viewer.end(SIGINT);
  CHECK(WIFSIGNALED(status));
  CHECK(WTERMSIG(status) == SIGINT);
}

TEST_CASE("no request leads out of what view serves, and no other site's name leads to it") {
  const Place place;
  const Viewer viewer(place, {place / "city"});
  httplib::Client client("127.0.0.1", viewer.port());
  for (const char* path :
       {"/../secret", "/out/../secret", "/out/../../secret", "/out/%2e%2e/secret",
        "/out/%2e%2e%2fsecret", "/out/tiles/../../secret", "/out/..%2fsecret", "/out//../secret",
        "/out/./../secret", "/out/..\\secret", "/out%2f..%2fsecret"}) {
    const auto answer = client.Get(path);
    INFO(path);
    REQUIRE(answer);
    CHECK(answer->status == 404);
    CHECK(answer->body.find("secret") == std::string::npos);
  }
  CHECK(client.Get("/", {{"Host", "evil.example:80"}})->status == 403);
  CHECK(client.Get("/", {{"Host", "localhost:80"}})->status == 200);
}

TEST_CASE("view says what is missing") {
  const Place place;
  const auto exit_code = [](Viewer& viewer) { return WEXITSTATUS(viewer.end(0)); };
  Viewer first(place, {place / "city"});
  Viewer second(place, {place / "city", "--port", std::to_string(first.port())});
  CHECK_THAT(second.said, Catch::Contains("cannot be opened"));
  CHECK(exit_code(second) == 5);
  Viewer no_tileset(place, {place / "viewer"});
  CHECK_THAT(no_tileset.said, Catch::Contains("no tileset.json"));
  CHECK(exit_code(no_tileset) == 3);
  fs::remove_all(place / "viewer");
  Viewer no_page(place, {place / "city"});
  CHECK_THAT(no_page.said, Catch::Contains("--target viewer"));
  CHECK(exit_code(no_page) == 4);
}
