#include "log.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>

#include "core/error.h"

namespace colod::cli {
namespace {

const char* name(Level level) {
  return level == Level::kError ? "error" : level == Level::kWarning ? "warning" : "info";
}

void write_line(const nlohmann::ordered_json& line) {
  const std::string text = line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  std::fprintf(stderr, "%s\n", text.c_str());
}

}  // namespace

std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7F; }, '?');
  return text;
}

void print_answer(const std::string& text) {
  const bool is_whole = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() &&
                        std::fputc('\n', stdout) != EOF && std::fflush(stdout) == 0;
  if (!is_whole)
    throw Error(Stage::kOutput, "stdout",
                std::string("the answer cannot be written: ") + std::strerror(errno));
}

Log::Log(bool is_quiet, bool is_json)
    : is_quiet_(is_quiet), is_json_(is_json), is_terminal_(isatty(STDERR_FILENO) != 0) {}

void Log::progress(const std::string& building, const char* stage, int done, int total) const {
  if (is_json_)
    write_line({{"event", "progress"},
                {"building", building},
                {"stage", stage},
                {"done", done},
                {"total", total}});
  else if (is_terminal_ && !is_quiet_)
    std::fprintf(stderr, "\r\033[K%s %d/%d: %s", stage, done, total, building.c_str());
}

void Log::message(const Message& message) const {
  const auto& [level, text] = message;
  if (is_json_) return write_line({{"event", name(level)}, {"message", text}});
  if (is_quiet_ && level != Level::kError) return;
  if (is_terminal_ && !is_quiet_) std::fprintf(stderr, "\r\033[K");
  const std::string prefix = level == Level::kInfo ? "" : std::string(name(level)) + ": ";
  std::fprintf(stderr, "colod: %s%s\n", prefix.c_str(), one_line(text).c_str());
}

void Log::messages(const std::vector<Message>& all) const {
  for (const Message& m : is_json_ ? all : gathered(all)) message(m);
}

}  // namespace colod::cli
