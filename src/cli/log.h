// Messages on stderr: lines, JSON lines, or a line that is drawn over while stderr is a terminal.
#pragma once

#include <string>

#include "publish/messages.h"

namespace colod::cli {

/// File names and damaged files hold anything; a message is one line without control characters.
std::string one_line(std::string text);

/// What a command answers, on stdout, with a newline. Throws Error{kOutput} where it does not get
/// there whole: a full disk, a closed pipe.
void print_answer(const std::string& text);

class Log {
 public:
  Log(bool is_quiet, bool is_json);

  /// Not for quiet runs, and on a terminal (or as JSON) only.
  void progress(const std::string& building, const char* stage, int done, int total) const;
  /// Quiet runs print errors only.
  void message(const Message& message) const;
  /// As JSON each, for a person those that are alike as one.
  void messages(const std::vector<Message>& all) const;

 private:
  bool is_quiet_, is_json_, is_terminal_;
};

}  // namespace colod::cli
