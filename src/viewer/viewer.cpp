// Based on: cpp-httplib, which reads requests and writes answers.
// Differs: the connection underneath and the files are ours, since the library bounds neither a
// request's bytes nor its time, and holds whole files and bodies in memory.
#include "viewer.h"

#include <fcntl.h>
#include <httplib.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <system_error>
#include <thread>
#include <utility>

namespace colod::cli {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr const char* kHost = "127.0.0.1";
constexpr std::size_t kMostRequest = 32768;  // bytes
constexpr milliseconds kRequestTime{10'000}, kIdleTime{5'000}, kAnswerTime{600'000};
constexpr milliseconds kStandstill{10'000};  // of whoever fetches a file
constexpr int kMostConnections = 256, kMostRequests = 1000;
constexpr std::size_t kPiece = 65536;  // bytes of a file in memory

/// The page's own code and pictures; its decoders are WebAssembly in workers that it makes itself.
constexpr const char* kPagePolicy =
    "default-src 'none'; script-src 'self' 'wasm-unsafe-eval' blob:; worker-src 'self' blob:; "
    "connect-src 'self' blob: data:; img-src 'self' blob: data:; style-src 'self' 'unsafe-inline'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
/// report.html holds its script. It, and what else lies there, is an origin of its own.
constexpr const char* kOutPolicy =
    "sandbox allow-scripts allow-popups; default-src 'none'; script-src 'unsafe-inline'; "
    "style-src 'unsafe-inline'; img-src data: blob:; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'";

/// A socket that gives a request no more than its bytes and its time.
class Connection : public httplib::Stream {
 public:
  explicit Connection(socket_t socket) : socket_(socket) {}

  /// Waits for the next request's first byte; false when none comes.
  bool await_request() {
    left_ = kMostRequest;
    until_ = Clock::now() + kRequestTime;
    answered_ = Clock::now() + kAnswerTime;
    return at_ < end_ || wait(POLLIN, Clock::now() + kIdleTime);
  }
  /// Lets the other side read the answer before unread bytes would reset the connection.
  void end() {
    shutdown(socket_, SHUT_WR);
    until_ = Clock::now() + milliseconds(1000);
    std::array<char, 4096> rest;
    for (int i = 0; i < 256 && wait(POLLIN, until_); ++i)
      if (recv(socket_, rest.data(), rest.size(), MSG_DONTWAIT) <= 0) return;
  }

  bool is_readable() const override { return at_ < end_ || wait(POLLIN, until_); }
  bool is_writable() const override {
    return wait(POLLOUT, std::min(answered_, Clock::now() + kStandstill));
  }
  ssize_t read(char* bytes, std::size_t size) override {
    if (at_ == end_ && !fill()) return -1;
    const std::size_t n = std::min({size, end_ - at_, left_});
    if (n == 0) return -1;
    std::copy_n(buffer_.data() + at_, n, bytes);
    at_ += n, left_ -= n;
    return static_cast<ssize_t>(n);
  }
  ssize_t write(const char* bytes, std::size_t size) override {
    if (!is_writable()) return -1;
    return send(socket_, bytes, size, MSG_NOSIGNAL | MSG_DONTWAIT);
  }
  void get_remote_ip_and_port(std::string& ip, int& port) const override { ip = kHost, port = 0; }
  void get_local_ip_and_port(std::string& ip, int& port) const override { ip = kHost, port = 0; }
  socket_t socket() const override { return socket_; }

 private:
  bool fill() {
    if (!wait(POLLIN, until_)) return false;
    const ssize_t n = recv(socket_, buffer_.data(), buffer_.size(), MSG_DONTWAIT);
    at_ = 0, end_ = n > 0 ? static_cast<std::size_t>(n) : 0;
    return n > 0;
  }
  bool wait(short events, Clock::time_point until) const {
    const auto left = std::chrono::duration_cast<milliseconds>(until - Clock::now());
    pollfd poll_for{socket_, events, 0};
    return poll(&poll_for, 1, static_cast<int>(std::max<long>(left.count(), 0))) > 0;
  }

  socket_t socket_;
  std::array<char, 4096> buffer_;
  std::size_t at_ = 0, end_ = 0, left_ = kMostRequest;
  Clock::time_point until_, answered_;
};

/// A thread a connection: how many there are is bounded where they are served.
class Threads : public httplib::TaskQueue {
 public:
  void enqueue(std::function<void()> task) override {
    try {
      std::thread(task).detach();
    } catch (const std::system_error&) {
      task();  // no thread is left: the next connection waits for this one
    }
  }
  void shutdown() override {}
};

/// Bodies are not read and a second range is not answered; with a body the connection ends.
void curb(httplib::Request& request) {
  if (request.ranges.size() > 1) request.ranges.clear();
  const bool has_body =
      request.has_header("Content-Length") || request.has_header("Transfer-Encoding");
  if (!has_body && (request.method == "GET" || request.method == "HEAD")) return;
  request.headers.erase("Connection");
  request.headers.erase("Expect");
  request.set_header("Connection", "close");
}

class BoundedServer : public httplib::Server {
  bool process_and_close_socket(socket_t socket) override {
    if (++open_ <= kMostConnections) {
      Connection connection(socket);
      serve(connection);
      connection.end();
    }
    close(socket);
    --open_;
    return true;
  }

  void serve(Connection& connection) {
    try {
      for (int left = kMostRequests; left > 0 && connection.await_request(); --left) {
        bool is_closed = false;
        const auto note = [&](httplib::Request& request) {
          curb(request);
          is_closed = is_closed || request.get_header_value("Connection") == "close";
        };
        if (!process_request(connection, left == 1, is_closed, note) || is_closed) return;
      }
    } catch (const std::exception&) {  // of this request, not of the server
    }
  }

  std::atomic<int> open_{0};
};

/// An open file that is closed with it.
struct OpenFile {
  int descriptor = -1;
  ~OpenFile() {
    if (descriptor >= 0) close(descriptor);
  }
  /// −1: no regular file.
  std::int64_t size() const {
    struct stat status;
    return fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) ? status.st_size : -1;
  }
};

const char* type_of(const fs::path& path) {
  static const std::map<std::string, const char*> kTypes = {
      {".html", "text/html"},        {".css", "text/css"},          {".js", "text/javascript"},
      {".json", "application/json"}, {".wasm", "application/wasm"}, {".glb", "model/gltf-binary"},
      {".3tz", "application/zip"},   {".png", "image/png"},         {".jpg", "image/jpeg"},
      {".webp", "image/webp"},       {".ktx2", "image/ktx2"},       {".txt", "text/plain"},
      {".svg", "image/svg+xml"}};
  const auto found = kTypes.find(path.extension().string());
  return found == kTypes.end() ? "application/octet-stream" : found->second;
}

/// The regular file that a request names inside `root`, links followed; else empty.
fs::path file_below(const fs::path& root, const std::string& name) {
  if (name.find('\0') != std::string::npos) return {};
  std::error_code error;
  fs::path path = fs::canonical(root / fs::path(name).relative_path(), error);
  if (!error && fs::is_directory(path, error)) path = fs::canonical(path / "index.html", error);
  if (error || !fs::is_regular_file(path, error)) return {};
  return std::mismatch(root.begin(), root.end(), path.begin(), path.end()).first == root.end()
             ? path
             : fs::path();
}

void send_file(const fs::path& path, const httplib::Request& request, httplib::Response& response) {
  const auto file = std::make_shared<OpenFile>();
  file->descriptor = open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  const std::int64_t size = file->descriptor < 0 ? -1 : file->size();
  const bool is_beyond = !request.ranges.empty() && request.ranges[0].first >= size;
  response.status = size < 0 ? 404 : is_beyond ? 416 : -1;
  if (response.status != -1) return;
  if (size == 0) return response.set_content("", type_of(path));
  const auto provide = [file](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
    std::vector<char> piece(std::min(length, kPiece));
    const ssize_t n =
        pread(file->descriptor, piece.data(), piece.size(), static_cast<off_t>(offset));
    return n > 0 && sink.write(piece.data(), static_cast<std::size_t>(n));
  };
  response.set_content_provider(static_cast<std::size_t>(size), type_of(path), provide);
}

/// Another site that leads its own name to this host is not answered, nor who wants more than to
/// read.
httplib::Server::HandlerResponse refuse_strangers(const httplib::Request& request,
                                                  httplib::Response& response) {
  const std::string host = request.get_header_value("Host");
  const std::string name = host.substr(0, host.rfind(':'));
  const bool is_reading = request.method == "GET" || request.method == "HEAD";
  if (is_reading && (name == kHost || name == "localhost"))
    return httplib::Server::HandlerResponse::Unhandled;
  response.status = is_reading ? 403 : 405;
  return httplib::Server::HandlerResponse::Handled;
}

}  // namespace

struct ViewServer::Impl {
  fs::path out, page;
  BoundedServer server;

  void answer(const httplib::Request& request, httplib::Response& response) const {
    constexpr std::string_view kOut = "/out/";
    const bool is_out = request.path.starts_with(kOut);
    response.set_header("Content-Security-Policy", is_out ? kOutPolicy : kPagePolicy);
    const fs::path path =
        is_out ? file_below(out, request.path.substr(kOut.size())) : file_below(page, request.path);
    if (path.empty())
      response.status = 404;
    else
      send_file(path, request, response);
  }
};

ViewServer::ViewServer(const std::string& out, const std::string& page)
    : impl_(std::make_unique<Impl>()) {
  impl_->out = fs::canonical(out);
  impl_->page = fs::canonical(page);
  httplib::Server& server = impl_->server;
  server.Get(".*", [this](const httplib::Request& request, httplib::Response& response) {
    impl_->answer(request, response);
  });
  server.set_pre_routing_handler(refuse_strangers);
  server.set_default_headers({{"Cache-Control", "no-cache"},  // the next export is seen
                              {"X-Content-Type-Options", "nosniff"},
                              {"Cross-Origin-Resource-Policy", "same-origin"}});
  server.new_task_queue = [] { return new Threads; };
  server.set_payload_max_length(0);
  server.set_tcp_nodelay(true);
  // The library's own options would let two servers share a port.
  server.set_socket_options([](socket_t socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
}

ViewServer::~ViewServer() = default;

int ViewServer::bind(int port) {
  if (port == 0) return impl_->server.bind_to_any_port(kHost);
  return impl_->server.bind_to_port(kHost, port) ? port : -1;
}

bool ViewServer::listen() { return impl_->server.listen_after_bind(); }

}  // namespace colod::cli
