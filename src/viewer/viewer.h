// Two folders over HTTP to programs on this machine: the page at /, what a build wrote at /out.
#pragma once

#include <memory>
#include <string>

namespace colod::cli {

/// Loopback only, GET and HEAD only, regular files inside the two folders only. Whoever asks is
/// bounded: 32 KiB a request and 10 seconds to send it, 256 connections, no body, one range, ten
/// minutes to fetch a file, which is read in pieces as it is sent.
class ViewServer {
 public:
  ViewServer(const std::string& out, const std::string& page);
  ~ViewServer();

  /// The port that was opened, any free one for 0; −1 when it is taken.
  int bind(int port);
  /// Serves until the process ends; false when it cannot.
  bool listen();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace colod::cli
