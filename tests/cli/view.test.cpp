// `colod view` from outside: a copy of the program beside a page of our own, asked over HTTP.
#include <arpa/inet.h>
#include <httplib.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
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
  pid_t pid() const { return pid_; }
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
  CHECK(client.Post("/out/tileset.json", "x", "text/plain")->status == 405);
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

namespace {

/// A raw connection to the viewer.
class Raw {
 public:
  explicit Raw(int port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const timeval patience{20, 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
    REQUIRE(connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0);
  }
  Raw(const Raw&) = delete;
  ~Raw() { close(socket_); }
  bool say(const std::string& bytes) const {
    for (std::size_t sent = 0; sent < bytes.size();) {
      const ssize_t n = send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
      if (n <= 0) return false;
      sent += static_cast<std::size_t>(n);
    }
    return true;
  }
  /// All that comes until the other side is done, up to `most` bytes.
  std::string hear(std::size_t most = 1 << 20) const {
    std::string heard;
    char piece[4096];
    for (ssize_t n; heard.size() < most && (n = recv(socket_, piece, sizeof piece, 0)) > 0;)
      heard.append(piece, static_cast<std::size_t>(n));
    return heard;
  }

 private:
  int socket_;
};

/// MiB that a process holds at most so far.
double peak_memory(pid_t pid) {
  std::ifstream in("/proc/" + std::to_string(pid) + "/status");
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("VmHWM:")) return std::stod(line.substr(6)) / 1024;
  return 0;
}

}  // namespace

TEST_CASE("many ranges and long bodies cost the viewer nothing") {
  const Place place;
  place.write("city/big.glb", std::string(4 << 20, 'x'));
  const Viewer viewer(place, {place / "city"});
  const double before = peak_memory(viewer.pid());
  for (const int ranges : {2, 100, 1600}) {
    std::string list = "0-";
    for (int i = 1; i < ranges; ++i) list += ",0-";
    const Raw raw(viewer.port());
    raw.say("GET /out/big.glb HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\nRange: bytes=" +
            list + "\r\n\r\n");
    const std::string answer = raw.hear(64 << 20);
    CHECK(answer.starts_with("HTTP/1.1 200"));
    CHECK(answer.size() < (4 << 20) + 2000);
  }
  for (const char* encoding : {"identity", "gzip"}) {
    const Raw raw(viewer.port());
    raw.say("POST / HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: text/plain\r\nContent-Encoding: " +
            std::string(encoding) + "\r\nContent-Length: 300000000\r\n\r\n");
    const std::string piece(1 << 20, '\0');
    for (int i = 0; i < 300 && raw.say(piece);) ++i;
    CHECK(raw.hear().starts_with("HTTP/1.1 405"));
  }
  for (const std::string start : {"GET /", "GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nX: ", ""}) {
    const Raw raw(viewer.port());
    raw.say(start);
    const std::string piece(1 << 16, 'x');
    int said = 0;
    while (said < 1000 && raw.say(piece)) ++said;
    CHECK(said < 1000);  // the viewer hung up
  }
  const Raw headers(viewer.port());
  headers.say("GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n");
  for (int i = 0; i < 100'000 && headers.say("X-" + std::to_string(i) + ": y\r\n");) ++i;
  CHECK(peak_memory(viewer.pid()) < before + 50);
  CHECK(httplib::Client("127.0.0.1", viewer.port()).Get("/")->body == "the page");
}

TEST_CASE("slow connections do not keep others waiting") {
  const Place place;
  const Viewer viewer(place, {place / "city"});
  std::vector<std::unique_ptr<Raw>> slow;
  for (int i = 0; i < 100; ++i) {
    slow.push_back(std::make_unique<Raw>(viewer.port()));
    slow.back()->say("GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nX");
  }
  const auto start = std::chrono::steady_clock::now();
  httplib::Client client("127.0.0.1", viewer.port());
  REQUIRE(client.Get("/"));
  CHECK(client.Get("/out/tileset.json")->status == 200);
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(5));
  slow.resize(1);
  slow.front()->hear();  // ends, since the viewer gives a request ten seconds
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(15));
  for (int i = 0; i < 280; ++i) slow.push_back(std::make_unique<Raw>(viewer.port()));
  slow.clear();
  std::this_thread::sleep_for(std::chrono::seconds(2));
  CHECK(client.Get("/")->status == 200);
}

TEST_CASE("answers say what a page may do, and links lead nowhere else") {
  const Place place;
  place.write("city/report.html", "a report");
  place.write("city/empty.json", "");
  fs::create_symlink(place / "secret", place / "city/link.json");
  fs::create_symlink(place / "", place / "city/linked");
  fs::create_symlink("tileset.json", place / "city/within.json");
  REQUIRE(mkfifo((place / "city/fifo.json").c_str(), 0600) == 0);
  const Viewer viewer(place, {place / "city"});
  httplib::Client client("127.0.0.1", viewer.port());
  for (const char* path : {"/", "/out/report.html", "/out/tileset.json", "/none"}) {
    const auto answer = client.Get(path);
    CHECK(answer->get_header_value("X-Content-Type-Options") == "nosniff");
    CHECK(answer->get_header_value("Content-Security-Policy").find("default-src 'none'") !=
          std::string::npos);
  }
  for (const char* path : {"/out/link.json", "/out/linked/secret", "/out/fifo.json", "/out/tiles",
                           "/out/a%00b", "/out/"})
    CHECK(client.Get(path)->status == 404);
  CHECK(client.Get("/out/within.json")->body == "{}");
  CHECK(client.Get("/out/empty.json")->status == 200);
  CHECK(client.Head("/out/tiles/a%20house.glb")->get_header_value("Content-Length") == "10");
  const httplib::Headers beyond = {httplib::make_range_header({{10, 20}})};
  CHECK(client.Get("/out/tiles/a%20house.glb", beyond)->status == 416);
  CHECK(client.Get("/out/tiles/a%20house.glb", {httplib::make_range_header({{7, -1}})})->body ==
        "789");
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
