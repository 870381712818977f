// Preloaded into a program (LD_PRELOAD), this starts it again and again from a process in which all
// libraries are loaded already: for each request on the standard input a child runs main with other
// arguments. scripts/mutate runs colod hundreds of thousands of times, and loading its libraries
// takes longer than what it does with a small file.
//
// A request: the number of bytes that follow (four, little end first), then strings that end with a
// zero byte: the folder to run in, the file for the standard error, the seconds after which the
// child is killed, the arguments. The answer, a line on the standard output: the status as waitpid
// gives it, processor seconds, peak memory [KiB], seconds by the clock.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

namespace {

using Main = int (*)(int, char**, char**);
Main program = nullptr;

constexpr rlim_t kAddressSpace =
    rlim_t{8} << 30;  // [bytes], so that a bomb ends its own process and not the machine

bool read_all(char* to, std::size_t size) {
  while (size > 0) {
    const ssize_t got = read(STDIN_FILENO, to, size);
    if (got <= 0) return false;
    to += got;
    size -= static_cast<std::size_t>(got);
  }
  return true;
}

/// The strings of the next request, none at the end of the input.
std::vector<std::string> next_request() {
  std::uint32_t size = 0;
  if (!read_all(reinterpret_cast<char*>(&size), sizeof size)) return {};
  std::string bytes(size, '\0');
  if (!read_all(bytes.data(), size)) return {};
  std::vector<std::string> strings;
  for (std::size_t at = 0; at < bytes.size(); at += strings.back().size() + 1)
    strings.emplace_back(bytes.c_str() + at);
  return strings;
}

void point_at(int descriptor, const char* path, int flags) {
  const int file = open(path, flags, 0600);
  if (file < 0 || dup2(file, descriptor) < 0) _exit(127);
  close(file);
}

/// The program itself, in a child: never returns.
[[noreturn]] void run(std::vector<std::string>& request, char* name, char** environment) {
  const rlimit limit{kAddressSpace, kAddressSpace};
  if (setrlimit(RLIMIT_AS, &limit) != 0 || chdir(request[0].c_str()) != 0) _exit(127);
  point_at(STDIN_FILENO, "/dev/null", O_RDONLY);
  point_at(STDOUT_FILENO, "/dev/null", O_WRONLY);
  point_at(STDERR_FILENO, request[1].c_str(), O_WRONLY | O_CREAT | O_TRUNC);
  std::vector<char*> arguments{name};
  for (std::size_t i = 3; i < request.size(); ++i) arguments.push_back(request[i].data());
  arguments.push_back(nullptr);
  std::exit(program(static_cast<int>(arguments.size()) - 1, arguments.data(), environment));
}

/// Waits for the child, and kills it after so many seconds.
void wait_for(pid_t child, long seconds, const sigset_t& ended) {
  const auto start = std::chrono::steady_clock::now();
  const timespec longest{seconds, 0};
  if (sigtimedwait(&ended, nullptr, &longest) < 0) kill(child, SIGKILL);
  int status = 0;
  rusage usage{};
  wait4(child, &status, 0, &usage);
  const timespec none{0, 0};
  sigtimedwait(&ended, nullptr, &none);  // the signal of a child that was killed
  const auto in_seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - start;
  std::printf("%d %.3f %ld %.3f\n", status, in_seconds(usage.ru_utime) + in_seconds(usage.ru_stime),
              usage.ru_maxrss, waited.count());
  std::fflush(stdout);
}

int serve(int, char** arguments, char** environment) {
  unsetenv("LD_PRELOAD");
  sigset_t ended, before;
  sigemptyset(&ended);
  sigaddset(&ended, SIGCHLD);
  sigprocmask(SIG_BLOCK, &ended, &before);
  for (auto request = next_request(); request.size() > 2; request = next_request()) {
    const pid_t child = fork();
    if (child < 0) return 1;
    if (child == 0) {
      sigprocmask(SIG_SETMASK, &before, nullptr);
      run(request, arguments[0], environment);
    }
    wait_for(child, std::strtol(request[2].c_str(), nullptr, 10), ended);
  }
  return 0;
}

}  // namespace

/// Takes the place of the C library's function, which a program's first instructions call with its
/// main.
// NOLINTNEXTLINE(bugprone-reserved-identifier,readability-identifier-naming)
extern "C" int __libc_start_main(Main main, int count, char** arguments, void (*init)(),
                                 void (*fini)(), void (*loader_fini)(), void* stack) {
  using Start = int (*)(Main, int, char**, void (*)(), void (*)(), void (*)(), void*);
  program = main;
  const auto start = reinterpret_cast<Start>(dlsym(RTLD_NEXT, "__libc_start_main"));
  return start(serve, count, arguments, init, fini, loader_fini, stack);
}
